"""Pictures of views: photograph, depth, normals, measured depth and error."""

import os

import cv2

from . import depth_maps, files, images, view_picture, workspaces
from .methods import METHODS, label

_WIDTH = 800
_QUALITY = 75


def _draw_view(data, maps, view, title):
    """Draws a view of the workspace MAPS into MAPS/pictures. Returns its path.

    A picture that is newer than what it shows is kept.
    """
    truth = depth_maps.find(os.path.join(data, "gt_depth"), view.name)
    path = os.path.join(maps, "pictures", os.path.splitext(view.name)[0] + ".png")
    if not files.is_newer(path, view.depth, truth):
        view_picture.draw(path, view, depth_maps.read_map(view.depth),
                          depth_maps.read(truth) if truth else None, title)
    return path


def _stack(paths, output):
    """Writes a JPEG with pictures one below the other."""
    pictures = [images.read_color(path) for path in paths]
    stacked = cv2.vconcat([cv2.resize(
        picture, (_WIDTH, max(1, round(picture.shape[0] * _WIDTH / picture.shape[1]))),
        interpolation=cv2.INTER_AREA) for picture in pictures])
    quality = [cv2.IMWRITE_JPEG_QUALITY, _QUALITY, cv2.IMWRITE_JPEG_OPTIMIZE, 1]
    files.write_bytes(output, cv2.imencode(".jpg", stacked, quality)[1].tobytes())


def draw_comparison(output, data, by_method, methods, name):
    """One view with the maps of several methods, one below the other.

    by_method: what results.load_set() returns; of several seeds the first is drawn.
    Returns the caption, None if no method has maps of this view.
    """
    runs = {method: run for method in chosen_methods(methods)
            for run in by_method.get(method, [])[:1]}
    views = {method: workspaces.find_view(data, run.folder, name) for method, run in runs.items()}
    paths = {label(method): _draw_view(data, runs[method].folder, view, label(method))
             for method, view in views.items() if view}
    if not paths:
        return None
    _stack(paths.values(), output)
    return (f"**{name}.** From above: {', '.join(paths)}. Black in the depth is \"no "
            "estimate\"; the error is relative to the true depth, from green (0.1 % and less) "
            "over yellow (1 %) to red (10 % and more).")


def chosen_methods(methods):
    """Those that pictures show: without and with TAPA, and other tools."""
    return [method for method in methods
            if method in ("plain", "tapa") or method not in METHODS] or methods[:2]


def choose_views(data, every, count):
    """Names of count photographs, spread evenly over those that take part."""
    names = workspaces.photographs(data, every)
    count = min(count, len(names))
    return [names[(2 * i + 1) * len(names) // (2 * count)] for i in range(count)]
