"""Depth maps in files: planar z in the photograph's frame, 0 where there is none.

Arrays are float32 of shape (height, width). Unreadable files raise Failure with the
path in the message; a file appears under its name only when it is complete.
"""

import os
import re

import cv2
import numpy as np

from . import files
from .processes import Failure

PNG_STEPS_PER_METRE = 4000


def _bytes(path):
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError as error:
        raise Failure(f"{path} cannot be read: {error.strerror}") from error


def _known(depth):
    """What is no positive number becomes 0."""
    return np.where(np.isfinite(depth) & (depth > 0), depth, 0).astype(np.float32)


def read_png(path):
    """A 16-bit grey PNG, in metres."""
    encoded = cv2.imdecode(np.frombuffer(_bytes(path), np.uint8), cv2.IMREAD_UNCHANGED)
    if encoded is None or encoded.dtype != np.uint16 or encoded.ndim != 2:
        raise Failure(f"{path} is no 16-bit grey PNG")
    return (encoded / np.float32(PNG_STEPS_PER_METRE)).astype(np.float32)


def read_bin(path):
    """One of COLMAP's depth maps."""
    data = _bytes(path)
    header = re.match(rb"(\d+)&(\d+)&1&", data)
    if header is None:
        raise Failure(f"{path} is no depth map of COLMAP's")
    width, height = int(header[1]), int(header[2])
    if len(data) != header.end() + 4 * width * height:
        raise Failure(f"{path} has not the size that its header says")
    return _known(np.frombuffer(data, "<f4", offset=header.end()).reshape(height, width))


def read_raw(path, width, height):
    """One of ETH3D's depth maps: nothing but little-endian float32, row by row."""
    data = _bytes(path)
    if len(data) != 4 * width * height:
        raise Failure(f"{path} has {len(data)} bytes, but {width}x{height} depths need "
                         f"{4 * width * height}")
    return _known(np.frombuffer(data, "<f4").reshape(height, width))


def read(path):
    """A map in any format of this project, by its extension."""
    return read_png(path) if path.endswith(".png") else read_bin(path)


def find(folder, name):
    """Path of a photograph's map in a folder, "" if there is none.

    Named like the photograph, with .png or .bin, in its own sub-folder or without.
    """
    for stem in (os.path.splitext(name)[0], os.path.splitext(os.path.basename(name))[0]):
        for extension in (".png", ".bin"):
            path = os.path.join(folder, stem + extension)
            if os.path.isfile(path):
                return path
    return ""


def write_bin(path, depth):
    """Writes a map in COLMAP's format."""
    files.write_bytes(path, b"%d&%d&1&" % (depth.shape[1], depth.shape[0]),
                      np.ascontiguousarray(depth, "<f4").tobytes())
