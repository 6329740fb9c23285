"""Photographs in files, as OpenCV's arrays: 8 bits; blue, green, red.

Pictures are taken as they are stored: a camera's note on its orientation is ignored, as
COLMAP does. Unreadable files raise Failure with the path in the message.
"""

import contextlib
import os

import cv2
import numpy as np

from . import files
from .processes import Failure


@contextlib.contextmanager
def _silence():
    """Nothing is said on standard error: libpng and libjpeg write there on their own."""
    stderr = os.dup(2)
    with open(os.devnull, "wb") as null:
        os.dup2(null.fileno(), 2)
    try:
        yield
    finally:
        os.dup2(stderr, 2)
        os.close(stderr)


def read(path, mode):
    """mode: of OpenCV."""
    return decode(files.read_bytes(path), path, mode)


def decode(data, path, mode):
    """The same from the content of a file."""
    data = np.frombuffer(data, np.uint8)
    image = None
    try:
        with _silence():
            image = cv2.imdecode(data, mode) if len(data) else None
    except cv2.error:
        pass  # Too large for OpenCV.
    if image is None:
        raise Failure(f"{path} is not a readable image")
    return image


def read_color(path):
    return read(path, cv2.IMREAD_COLOR | cv2.IMREAD_IGNORE_ORIENTATION)


def read_grey(path, width, height):
    """0 to 255, resized if it has another size."""
    image = read(path, cv2.IMREAD_GRAYSCALE | cv2.IMREAD_IGNORE_ORIENTATION)
    if image.shape == (height, width):
        return image
    return cv2.resize(image, (width, height), interpolation=cv2.INTER_AREA)
