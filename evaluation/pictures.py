"""Pictures of views: photograph, depth, normals, measured depth and error."""

import os

from . import depth_maps, files, view_picture, workspaces
from .methods import METHODS, label

_WIDTH = 800
_QUALITY = 75


def _draw_view(data, maps, view):
    """Draws a view of the workspace MAPS into MAPS/pictures. Returns its path.

    A picture that is newer than what it shows is kept.
    """
    truth = depth_maps.find(os.path.join(data, "gt_depth"), view.name)
    path = os.path.join(maps, "pictures", os.path.splitext(view.name)[0] + ".png")
    if not files.is_newer(path, view.depth, truth):
        view_picture.draw(path, view, depth_maps.read_map(view.depth),
                          depth_maps.read(truth) if truth else None)
    return path


def _stack(paths, titles, output):
    """Writes a JPEG with pictures one below the other, a title above each."""
    from PIL import Image, ImageDraw, ImageFont
    import matplotlib
    # matplotlib's own font, so that all machines write the same.
    font = ImageFont.truetype(os.path.join(matplotlib.get_data_path(), "fonts", "ttf",
                                           "DejaVuSans-Bold.ttf"), 16)
    margin = 26
    pictures = []
    for path in paths:
        picture = Image.open(path).convert("RGB")
        height = max(1, round(picture.height * _WIDTH / picture.width))
        pictures.append(picture.resize((_WIDTH, height), Image.LANCZOS))
    height = sum(picture.height + margin for picture in pictures)
    canvas = Image.new("RGB", (_WIDTH, height), "white")
    draw = ImageDraw.Draw(canvas)
    y = 0
    for picture, title in zip(pictures, titles):
        draw.text((8, y + 4), title, fill="black", font=font)
        canvas.paste(picture, (0, y + margin))
        y += margin + picture.height
    with files.replacing(output) as new:
        canvas.save(new, format="JPEG", quality=_QUALITY, optimize=True)


def draw_comparison(output, data, by_method, methods, name):
    """One view with the maps of several methods, one below the other.

    by_method: what results.load_set() returns; of several seeds the first is drawn.
    Returns the caption, None if no method has maps of this view.
    """
    runs = {method: run for method in chosen_methods(methods)
            for run in by_method.get(method, [])[:1]}
    views = {method: workspaces.find_view(data, run.folder, name) for method, run in runs.items()}
    paths = {label(method): _draw_view(data, runs[method].folder, view)
             for method, view in views.items() if view}
    if not paths:
        return None
    _stack(paths.values(), paths, output)
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
