"""The furnished room of examples/room, whose photographs stand beside this."""

import numpy as np

from rendering import pictures
from rendering.camera import Pose
from rendering.scene import Scene


def make_poses():
    """A walk on an arc of about two metres around the coffee table, by hand."""
    rng = np.random.default_rng(5)
    poses = []
    for angle in np.linspace(-14.0, 30.0, 12):
        a = np.radians(angle + rng.normal(0, 0.4))
        radius = 2.85 + rng.normal(0, 0.05)
        eye = (-0.35 + radius * np.sin(a), 1.46 + rng.normal(0, 0.05),
               3.35 - radius * np.cos(a))
        target = (-0.40 + 0.008 * angle + rng.normal(0, 0.05),
                  0.92 + rng.normal(0, 0.03), 3.35)
        poses.append(Pose(eye, target, rng.normal(0, 0.8)))
    return poses


SCENE = Scene(
    name="room",
    poses=make_poses(),
    pictures=[
        ("rug.png", pictures.rug),
        ("landscape.png", pictures.landscape),
        ("print_a.png", lambda rng: pictures.botanical(rng, (0.25, 0.42, 0.18))),
        ("print_b.png", lambda rng: pictures.botanical(rng, (0.55, 0.27, 0.12))),
        ("spines.png", lambda rng: pictures.spines(rng, 40)),
        ("magazine_a.png", lambda rng: pictures.magazine(
            rng, [(0.60, 0.12, 0.10), (0.85, 0.75, 0.55), (0.15, 0.2, 0.3)])),
        ("magazine_b.png", lambda rng: pictures.magazine(
            rng, [(0.08, 0.20, 0.36), (0.75, 0.65, 0.30), (0.55, 0.70, 0.72)])),
        ("chair.png", pictures.chair_fabric),
        ("kilim.png", pictures.kilim),
        ("leafy.png", pictures.leafy_cloth),
        ("tweed.png", pictures.tweed),
    ])
