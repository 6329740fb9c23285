"""All views' maps of a workspace into a folder of files for other programs (layout.py)."""

import math
import os
from typing import NamedTuple

import numpy as np

from .. import depth_maps, processes, progress, workspaces
from ..page.workspace import Workspace
from ..processes import Failure
from . import confidences, formats, layout

_CONFIDENCE_SCALE = 100  # Of a PNG: up to 655 views, to a hundredth.


class _Task(NamedTuple):
    """A view to export: its maps (workspaces.View), and what the model knows of it."""
    maps: workspaces.View
    view: object


class Export:
    """Writes the files of a workspace's views one by one.

    depth_scale: of PNG, None to take what fits the largest depth; confidence: of
    confidences.KINDS, None for what there is.
    """

    def __init__(self, workspace, input_type, extension, depth_scale=None, confidence=None):
        self._workspace = Workspace(workspace)
        self._input_type = input_type
        self._extension = extension
        self._tasks = self._find_tasks()
        self._confidence = confidences.find(
            self._workspace, [task.view.name for task in self._tasks], input_type, confidence)
        self._scales = {layout.DEPTH: depth_scale or self._fitting_scale(),
                        layout.CONFIDENCE: _CONFIDENCE_SCALE} if extension == ".png" else {}

    def _find_tasks(self):
        views = self._workspace.views
        found = workspaces.list_views(self._workspace.folder, self._input_type)
        layout.warn([maps.name for maps in found if maps.name not in views],
                    "maps are of no photograph of the sparse model and left out")
        tasks = [_Task(maps, views[maps.name]) for maps in found if maps.name in views]
        if not tasks:
            raise Failure(f"no map in {self._workspace.path('stereo')} is of a photograph of the "
                          "sparse model; name the workspace that they were made in")
        return tasks

    def _fitting_scale(self):
        """So that the largest depth of all views has a value, and a step is a round number.

        Scenes have any unit, so that no step fits all; one for all views lets them be compared.
        """
        largest = max(float(depth_maps.read_bin(task.maps.depth).max())
                      for task in self._each("measuring"))
        return _round_below(formats.LARGEST / largest) if largest > 0 else 1000

    def _each(self, what):
        return progress.each(self._tasks, what, lambda task: task.view.name)

    def write(self, folder):
        """Fills a folder. Returns what is in it, in words."""
        cameras, without_normals = {}, []
        for task in self._each("exporting"):
            depth = depth_maps.read_bin(task.maps.depth)
            self._write_depth(folder, task, depth)
            if os.path.exists(task.maps.normals):
                self._write_normals(folder, task, depth)
            else:
                without_normals.append(task.view.name)
            if self._confidence:
                self._write_numbers(folder, layout.CONFIDENCE, task,
                                    self._confidence.of_view(task.view, depth))
            cameras[task.view.name] = task.view.camera.resized(*depth.shape[::-1])
        layout.warn(without_normals, "views have no normals")
        layout.write_record(folder, self._extension, self._input_type, cameras, self._scales,
                            self._confidence and self._confidence.meaning)
        return self._summary()

    def _path(self, folder, kind, task):
        return layout.map_path(folder, kind, task.view.name, self._extension)

    def _write_depth(self, folder, task, depth):
        self._write_numbers(folder, layout.DEPTH, task, depth)
        if self._scales:
            scale = self._scales[layout.DEPTH]
            lost = np.count_nonzero((depth > 0) & (depth <= 0.5 / scale))
            if lost:
                processes.say(f"WARNING: {lost} depths of {task.view.name} are less than half a "
                              f"step of 1 / {scale:g} and become holes; other formats keep them")

    def _write_normals(self, folder, task, depth):
        normals = depth_maps.read_map(task.maps.normals, 3)
        if normals.shape[:2] != depth.shape:
            raise Failure(f"{task.maps.normals} is not of the size of {task.maps.depth}; run "
                          "patch_match_stereo again")
        is_normal = np.isfinite(normals).all(axis=2, keepdims=True)
        formats.write_normals(self._path(folder, layout.NORMALS, task),
                              np.where(is_normal, normals, 0))

    def _write_numbers(self, folder, kind, task, values):
        scale = self._scales.get(kind, 1)
        largest = float(values.max())
        if self._scales and round(largest * scale) > formats.LARGEST:
            way_out = (f"lower --depth_scale to {_round_below(formats.LARGEST / largest):g}"
                       if kind == layout.DEPTH else "take --confidence none")
            raise Failure(f"the largest {kind} of {task.view.name}, {largest:g}, does not fit "
                          f"into 16 bits at {scale:g} steps per unit; {way_out}, or another "
                          "format")
        formats.write_numbers(self._path(folder, kind, task), values, scale)

    def _summary(self):
        text = f"{len(self._tasks)} views, as {self._extension[1:].upper()}"
        if self._scales:
            scale = self._scales[layout.DEPTH]
            text += f" with depth = value / {scale:g}, in steps of {1 / scale:g}"
        return text + (f"; confidence: {self._confidence.meaning}" if self._confidence else
                       "; no confidence: there are no fused points and no consistency graphs, or "
                       "they are not wanted")


def _round_below(value):
    """The largest of 1, 2 and 5 times a power of ten that is not larger."""
    exponent = math.floor(math.log10(value))
    numbers = [float(f"{digit}e{exponent + more}")
               for more in (-1, 0) for digit in (1, 2, 5)]  # Logarithms are rounded.
    return max(number for number in numbers if number <= value)
