"""A room below the roof with slanted walls, in the light of a skylight and a lamp."""

import numpy as np

from rendering import pictures
from rendering.camera import Camera, Pose
from rendering.scene import FAST, Scene


def make_poses():
    """From the door: sideways, then a few steps into the room."""
    rng = np.random.default_rng(43)
    poses = []
    for step in range(10):
        along = step / 9
        eye = (0.85 - 1.55 * along + rng.normal(0, 0.03), 1.48 + rng.normal(0, 0.06),
               -1.05 + 0.9 * max(0.0, along - 0.45) + rng.normal(0, 0.05))
        target = (-0.05 + 0.25 * along + rng.normal(0, 0.06), 0.98 + rng.normal(0, 0.05), 3.0)
        poses.append(Pose(eye, target, rng.normal(0, 1.0)))
    return poses


SCENE = Scene(
    name="attic",
    poses=make_poses(),
    pictures=[
        ("quilt.png", pictures.quilt),
        ("leafy.png", pictures.leafy_cloth),
        ("landscape.png", pictures.landscape),
        ("print.png", lambda rng: pictures.botanical(rng, (0.45, 0.20, 0.25))),
        ("spines.png", lambda rng: pictures.spines(rng, 40)),
        ("chair.png", pictures.chair_fabric),
        ("rug.png", pictures.rug),
    ],
    camera=Camera(width=720, height=540, focal=540.0, exposure=1.0, balance=(0.92, 1.0, 1.04),
                  full_well=1800.0, read_noise=6.0, vignetting=0.26, jpeg_quality=90),
    quality=FAST,
    seed=700)
