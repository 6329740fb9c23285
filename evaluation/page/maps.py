"""Pictures of a photograph and its maps, small, as they stand in a page."""

import base64
import os
from typing import NamedTuple

import cv2
import numpy as np
from matplotlib import cm, colors

from .. import depth_maps, images, view_picture
from ..texts import percent
from . import confidence

# What TAPA's pictures of the origin of a depth show (src/pictures/tapa_pictures.cc).
ORIGINS = (("swept", "#c8c8c8"), ("plane", "#56b4e9"), ("filled", "#e69f00"),
           ("no estimate", "#000000"))


class Picture(NamedTuple):
    """source: a data URI; bar: (CSS gradient, labels of its ends and middle), or None."""
    title: str
    source: str
    bar: tuple = None


class Photograph(NamedTuple):
    """name: of its file; facts: in words; distance: the median of its depths, None for none."""
    name: str
    pictures: list
    facts: list
    distance: float = None


def encode(image, format=".jpg", quality=80):
    """An image, (height, width, 3) of red, green and blue, as a data URI."""
    data = cv2.imencode(format, np.ascontiguousarray(image[:, :, ::-1]), [
        cv2.IMWRITE_JPEG_QUALITY, quality, cv2.IMWRITE_PNG_COMPRESSION, 9])[1]
    kind = "jpeg" if format == ".jpg" else "png"
    return f"data:image/{kind};base64,{base64.b64encode(data).decode('ascii')}"


def normals_legend():
    return encode(view_picture.normal_ball(61), ".png")


class Painter:
    """Draws photographs of a workspace (workspace.py), their pictures at most width wide.

    points: of the cloud with their confidence, None where it is not known.
    """

    def __init__(self, workspace, width, tapa_debug, points=None):
        self._workspace = workspace
        self._width = width
        self._tapa_debug = tapa_debug
        self._points, self._confidence = points or (None, None)
        self.most_views = float(np.percentile(self._confidence, 98)) if points else 0
        # Titles of the pictures that there are of any photograph.
        self.titles = set()

    def paint(self, view):
        """The Photograph of a view with maps (workspaces.View)."""
        depth = depth_maps.read_map(view.depth)
        known = depth_maps.is_depth(depth)
        pictures = [*self._photograph(view), self._depth(depth, known), *self._normals(view),
                    *self._confident(view, depth), *self._agreeing(view, depth), *self._origin(view)]
        self.titles.update(picture.title for picture in pictures)
        facts = [f"depth at {percent(known.mean(), 0)} % of {depth.shape[1]} x {depth.shape[0]} "
                 "pixels"]
        distance = float(np.median(depth[known])) if known.any() else None
        return Photograph(view.name, pictures, facts, distance)

    def _fit(self, image, interpolation=cv2.INTER_AREA):
        """Not larger than asked for."""
        height, width = image.shape[:2]
        if width <= self._width:
            return image
        return cv2.resize(image, (self._width, max(1, round(height * self._width / width))),
                          interpolation=interpolation)

    def _photograph(self, view):
        if os.path.exists(view.photograph):
            yield Picture("photograph",
                          encode(self._fit(images.read_color(view.photograph)[:, :, ::-1])))

    def _depth(self, depth, known):
        scale = view_picture.depth_scale(depth)
        near, far = scale.norm.vmin, scale.norm.vmax
        image = view_picture.color(depth, scale, known, "black")
        labels = [f"{value:.3g}" for value in (near, 2 / (1 / near + 1 / far), far)]
        return Picture("depth", encode(self._fit(image)), (gradient(scale.cmap), labels))

    def _normals(self, view):
        if os.path.exists(view.normals):
            normals = depth_maps.read_map(view.normals, 3)
            yield Picture("normals", encode(self._fit(view_picture.color_normals(normals))))

    def _confident(self, view, depth):
        if self._confidence is not None:
            values = confidence.seen_by(self._workspace.views[view.name], depth, self._points,
                                        self._confidence, min(self._width, depth.shape[1]))
            yield _numbers("confidence of points", values, self.most_views)

    def _agreeing(self, view, depth):
        name = f"{view.name}.{self._workspace.kind}.bin"
        path = self._workspace.path("stereo", "consistency_graphs", name)
        if os.path.exists(path):
            counts = confidence.read_graph(path, depth.shape)
            yield _numbers("photographs that agree", self._fit(counts, cv2.INTER_NEAREST),
                           max(1, counts.max()))

    def _origin(self, view):
        path = os.path.join(self._tapa_debug, view.name, "11_origin.png")
        if os.path.exists(path):
            image = images.read_color(path)[:, :, ::-1]
            yield Picture("origin of depth", encode(self._fit(image, cv2.INTER_NEAREST), ".png"))


def _numbers(title, values, most):
    """Numbers of views, up to most, as a picture; black where there is none."""
    scale = cm.ScalarMappable(colors.Normalize(0, most, clip=True), "viridis")
    image = view_picture.color(values, scale, values > 0, "black")
    # They change from pixel to pixel, which takes much place at a higher quality.
    return Picture(title, encode(image, quality=60), (gradient(scale.cmap), [
        "0", f"{most / 2:.3g}", f"{most:.3g}"]))


def gradient(colormap):
    """A colour map as CSS."""
    return "linear-gradient(to right," + ",".join(
        colors.to_hex(colormap(place)) for place in np.linspace(0, 1, 13)) + ")"
