"""Files of any program as depth and normals of a workspace's views."""

import os
from typing import NamedTuple

import numpy as np

from .. import colmap_model, depth_maps, files
from ..processes import Failure
from . import formats, layout, slopes


class _Task(NamedTuple):
    """A view (colmap_model.View) and its files; normals "" where there are none."""
    view: object
    depth: str
    normals: str


class Source:
    """A folder of files, laid out as by an export (layout.py) or with depth maps alone in it.

    depth_scale: value of one unit of the sparse model in the files, None to take what the record
    of an export says of PNG, and 1 for other formats.
    """

    def __init__(self, folder, depth_scale=None, resizes=False):
        if not os.path.isdir(folder):
            raise Failure(f"no folder of maps at {folder}")
        self._folder = folder
        inside = os.path.join(folder, layout.DEPTH)
        self._depth_folder = inside if os.path.isdir(inside) else folder
        self._scale = depth_scale
        self._recorded_scale = layout.read_record(folder).depth_scale
        self._resizes = resizes

    def find(self, views):
        """Tasks for the views that there is depth of. Raises Failure if there are none."""
        depth = _find_files(self._depth_folder, views)
        normals = _find_files(os.path.join(self._folder, layout.NORMALS), views)
        tasks = [_Task(view, depth[view.name], normals[view.name])
                 for view in views if depth[view.name]]
        if not tasks:
            raise Failure(f"{self._depth_folder} has no depth of a photograph of the sparse model; "
                          f"that of {views[0].name} may be called {views[0].name}"
                          + " or ".join(formats.EXTENSIONS))
        self._report_others({task.depth for task in tasks})
        return tasks

    def _report_others(self, used):
        """Files that look like depth and are of no photograph."""
        aside = tuple(kind + os.sep for kind in (layout.NORMALS, layout.CONFIDENCE))
        others = [name for name in files.names_below(self._depth_folder)
                  if name.endswith(formats.EXTENSIONS)
                  and os.path.join(self._depth_folder, name) not in used
                  and not (self._depth_folder == self._folder and name.startswith(aside))]
        layout.warn(others, f"files in {self._depth_folder} are of no photograph of the sparse model")

    def read(self, task):
        """Depth and normals of a view, and whether all normals came from a file."""
        depth = formats.read_numbers(task.depth, self._scale_of(task.depth))
        if (depth < 0).any():
            raise Failure(f"{task.depth} has {np.count_nonzero(depth < 0)} negative depths; depth "
                          "grows away from the camera, and is 0 or NaN where there is none")
        depth = np.where(depth_maps.is_depth(depth), depth, np.float32(0))
        size = self._size(depth, task)
        camera = task.view.camera.resized(*size)
        if not task.normals:
            depth = _resampled(depth, size)
            return depth, slopes.normals_from_depth(depth, camera), False
        normals = _resampled(self._read_normals(task, depth.shape), size)
        depth = _resampled(depth, size)
        normals = _checked_normals(normals, camera, task.normals)
        lacks = (depth > 0) & ~normals.any(axis=2)
        if lacks.any():
            normals = np.where(lacks[:, :, None], slopes.normals_from_depth(depth, camera), normals)
        return depth, normals, True

    def _scale_of(self, path):
        if self._scale is not None:
            return self._scale
        if not formats.is_png(path):
            return 1
        if self._recorded_scale is None:
            raise Failure(f"nothing says what {path} is in: name the value of one unit of the "
                          "sparse model with --depth_scale, such as 1000 for millimetres in a "
                          "model in metres")
        return self._recorded_scale

    def _read_normals(self, task, shape):
        normals = formats.read_normals(task.normals)
        if normals.shape[:2] != shape:
            raise Failure(f"{task.normals} has {_size_text(normals)} pixels, but the depth of the "
                          f"view {shape[1]}x{shape[0]}; without it normals are computed from "
                          "depth")
        return np.where(np.isfinite(normals).all(axis=2, keepdims=True), normals, np.float32(0))

    def _size(self, depth, task):
        """Width and height that the maps of a view get: no larger than its photograph."""
        camera = task.view.camera
        height, width = depth.shape
        # As stereo_fusion asks for.
        if (abs(width * camera.height - height * camera.width)
                > max(width, height, camera.width, camera.height)):
            raise Failure(f"{task.depth} has {_size_text(depth)} pixels, which is not the shape "
                          f"of its photograph of {camera.width}x{camera.height}; export it anew, "
                          "at that size or smaller")
        if width <= camera.width and height <= camera.height:
            return width, height
        if not self._resizes:
            raise Failure(f"{task.depth} has {_size_text(depth)} pixels, more than its photograph "
                          f"of {camera.width}x{camera.height}; --resize makes it smaller")
        return camera.width, camera.height


def _find_files(folder, views):
    """By name of the photographs, "" for none. Raises Failure if one has several."""
    names = [view.name for view in views]
    found = dict.fromkeys(names, "")
    for extension in formats.EXTENSIONS:
        for name, path in depth_maps.find_all(folder, names, (extension,)).items():
            if path and found[name]:
                raise Failure(f"{found[name]} and {path} are both of {name}; remove one of them")
            found[name] = path or found[name]
    return found


def _resampled(values, size):
    """Takes the nearest pixels: means would lie between surfaces."""
    height, width = values.shape[:2]
    if (width, height) == size:
        return values
    rows, columns = (((np.arange(new) + 0.5) * old / new).astype(int)
                     for old, new in zip((height, width), size[::-1]))
    return np.ascontiguousarray(values[rows[:, None], columns])


def _checked_normals(normals, camera, path):
    """Normals of unit length. Raises Failure if a file is wrong as a whole; a pixel may be."""
    length = np.linalg.norm(normals, axis=2)
    is_off = (length > 0) & (np.abs(length - 1) > 1e-3)
    if _most(np.abs(length - 1) > 0.1, length > 0):
        raise Failure(f"{path} has vectors that are not of unit length; normals are x, y, z from "
                      "-1 to 1, in a PNG 0 to 65535. Without it they are computed from depth")
    u, v = colmap_model.pixel_rays(camera)
    if _most(normals[:, :, 0] * u + normals[:, :, 1] * v + normals[:, :, 2] > 0, length > 0):
        raise Failure(f"{path} has normals that point away from the camera; they should be in the "
                      "camera's frame, x to the right, y down, z forward. Without it they are "
                      "computed from depth")
    # Others stay as they are, to the last bit.
    return normals / np.where(is_off, length, np.float32(1))[:, :, None]


def _most(has_fault, counts):
    """Whether more than half of the pixels that count have a fault."""
    return 2 * np.count_nonzero(has_fault & counts) > np.count_nonzero(counts)


def _size_text(values):
    return f"{values.shape[1]}x{values.shape[0]}"
