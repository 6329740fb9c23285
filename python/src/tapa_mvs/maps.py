"""Maps of a workspace as numpy arrays, float32, row by row from the top.

name: of the photograph, as in the sparse model. input_type: "geometric" or "photometric"; None:
geometric maps if the photograph has them. Raise Error if a map is not there or is damaged.
"""

import functools
import glob
import os

import numpy as np

from .errors import Error, failures_as_errors
from .evaluation import depth_maps
from .evaluation.exchange import confidences
from .evaluation.page.workspace import Workspace
from .evaluation.processes import Failure

_TYPES = ("geometric", "photometric")


def read_depth_map(workspace, name, input_type=None):
    """Depths, (height, width): z in the camera's frame, in units of the sparse model; 0: none."""
    with failures_as_errors():
        return _array(depth_maps.read_map(_path(workspace, "depth_maps", name, input_type)))


def read_normal_map(workspace, name, input_type=None):
    """Normals, (height, width, 3): x, y, z in the camera's frame, towards the camera; 0: none."""
    with failures_as_errors():
        return _array(depth_maps.read_map(_path(workspace, "normal_maps", name, input_type), 3))


def read_confidence_map(workspace, name, input_type=None, source=None):
    """How many views confirm each pixel, (height, width); 0: none, or no depth.

    source: "points" is the confidence of the fused points (fused*.ply in the workspace) that the
    photograph sees; "graphs" the number of source photographs that agree with the pixel, where
    stereo ran with write_consistency_graph; None the first that there is.
    """
    _check("source", source, ("points", "graphs"))
    with failures_as_errors():
        input_type = _type(workspace, "depth_maps", name, input_type)
        depth = depth_maps.read_bin(_path(workspace, "depth_maps", name, input_type))
        folder = os.path.abspath(workspace)
        files, found = _read_points(folder, _stamp(folder))
        if name not in files.views:
            raise Error(f"the sparse model of {workspace} has no photograph {name}")
        if not found or source == "graphs":
            found = confidences.find(files, [name], input_type, source)
        if not found:
            raise Error(f"{workspace} has neither fused points (fused*.ply) nor consistency "
                        "graphs: run stereo_fusion, or patch_match_stereo with "
                        "write_consistency_graph")
        return _array(found.of_view(files.views[name], depth))


@functools.lru_cache(maxsize=1)  # All photographs of a workspace see the same points.
def _read_points(folder, _):
    """The Workspace, and the confidence of its fused points, None if there are none."""
    workspace = Workspace(folder)
    try:
        return workspace, confidences.find(workspace, [], "", "points")
    except Failure:  # Without points that can be read.
        return workspace, None


def _stamp(folder):
    """What changes when the model or the points of a workspace do."""
    paths = [path for pattern in ("fused*.ply*", "sparse/*")
             for path in glob.glob(os.path.join(glob.escape(folder), pattern))]
    return tuple((path, os.stat(path).st_mtime_ns) for path in sorted(paths))


def _array(values):
    return np.array(values, np.float32, order="C")


def _check(what, value, values):
    if value is not None and value not in values:
        raise ValueError(f"{what} is {value!r}, but must be {' or '.join(map(repr, values))}")


def _type(workspace, kind, name, input_type):
    _check("input_type", input_type, _TYPES)
    if input_type is None:
        return next((found for found in _TYPES
                     if os.path.exists(_path(workspace, kind, name, found))), _TYPES[0])
    return input_type


def _path(workspace, kind, name, input_type):
    input_type = _type(workspace, kind, name, input_type)
    return os.path.join(workspace, "stereo", kind, f"{name}.{input_type}.bin")
