"""Cameras and poses of COLMAP's binary models, as colmap_model.py reads those of text models."""

import os
import struct

import numpy as np

from . import colmap_model, files
from .colmap_model import (PARAMETERS, Camera, View, check_camera, check_finite, check_name,
                           rotation_of)
from .processes import Failure

# COLMAP's numbers of the camera models that can be used.
_MODELS = {0: "SIMPLE_PINHOLE", 1: "PINHOLE", 10: "THIN_PRISM_FISHEYE"}


class _Values:
    """The values of a file, one after the other."""

    def __init__(self, path):
        self._data = files.read_bytes(path)
        self._at = 0

    def take(self, code):
        values = struct.unpack_from("<" + code, self._data, self._at)
        self._at += struct.calcsize("<" + code)
        return values

    def take_name(self):
        end = self._data.index(b"\0", self._at)
        name = os.fsdecode(self._data[self._at:end])
        self._at = end + 1
        return name

    def skip(self, size):
        if size > len(self._data) - self._at:
            raise ValueError("the file ends too early")
        self._at += size


def read_any(folder):
    """Views of the model in a folder, of the binary one if there is one, as COLMAP does."""
    if os.path.exists(os.path.join(folder, "images.bin")):
        return read_views(folder)
    return colmap_model.read_views(folder)


def read_views(folder):
    """Views of the binary model in a folder, in the order of their names."""
    cameras = _read_cameras(os.path.join(folder, "cameras.bin"))
    path = os.path.join(folder, "images.bin")
    try:
        views = [View(number, name, cameras[camera], rotation_of(pose[:4]), np.array(pose[4:]))
                 for number, pose, camera, name in read_images(path)]
    except (KeyError, ValueError) as error:  # No such camera, no rotation.
        raise Failure(f"{path} is damaged") from error
    if not views:
        raise Failure(f"{path} holds no photograph")
    return sorted(views, key=lambda view: view.name)


def read_images(path):
    """Of every photograph in a file images.bin: its number, pose, camera and name."""
    images = []
    try:
        values = _Values(path)
        for _ in range(values.take("Q")[0]):
            number, *pose, camera = values.take("i7di")
            images.append((number, pose, camera, values.take_name()))
            check_finite(pose)
            check_name(images[-1][-1], path)
            values.skip(24 * values.take("Q")[0])  # What it observes.
    except (struct.error, ValueError) as error:
        raise Failure(f"{path} is damaged") from error
    return images


def _read_cameras(path):
    cameras = {}
    try:
        values = _Values(path)
        for _ in range(values.take("Q")[0]):
            number, model, width, height = values.take("iiQQ")
            name = _MODELS.get(model, f"number {model}")
            camera = Camera(name, width, height, values.take(f"{PARAMETERS.get(name, 0)}d"))
            check_camera(camera, number, path)
            cameras[number] = camera
    except struct.error as error:
        raise Failure(f"{path} is damaged") from error
    return cameras
