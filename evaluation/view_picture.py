"""A picture of one view: photograph, depth, normals, measured depth and error side by side."""

import os

import matplotlib
import numpy as np
from matplotlib import cm, colors, patches

from . import depth_maps, files, images
from .depth_map_score import DepthMapScorer, corresponding_pixels
from .texts import percent

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

_NO_ESTIMATE, _NO_MEASUREMENT = "black", "0.59"
# Green, where the error relative to the true depth is 0.1 % and less, over yellow (1 %) to red.
_ERROR_SCALE = cm.ScalarMappable(colors.LogNorm(0.1, 10, clip=True),
                                 colors.LinearSegmentedColormap.from_list("error", [
                                     "#05734b", "#64b95f", "#faeb82", "#f0733c", "#960a2d"]))
_INCH = 100  # Pixels.
_PANEL_SIDE = 6.4  # Inches, at most: three make less than 2000 pixels.
# By what there is: P photograph, D depth, N normals, T measured depth, E error, L legend.
_LAYOUTS = {(False, False): "PDL", (True, False): "PD;NL", (False, True): "PDL;.TE",
            (True, True): "PDN;LTE"}


def draw(path, view, depth, truth=None, title=""):
    """Writes a PNG of a view (workspaces.View) and its depth map, at most 2000 pixels wide.

    truth: measured depth, without which its panels are left out, as those of normals are where
    there are none. Maps may differ in size. The colours of depth span the range of the truth, or
    without it that of the estimates.
    """
    lines = [view.name.encode("utf-8", "replace").decode()]  # Names may be no text.
    if truth is not None:
        score = DepthMapScorer([]).add(depth, truth)
        lines += [f"coverage {percent(score.coverage)} %",
                  f"median error {percent(score.median_relative_error, 2)} %"]
    photograph = images.read_color(view.photograph)[:, :, ::-1]
    normals = (depth_maps.read_map(view.normals, 3) if os.path.exists(view.normals) else None)
    scale = depth_scale(depth if truth is None else truth)
    panels = {"P": ("Photograph", photograph),
              "D": ("Depth", color(depth, scale, depth_maps.is_depth(depth), _NO_ESTIMATE))}
    if normals is not None:
        panels["N"] = "Normals", color_normals(normals)
    if truth is not None:
        panels["T"] = "Ground truth", color(truth, scale, depth_maps.is_depth(truth),
                                            _NO_MEASUREMENT)
        panels["E"] = "Error", color_errors(depth, truth)
    layout = _LAYOUTS[normals is not None, truth is not None]
    figure, axes = _lay_out(layout, photograph.shape[0] / photograph.shape[1])
    if title:
        figure.suptitle(title, x=0.01, ha="left", fontsize=24, fontweight="bold")
    for name, (title, image) in panels.items():
        axes[name].imshow(image, aspect="auto" if min(image.shape[:2]) < 4 else "equal")
        axes[name].set_title(title, loc="left")
    _draw_legend(figure, axes["L"], lines, scale, normals is not None, truth is not None)
    with files.replacing(path) as new:
        figure.savefig(new, format="png", dpi=_INCH)
    pyplot.close(figure)


def _lay_out(layout, aspect):
    """A figure with room for panels of an aspect (height over width)."""
    rows = layout.split(";")
    width = min(_PANEL_SIDE, max(2.5, _PANEL_SIDE / aspect))
    height = min(_PANEL_SIDE, max(2.5, width * aspect)) + 0.3
    figure, axes = pyplot.subplot_mosaic(
        layout, figsize=(width * len(rows[0]), height * len(rows)), layout="constrained")
    for panel in axes.values():
        panel.axis("off")
    return figure, axes


def _inverse(depth):
    with np.errstate(divide="ignore"):
        return 1 / depth


def depth_scale(depth):
    """Colours of depths, from the 2nd to the 98th percentile of those that there are.

    They follow inverse depth, red near and blue far, which keeps apart what stereo can.
    """
    values = depth[depth_maps.is_depth(depth)].astype(np.float64)
    near, far = np.percentile(values, (2, 98)) if len(values) else (1.0, 1.0)
    if near == far:
        near, far = 0.99 * near, 1.01 * far
    # The darkest ends of the scale would look like missing estimates.
    turbo = colors.ListedColormap(matplotlib.colormaps["turbo_r"](np.linspace(0.04, 0.96, 236)))
    return cm.ScalarMappable(colors.FuncNorm((_inverse, _inverse), near, far, clip=True), turbo)


def color(values, scale, known, missing):
    """Values as colours, (height, width, 3), where they are known."""
    rgba = scale.to_rgba(np.where(known, values, scale.norm.vmax).astype(np.float64), bytes=True)
    rgba[~known, :3] = np.round(255 * np.array(colors.to_rgb(missing)))
    return rgba[:, :, :3]


def color_errors(depth, truth):
    """Of the estimates, at the pixels of the truth."""
    estimates = depth[corresponding_pixels(truth.shape, depth.shape)].astype(np.float64)
    measured, estimated = depth_maps.is_depth(truth), depth_maps.is_depth(estimates)
    errors = 100 * np.abs(np.where(estimated, estimates, 0) / np.where(measured, truth, 1) - 1)
    image = color(errors, _ERROR_SCALE, measured & estimated, _NO_ESTIMATE)
    image[~measured] = np.round(255 * float(_NO_MEASUREMENT))
    return image


def color_normals(normals):
    """x, y, z, towards the right, the top and the camera, as red, green and blue.

    Light blue is a surface that faces the camera; black is none.
    """
    image = np.clip(np.round(127.5 * (1 + normals * (1, -1, -1))), 0, 255)
    return np.where((normals != 0).any(axis=2, keepdims=True), image, 0).astype(np.uint8)


def normal_ball(size):
    """The colours of all normals that face the camera, as on a ball, on white."""
    x, y = np.meshgrid(np.linspace(-1, 1, size), np.linspace(-1, 1, size))
    z = np.sqrt(np.maximum(1 - x * x - y * y, 0))
    ball = color_normals(np.stack((x, y, -z), axis=2))
    ball[x * x + y * y > 1] = 255
    return ball


def _draw_legend(figure, axes, lines, scale, has_normals, is_metric):
    for number, line in enumerate(lines):
        axes.text(0, 0.96 - 0.1 * number, line, transform=axes.transAxes, va="top",
                  fontsize=min(12, 500 / max(len(line), 1)), parse_math=False)
    if has_normals:
        inset = axes.inset_axes((0.76, 0.72, 0.24, 0.24))
        inset.imshow(normal_ball(81))
        inset.axis("off")
        inset.set_title("normals", y=-0.3, fontsize=9)
    near, far = scale.norm.vmin, scale.norm.vmax
    bars = [("depth in metres" if is_metric else "depth", scale, (near, 2 / (1 / near + 1 / far),
                                                                   far))]
    if is_metric:
        bars.append(("error in % of the true depth", _ERROR_SCALE, (0.1, 0.3, 1, 3, 10)))
    for number, (title, mappable, ticks) in enumerate(bars):
        place = axes.inset_axes((0, 0.5 - 0.27 * number, 1, 0.07))
        bar = figure.colorbar(mappable, cax=place, orientation="horizontal")
        bar.set_ticks(ticks, labels=[f"{tick:.3g}" for tick in ticks])
        bar.minorticks_off()
        place.set_title(title, loc="left", fontsize=9)
    swatches = [patches.Patch(color=_NO_ESTIMATE, label="no estimate")]
    if is_metric:
        swatches.append(patches.Patch(color=_NO_MEASUREMENT, label="no measurement"))
    axes.legend(handles=swatches, loc="lower left", ncols=2, frameon=False, fontsize=9)
