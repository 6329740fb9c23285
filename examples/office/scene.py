"""An office with white desks and monitors like glass, in the light of the ceiling."""

import numpy as np

from rendering import pictures
from rendering.camera import Camera, Pose
from rendering.scene import FAST, Scene


def make_poses():
    """From the left to the right, standing, then crouching on the way back."""
    rng = np.random.default_rng(29)
    poses = []
    for step in range(10):
        back = step >= 6
        along = (step / 5 if not back else (9.5 - step) / 3.5) * 2 - 1
        eye = (1.15 * along + rng.normal(0, 0.05), (1.22 if back else 1.62) + rng.normal(0, 0.05),
               -0.75 + 0.25 * along ** 2 + rng.normal(0, 0.06) + 0.15 * back)
        target = (0.15 * along + rng.normal(0, 0.06), 0.95 + rng.normal(0, 0.04), 3.0)
        poses.append(Pose(eye, target, rng.normal(0, 0.9)))
    return poses


SCENE = Scene(
    name="office",
    poses=make_poses(),
    pictures=[
        ("page_a.png", pictures.page),
        ("page_b.png", pictures.page),
        ("magazine.png", lambda rng: pictures.magazine(
            rng, [(0.10, 0.22, 0.24), (0.80, 0.70, 0.40), (0.65, 0.30, 0.20)])),
        ("screen.png", pictures.screen),
        ("whiteboard.png", pictures.whiteboard),
        ("poster.png", lambda rng: pictures.botanical(rng, (0.15, 0.30, 0.50))),
        ("print.png", pictures.landscape),
        ("spines.png", lambda rng: pictures.spines(rng, 40)),
        ("tweed.png", pictures.tweed),
    ],
    camera=Camera(width=720, height=480, focal=500.0, exposure=1.05, balance=(0.98, 1.0, 0.97),
                  full_well=2200.0, read_noise=7.0, vignetting=0.12, jpeg_quality=93),
    quality=FAST,
    seed=500)
