"""Numbers and normals per pixel in files that other programs know: EXR, PFM, 16-bit PNG and NPY.

Arrays are float32, numbers of shape (height, width) and normals of (height, width, 3). All but
PNG hold such values as they are. In a PNG a number is so many steps per unit, its scale, and the
components of a normal, -1 to 1, are 0 to 65535; a normal of zeros, which is none, is black.
Unreadable files raise Failure with the path in the message.
"""

import io
import os
import re
import tokenize

import cv2
import numpy as np

from .. import depth_maps, files, images
from ..processes import Failure
from . import exr_channels

EXTENSIONS = (".exr", ".pfm", ".png", ".npy")
LARGEST = 65535  # Of 16 bits.

# OpenCV of Debian reads and writes EXR, but wants to be asked.
os.environ.setdefault("OPENCV_IO_ENABLE_OPENEXR", "1")


def is_png(path):
    return path.endswith(".png")


def write_numbers(path, values, scale=1):
    """scale: of a PNG, which has to hold the largest of the values, and none is negative."""
    _write(path, np.rint(values.astype(np.float64) * scale).astype(np.uint16) if is_png(path)
           else values)


def write_normals(path, normals):
    if is_png(path):
        is_known = normals.any(axis=2, keepdims=True)
        steps = np.rint((np.clip(normals.astype(np.float64), -1, 1) + 1) / 2 * LARGEST)
        normals = np.where(is_known, steps, 0).astype(np.uint16)
    _write(path, normals)


def read_numbers(path, scale):
    """scale: what one unit is in the file, whatever its format."""
    if is_png(path):
        return depth_maps.read_png(path, scale)
    values = _read_floats(path, 1)
    return values if scale == 1 else (values.astype(np.float64) / scale).astype(np.float32)


def read_normals(path):
    if not is_png(path):
        return _read_floats(path, 3)
    steps = images.read(path, cv2.IMREAD_UNCHANGED)
    if steps.dtype != np.uint16 or steps.ndim != 3:
        raise Failure(f"{path} is not a 16-bit image in colour")
    normals = steps[:, :, 2::-1] / LARGEST * 2 - 1
    return np.where(steps[:, :, :3].any(axis=2, keepdims=True), normals, 0).astype(np.float32)


def _write(path, values):
    extension = os.path.splitext(path)[1]
    if extension == ".npy":
        data = io.BytesIO()
        np.save(data, values)
        files.write_bytes(path, data.getvalue())
        return
    # OpenCV's order of channels is blue, green, red.
    image = values if values.ndim == 2 else values[:, :, ::-1]
    try:
        files.write_bytes(path, cv2.imencode(extension, np.ascontiguousarray(image))[1].tobytes())
    except cv2.error as error:
        raise Failure(f"{path} cannot be written: this OpenCV has no {extension} of "
                      f"{image.dtype}; take another format") from error


def _read_floats(path, channels):
    values = _read_npy(path) if path.endswith(".npy") else _decode(path)
    shape = " x ".join(map(str, values.shape))
    if values.dtype.kind != "f":
        raise Failure(f"{path} holds {values.dtype}, not floating-point numbers")
    if values.ndim == 3 and channels == 3 and values.shape[2] in (3, 4):
        values = values[:, :, :3]  # Without alpha.
    elif values.ndim != 2 or channels != 1:
        raise Failure(f"{path} is of shape {shape}; it should be height x width"
                      + (" x 3" if channels == 3 else ""))
    with np.errstate(over="ignore"):
        return np.array(values, np.float32)


def _decode(path):
    """An EXR or PFM file; red, green and blue in this order."""
    data = files.read_bytes(path)
    if path.endswith(".exr"):
        data = exr_channels.for_opencv(data, path)
    else:
        _check_pfm(data, path)
    values = images.decode(data, path, cv2.IMREAD_UNCHANGED)
    return values if values.ndim == 2 else values[:, :, [2, 1, 0, *range(3, values.shape[2])]]


def _check_pfm(data, path):
    """Refuses a scale: some programs multiply by it, some divide, and most take no notice."""
    header = re.match(rb"P[fF]\s+\d+\s+\d+\s+(\S+)", data)
    try:
        if header and abs(float(header[1])) != 1:
            raise Failure(f"{path} has the scale {header[1].decode()} in its header; it should be "
                          "1 or -1, with depths as they are")
    except ValueError:
        pass  # No number: OpenCV finds that, too.


def _read_npy(path):
    try:
        # Maps the file, so that a damaged header cannot ask for all memory.
        return np.lib.format.open_memmap(path, mode="r")
    except OSError as error:
        raise Failure(f"{path} cannot be read: {error.strerror}") from error
    except (ValueError, TypeError, SyntaxError, EOFError, OverflowError,
            tokenize.TokenError) as error:
        raise Failure(f"{path} is not a readable NPY file of numbers") from error
