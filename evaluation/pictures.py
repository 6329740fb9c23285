"""Pictures of views: photograph, depth, normals, measured depth and error."""

import os
import shutil

from . import depth_maps, files, links, machine, processes
from .methods import METHODS, label

_WIDTH = 800
_QUALITY = 75


def _stem(name):
    return os.path.splitext(name)[0]


def draw_views(data, maps, folder, names, bin_dir=None):
    """Draws views with evaluate_depth_maps into folder. Returns their paths.

    maps: the workspace whose maps are drawn. A picture that is newer than what
    it shows is kept.
    """
    bin_dir = bin_dir or machine.default_bin_dir()
    truth = os.path.join(data, "gt_depth")
    paths = [os.path.join(folder, _stem(name) + ".png") for name in names]
    missing = [name for name, path in zip(names, paths)
               if not files.is_newer(path, links.find_map(maps, name),
                                     depth_maps.find(truth, name))]
    if missing:
        workspace = os.path.join(folder, "workspace")
        shutil.rmtree(workspace, ignore_errors=True)
        links.make_view_workspace(data, maps, workspace, missing)
        command = [machine.find_program(bin_dir, "evaluate_depth_maps"),
                   "--workspace_path", workspace, "--pictures",
                   os.path.join(folder, "new")]
        if os.path.isdir(truth):
            command += ["--ground_truth_path", truth]
        processes.run(command, os.path.join(folder, "pictures.log"))
        for name in missing:
            path = os.path.join(folder, _stem(name) + ".png")
            os.makedirs(os.path.dirname(path), exist_ok=True)
            os.replace(os.path.join(folder, "new", _stem(name) + ".png"), path)
        shutil.rmtree(workspace)
        shutil.rmtree(os.path.join(folder, "new"))
    return paths


def stack(paths, titles, output, width=_WIDTH):
    """Writes a JPEG with pictures one below the other, a title above each."""
    from PIL import Image, ImageDraw, ImageFont
    margin = 26
    pictures = []
    for path in paths:
        picture = Image.open(path).convert("RGB")
        height = max(1, round(picture.height * width / picture.width))
        pictures.append(picture.resize((width, height), Image.LANCZOS))
    canvas = Image.new("RGB", (width, sum(picture.height + margin
                                          for picture in pictures)), "white")
    draw = ImageDraw.Draw(canvas)
    font = _font(ImageFont)
    y = 0
    for picture, title in zip(pictures, titles):
        draw.text((8, y + 4), title, fill="black", font=font)
        canvas.paste(picture, (0, y + margin))
        y += margin + picture.height
    os.makedirs(os.path.dirname(output) or ".", exist_ok=True)
    canvas.save(output + ".new", format="JPEG", quality=_QUALITY, optimize=True)
    os.replace(output + ".new", output)


def _font(module):
    """matplotlib's own font, so that all machines write the same."""
    import matplotlib
    path = os.path.join(matplotlib.get_data_path(), "fonts", "ttf",
                        "DejaVuSans-Bold.ttf")
    return (module.truetype(path, 16) if os.path.exists(path)
            else module.load_default())


def draw_comparison(output, data, found, methods, view, bin_dir=None):
    """One view with the maps of several methods, one below the other.

    found: what results.load_set() returns; of several seeds the first is drawn.
    Returns the caption, None if no method has maps of this view.
    """
    paths, shown = [], []
    for method in chosen_methods(methods):
        for run in found.get(method, [])[:1]:
            if links.find_map(run.folder, view):
                paths += draw_views(data, run.folder,
                                    os.path.join(run.folder, "pictures"),
                                    [view], bin_dir)
                shown.append(method)
    if not shown:
        return None
    stack(paths, [label(method) for method in shown], output)
    return (f"**{view}.** From above: " + ", ".join(
        label(method) for method in shown) + ". Black in the depth is \"no "
            "estimate\"; the error is relative to the true depth, from green "
            "(0.1 % and less) over yellow (1 %) to red (10 % and more).")


def chosen_methods(methods):
    """Those that pictures show: without and with TAPA, and other tools."""
    chosen = [method for method in methods
              if method in ("plain", "tapa") or method not in METHODS]
    return chosen or methods[:2]


def choose_views(data, every, count):
    """Names of count photographs, spread evenly over those that take part."""
    names = links.photographs(data, every)
    count = min(count, len(names))
    return [names[(2 * i + 1) * len(names) // (2 * count)]
            for i in range(count)]
