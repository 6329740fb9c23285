"""Depth maps in files: planar z in the photograph's frame, 0 where there is none.

Arrays are float32 of shape (height, width). Unreadable files raise Failure with the
path in the message; a file appears under its name only when it is complete.
"""

import os
import re

import numpy as np

from . import files
from .processes import Failure

PNG_STEPS_PER_METRE = 4000
_EXTENSIONS = (".png", ".bin")


def is_depth(values):
    return np.isfinite(values) & (values > 0)


def _known(depth):
    """What is no positive number becomes 0."""
    return np.where(is_depth(depth), depth, 0).astype(np.float32)


def read_png(path, steps_per_metre=PNG_STEPS_PER_METRE):
    """A 16-bit grey PNG, in metres."""
    import cv2  # Other maps can be read where there is none.
    from . import images
    values = images.read(path, cv2.IMREAD_UNCHANGED)
    if values.dtype != np.uint16 or values.ndim != 2:
        raise Failure(f"{path} is not a 16-bit grey image")
    return (values.astype(np.float64) / steps_per_metre).astype(np.float32)


def read_map(path, channels=1):
    """One of COLMAP's depth maps, or with 3 channels normal maps, as it stands in the file.

    Normals are of shape (height, width, 3).
    """
    data = files.read_bytes(path)
    header = re.match(rb"0*([1-9]\d{0,6})&0*([1-9]\d{0,6})&0*([1-9]\d{0,6})&", data)
    if header is None:
        raise Failure(f"{path} is not a COLMAP depth or normal map")
    width, height, found = map(int, header.groups())
    if found != channels:
        raise Failure(f"{path} has {found} channels, but {channels} expected")
    size, needed = len(data) - header.end(), 4 * width * height * channels
    if size != needed:
        raise Failure(f"{path} is {'truncated' if size < needed else 'too long'}: {size} bytes of "
                      f"values where the size {width}x{height}x{channels} needs {needed}")
    values = np.frombuffer(data, "<f4", offset=header.end()).reshape(channels, height, width)
    return values[0] if channels == 1 else np.moveaxis(values, 0, 2)


def read_bin(path):
    """The depths of one of COLMAP's maps."""
    return _known(read_map(path))


def read_raw(path, width, height):
    """One of ETH3D's depth maps: nothing but little-endian float32, row by row."""
    data = files.read_bytes(path)
    if len(data) != 4 * width * height:
        raise Failure(f"{path} has {len(data)} bytes, but {width}x{height} depths need "
                         f"{4 * width * height}")
    return _known(np.frombuffer(data, "<f4").reshape(height, width))


def read(path, steps_per_metre=PNG_STEPS_PER_METRE):
    """Measured depth in either format of this project, by its extension."""
    return read_png(path, steps_per_metre) if path.endswith(".png") else read_bin(path)


def find(folder, name, extensions=_EXTENSIONS):
    """Path of a photograph's map in a folder, "" if there is none.

    Named like the photograph, with its extension or without and with one of these, in its own
    sub-folder or without.
    """
    for stem in (name, os.path.splitext(name)[0], os.path.splitext(os.path.basename(name))[0]):
        for extension in extensions:
            path = os.path.join(folder, stem + extension)
            if os.path.isfile(path):
                return path
    return ""


def find_all(folder, names, extensions=_EXTENSIONS):
    """The same for many photographs, by name. Raises Failure if one would serve for two."""
    paths, owners = {}, {}
    for name in names:
        path = paths[name] = find(folder, name, extensions)
        if path and owners.setdefault(path, name) != name:
            full = " or ".join(name + extension for extension in extensions)
            raise Failure(f"{path} could be the depth of both {owners[path]} and {name}; call it "
                          f"{full}, in full, in {folder}")
    return paths


def encode_bin(values):
    """Depths, or normals of shape (height, width, 3), as a file of COLMAP's has them."""
    planes = values if values.ndim == 2 else np.moveaxis(values, 2, 0)
    channels = 1 if values.ndim == 2 else values.shape[2]
    head = b"%d&%d&%d&" % (values.shape[1], values.shape[0], channels)
    return head + np.ascontiguousarray(planes, "<f4").tobytes()


def write_bin(path, values):
    """Writes a map in COLMAP's format."""
    files.write_bytes(path, encode_bin(values))
