"""How many views confirm what a photograph sees, as maps of numbers."""

import array
import functools
import os
import re

import numpy as np

from .. import blocks, files
from ..processes import Failure

_SAME_DEPTH = 0.01  # Relative: a point that is farther from a map is hidden or not of it.


def of_points(cloud, path):
    """The confidence of each point, in views: from the cloud, or of how many views it is.

    None if neither the cloud nor PATH.vis, its list of views, knows it.
    """
    if cloud.confidence is not None:
        return cloud.confidence
    if not os.path.exists(path + ".vis"):
        return None
    counts = _count_views(path + ".vis")
    if len(counts) != len(cloud.kept):
        raise Failure(f"{path}.vis is not of {path}: it has {len(counts)} points, not "
                      f"{len(cloud.kept)}; fuse again, or remove it")
    return counts[cloud.kept]


def _count_views(path):
    """Numbers of views of the points of a COLMAP visibility file."""
    data = files.read_bytes(path)
    words = np.frombuffer(data, "<u4", offset=8) if len(data) % 4 == 0 and len(data) >= 8 else []
    words, at, counts = list(map(int, words)), 0, []
    while at < len(words):
        counts.append(words[at])
        at += 1 + words[at]
    if at != len(words) or len(data) < 8 or len(counts) != int.from_bytes(data[:8], "little"):
        raise Failure(f"{path} is damaged; fuse again, or remove it")
    return np.array(counts, np.float32)


def seen_by(view, depth, points, confidence, width):
    """The confidence of points on what a view's map shows, 0 where there is none.

    The map that comes out is width wide.
    """
    height = max(1, round(width * depth.shape[0] / depth.shape[1]))
    values = np.zeros((height, width), np.float32)
    for block in blocks.slices(len(points)):
        _draw_seen(values, view, depth, points[block].astype(np.float64), confidence[block])
    # Points may be fewer than pixels.
    return np.where(values > 0, values, _largest_around(values))


def _largest_around(values):
    """Of the 3 x 3 pixels around each, the largest value; values are not negative."""
    height, width = values.shape
    padded = np.pad(values, 1)
    return functools.reduce(np.maximum, (
        padded[row:row + height, column:column + width] for row in range(3)
        for column in range(3)))


def _draw_seen(values, view, depth, points, confidence):
    """Where points are seen, values become at least their confidence."""
    height, width = values.shape
    fx, fy, cx, cy = view.camera.pinhole
    x, y, z = view.rotation @ points.T + view.translation[:, None]
    with np.errstate(all="ignore"):
        u, v = (fx * x / z + cx) / view.camera.width, (fy * y / z + cy) / view.camera.height
    inside = np.flatnonzero((z > 0) & (u >= 0) & (u < 1) & (v >= 0) & (v < 1))
    u, v, z = u[inside], v[inside], z[inside]
    found = depth[(v * depth.shape[0]).astype(int), (u * depth.shape[1]).astype(int)]
    seen = np.abs(found - z) < _SAME_DEPTH * z
    np.maximum.at(values, ((v[seen] * height).astype(int), (u[seen] * width).astype(int)),
                  confidence[inside[seen]])


def read_graph(path, shape):
    """How many photographs agree at each pixel, by a consistency graph of COLMAP.

    shape: of the map that it belongs to. Its own says nothing of how large the file is.
    """
    data = files.read_bytes(path)
    header = re.match(rb"(\d{1,6})&(\d{1,6})&1&", data)
    try:
        width, height = map(int, header.groups())
        if (height, width) != shape:
            raise Failure(f"{path} has {width}x{height} pixels, but the map "
                          f"{shape[1]}x{shape[0]}; remove it, or compute the maps again")
        words = array.array("i", data[header.end():])
        counts, at = np.zeros((height, width), np.float32), 0
        while at < len(words):
            column, row, count = words[at:at + 3]
            if min(column, row, count) < 0:
                raise ValueError
            counts[row, column] = count
            at += 3 + count
    except (AttributeError, ValueError, IndexError) as error:
        raise Failure(f"{path} is not a consistency graph of COLMAP, or damaged; remove it to "
                      "go on without it") from error
    return counts
