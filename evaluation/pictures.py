"""Pictures of views: photograph, depth, normals, measured depth and error."""

import os
import shutil

from . import depth_maps, files, links, machine, processes
from .methods import METHODS, label

_WIDTH = 800
_QUALITY = 75


def _draw_view(data, maps, name, bin_dir):
    """Draws a view with evaluate_depth_maps into MAPS/pictures. Returns its path.

    maps: the workspace whose maps are drawn. A picture that is newer than what
    it shows is kept.
    """
    truth = os.path.join(data, "gt_depth")
    folder = os.path.join(maps, "pictures")
    picture = os.path.splitext(name)[0] + ".png"
    path = os.path.join(folder, picture)
    if not files.is_newer(path, workspaces.find_map(maps, name), depth_maps.find(truth, name)):
        workspace = os.path.join(folder, "workspace")
        shutil.rmtree(workspace, ignore_errors=True)
        workspaces.make_view_workspace(data, maps, workspace, [name])
        command = [machine.find_program(bin_dir or machine.default_bin_dir(),
                                        "evaluate_depth_maps"),
                   "--workspace_path", workspace, "--pictures", os.path.join(workspace, "new")]
        if os.path.isdir(truth):
            command += ["--ground_truth_path", truth]
        processes.run(command, os.path.join(folder, "pictures.log"))
        os.makedirs(os.path.dirname(path), exist_ok=True)
        os.replace(os.path.join(workspace, "new", picture), path)
        shutil.rmtree(workspace)
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


def draw_comparison(output, data, by_method, methods, view, bin_dir=None):
    """One view with the maps of several methods, one below the other.

    by_method: what results.load_set() returns; of several seeds the first is drawn.
    Returns the caption, None if no method has maps of this view.
    """
    folders = {method: run.folder for method in chosen_methods(methods)
               for run in by_method.get(method, [])[:1] if workspaces.find_map(run.folder, view)}
    if not folders:
        return None
    titles = [label(method) for method in folders]
    _stack([_draw_view(data, folder, view, bin_dir) for folder in folders.values()], titles,
           output)
    return (f"**{view}.** From above: {', '.join(titles)}. Black in the depth is \"no "
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
