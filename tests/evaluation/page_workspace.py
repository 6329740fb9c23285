"""A small dense workspace as stereo and fusion leave it, for tests of pages."""

import os

import cv2
import numpy as np

from helpers import write_map
from evaluation import point_clouds

SIZE = (48, 32)  # Of the photographs.
DEPTH = 4.0  # Of the wall that all cameras see.
ORANGE = (255, 140, 0)  # Its points.


def make(folder, names, num_mapped=None, points=2000):
    """Cameras in a row before a wall; the first num_mapped have maps (all)."""
    for part in ("images", "sparse", "stereo"):
        os.makedirs(os.path.join(folder, part), exist_ok=True)
    _write_model(os.path.join(folder, "sparse"), names)
    for number, name in enumerate(names):
        image = np.full((SIZE[1], SIZE[0], 3), 40 * number, np.uint8)
        path = os.path.join(folder, "images", name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "wb") as file:
            file.write(cv2.imencode(".jpg", image)[1])
    for name in names[:num_mapped]:
        write_maps(folder, name)
    write_cloud(os.path.join(folder, "fused.ply"), points)


def _write_model(folder, names):
    with open(os.path.join(folder, "cameras.txt"), "w", encoding="utf-8") as file:
        file.write(f"1 PINHOLE {SIZE[0]} {SIZE[1]} 40 40 {SIZE[0] / 2} {SIZE[1] / 2}\n")
    with open(os.path.join(folder, "images.txt"), "w", encoding="utf-8") as file:
        for number, name in enumerate(names):
            file.write(f"{number + 1} 1 0 0 0 {-0.3 * number} 0 0 1 {name}\n\n")
    with open(os.path.join(folder, "points3D.txt"), "w", encoding="utf-8"):
        pass


def write_maps(folder, name, kind="geometric"):
    depth = np.full(SIZE[::-1], DEPTH)
    depth[:4] = 0
    normals = np.zeros((3, *SIZE[::-1]))
    normals[2] = -1
    for what, values in (("depth_maps", depth), ("normal_maps", normals)):
        write_map(os.path.join(folder, "stereo", what, f"{name}.{kind}.bin"), values)


def write_cloud(path, count, confidence=True):
    """Points of the wall in rows, each confirmed by one to three views."""
    rng = np.random.default_rng(1)
    points = np.column_stack((rng.uniform(-2, 3, count), rng.uniform(-1.5, 1.5, count),
                              np.full(count, DEPTH)))
    point_clouds.write_ply(path, points.astype(np.float32), np.tile(ORANGE, (count, 1)))
    if confidence:
        _add_confidence(path, rng.uniform(1, 3, count))


def _add_confidence(path, values):
    with open(path, "rb") as file:
        head, _, rows = file.read().partition(b"end_header\n")
    rows = np.frombuffer(rows, np.uint8).reshape(len(values), 15)  # Three floats, three bytes.
    more = np.array(values, "<f4").view(np.uint8).reshape(-1, 4)
    with open(path, "wb") as file:
        file.write(head + b"property float confidence\nend_header\n"
                   + np.hstack((rows, more)).tobytes())
