"""How many views confirm each pixel of a view, as result pages show it.

Either the confidence of the fused points that the view sees (points), or the number of source
photographs that agree with the pixel by the consistency graph of its maps (graphs).
"""

import os

import numpy as np

from .. import depth_maps, point_clouds
from ..page import confidence
from ..processes import Failure

KINDS = ("points", "graphs", "none")


class OfPoints:
    """The confidence of a cloud's points on what a view's map shows."""
    meaning = "how many views confirm the fused point that the pixel sees, as weighed by fusion"

    def __init__(self, cloud, values):
        self._points, self._values = cloud.points, values

    def of_view(self, view, depth):
        """view: colmap_model.View."""
        values = confidence.seen_by(view, depth, self._points, self._values, depth.shape[1])
        return np.where(depth_maps.is_depth(depth), values, 0)


class OfGraphs:
    """How many photographs agree at each pixel, by the graphs in a folder."""
    meaning = "how many source photographs agree with the pixel, by its consistency graph"

    def __init__(self, path_of):
        self._path_of = path_of

    def of_view(self, view, depth):
        return confidence.read_graph(self._path_of(view.name), depth.shape)


def find(workspace, names, input_type, kind):
    """What the confidence of these views is taken from, None for nothing.

    workspace: of a page. kind: of KINDS, None for the first that the workspace has.
    Raises Failure if it has not what is asked for.
    """
    source = None
    if kind in (None, "points"):
        source = _points(workspace)
    if not source and kind in (None, "graphs"):
        source = _graphs(workspace, names, input_type)
    if not source and kind in ("points", "graphs"):
        raise Failure(
            f"{workspace.folder} has no " + (
                "points with confidence (fused*.ply): run stereo_fusion" if kind == "points" else
                f"consistency graph of every view (stereo/consistency_graphs/*.{input_type}.bin): "
                "run patch_match_stereo with --PatchMatchStereo.write_consistency_graph 1")
            + ", or take another --confidence")
    return source


def _points(workspace):
    for path in workspace.clouds:
        cloud = point_clouds.read_cloud(path)
        values = confidence.of_points(cloud, path)
        if values is not None and len(values):
            return OfPoints(cloud, values)
    return None


def _graphs(workspace, names, input_type):
    def path_of(name):
        return workspace.path("stereo", "consistency_graphs", f"{name}.{input_type}.bin")

    return OfGraphs(path_of) if all(os.path.exists(path_of(name)) for name in names) else None
