"""A corridor with doors and a window, walked along with the phone held upright."""

import numpy as np

from rendering import pictures
from rendering.camera import Camera, Pose
from rendering.scene import FAST, Scene


def make_poses():
    """Steps forward, now at the left wall, now at the right one."""
    rng = np.random.default_rng(17)
    poses = []
    for step in range(10):
        side = (-1, 1)[step % 2]
        eye = (0.36 * side + rng.normal(0, 0.06), 1.42 + rng.normal(0, 0.07),
               -1.75 + 0.24 * step + rng.normal(0, 0.03))
        target = (-0.22 * side + rng.normal(0, 0.05), 1.08 + rng.normal(0, 0.05), 3.9)
        poses.append(Pose(eye, target, rng.normal(0, 1.2)))
    return poses


SCENE = Scene(
    name="corridor",
    poses=make_poses(),
    pictures=[
        ("page_a.png", pictures.page),
        ("page_b.png", lambda rng: pictures.page(rng, (0.80, 0.72, 0.35))),
        ("page_c.png", pictures.page),
        ("page_d.png", lambda rng: pictures.page(rng, (0.55, 0.70, 0.78))),
        ("postcard.png", pictures.landscape),
        ("sign.png", lambda rng: pictures.magazine(
            rng, [(0.60, 0.05, 0.04), (0.85, 0.82, 0.80)])),
        ("print_a.png", lambda rng: pictures.botanical(rng, (0.20, 0.36, 0.40))),
        ("kilim.png", pictures.kilim),
        ("runner.png", pictures.rug),
        ("spines.png", lambda rng: pictures.spines(rng, 40)),
    ],
    camera=Camera(width=480, height=720, focal=470.0, exposure=0.95, balance=(1.03, 1.0, 0.97),
                  full_well=3000.0, read_noise=6.0, vignetting=0.22, jpeg_quality=92),
    quality=FAST,
    depth_range=16.0,
    seed=300)
