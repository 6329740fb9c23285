"""Points and cameras as the viewer of a page takes them (templates/viewer.js)."""

import base64
import os

import numpy as np
from matplotlib import colormaps

from .. import point_clouds
from .thinning import thin

_GREY = 160
_SAMPLES = 2000  # Points whose nearest neighbours tell how close points are.


class Scene:
    """Clouds to choose from and cameras, relative to a place among the cameras.

    Positions are then precise enough in single precision, wherever the model is.
    """

    def __init__(self, views):
        centres = np.array([view.camera_to_world()[:3, 3] for view in views])
        self._origin = np.median(centres, axis=0)
        self._size = _typical_distance(centres)
        self._views = views
        self.clouds = []

    def add(self, name, cloud, confidence, count):
        """Adds a point_clouds.Cloud, thinned to at most count points.

        confidence: of its points, None where it is not known. Points come in falling order of it,
        so that those of at least some confidence are the first ones.
        """
        chosen = thin(cloud.points, count)
        most, levels = 0, None
        if confidence is not None and len(chosen):
            chosen = chosen[np.argsort(-confidence[chosen], kind="stable")]
            most = float(np.percentile(confidence, 98))
            levels = np.clip(np.round(255 * confidence[chosen] / max(most, 1e-9)), 0, 255)
        points = cloud.points[chosen] - self._origin
        colors = (np.full((len(chosen), 3), _GREY) if cloud.colors is None
                  else cloud.colors[chosen])
        self.clouds.append({
            "name": name, "total": len(cloud.points), "count": len(chosen), "most": most,
            "spacing": _spacing(points), "positions": _base64(points, "<f4"),
            "colors": _base64(colors, "u1"),
            "levels": None if levels is None else _base64(levels, "u1")})

    def json(self, distances=None):
        """All of it. distances: by name of the views with maps, to what they look at (None: to
        nothing); left out where maps are not known."""
        used = None if distances is None else set(distances)
        distances = distances or {}
        typical = [distance for distance in distances.values() if distance]
        typical = float(np.median(typical)) if typical else self._distance_of_points()
        size = min(self._size or 0.1 * typical, 0.1 * typical)
        cameras = [{"name": view.name, "corners": self._corners(view, size),
                    "used": used is None or view.name in used,
                    "distance": distances.get(view.name) or typical} for view in self._views]
        return {"clouds": self.clouds, "cameras": cameras, "typical": typical,
                "viridis": (255 * colormaps["viridis"](np.arange(256))[:, :3]).round().astype(
                    int).tolist()}

    def _corners(self, view, depth):
        """The camera's centre and the corners of its picture at a depth, as 15 numbers."""
        fx, fy, cx, cy = view.camera.pinhole
        rays = [[(x - cx) / fx, (y - cy) / fy, 1] for x, y in (
            (0, 0), (view.camera.width, 0), (view.camera.width, view.camera.height),
            (0, view.camera.height))]
        matrix = view.camera_to_world()
        centre = matrix[:3, 3] - self._origin
        corners = centre + depth * np.array(rays) @ matrix[:3, :3].T
        return [float(value) for value in np.vstack((centre, corners)).ravel()]

    def _distance_of_points(self):
        """For cameras without maps: how far points are from the cameras' middle."""
        for cloud in self.clouds:
            points = np.frombuffer(base64.b64decode(cloud["positions"]), "<f4").reshape(-1, 3)
            if len(points):
                return float(np.median(np.linalg.norm(points, axis=1)))
        return 10 * self._size or 1.0


def add_files(scene, paths, count, confidence_of, name_of=os.path.basename):
    """Adds the clouds of PLY files, which share the number of points. Returns the clouds read."""
    clouds = []
    for path in paths:
        cloud = point_clouds.read_cloud(path)
        values = confidence_of(cloud, path)
        scene.add(name_of(path), cloud, values, count // len(paths))
        clouds.append((cloud, values))
    return clouds


def _typical_distance(centres):
    """A third of the median distance to the nearest other camera; 0 for a single one."""
    distances = _nearest(centres, centres)
    return float(np.median(distances)) / 3 if len(distances) else 0.0


def _spacing(points):
    """How far apart most neighbouring points are at most; 0 where there are none."""
    distances = _nearest(points, points[::max(1, len(points) // _SAMPLES)])
    return float(np.percentile(distances, 90)) if len(distances) else 0.0


def _nearest(points, samples):
    """How far from each sample, which is one of the points, the nearest other one is."""
    from scipy.spatial import cKDTree  # Takes a while.
    if len(points) < 2:
        return np.empty(0)
    return cKDTree(points).query(samples, k=2)[0][:, 1]


def _base64(values, code):
    return base64.b64encode(np.ascontiguousarray(values, code).tobytes()).decode("ascii")
