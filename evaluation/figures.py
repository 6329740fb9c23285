"""The figures of the TAPA-MVS paper: errors of depth maps.

Each function writes an SVG or PNG, by the name of the file, and returns its
caption as Markdown, or None where there is nothing to draw; then no file is
written. found: what results.load_set() returns.
"""

import os

from . import depth_scores, results
from .methods import METHODS, label

# Colours that colour-blind readers can tell apart (Okabe and Ito), and markers.
_STYLES = [("#0072B2", "o"), ("#D55E00", "^"), ("#009E73", "s"),
           ("#CC79A7", "D"), ("#E69F00", "v"), ("#56B4E9", "P"),
           ("#000000", "X")]

# Metres.
ERRORS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5]
TEXTURENESS_ERRORS = [0.1, 0.2, 0.5]


def chosen_methods(methods):
    """Those that figures show: not the ones that leave parts of TAPA out."""
    return [method for method in methods
            if method not in METHODS or "-" not in method] or methods


def _pyplot():
    import matplotlib  # Takes a second.
    matplotlib.use("Agg")
    import matplotlib.pyplot as pyplot
    # The same figure is the same file.
    matplotlib.rcParams.update({"svg.hashsalt": "tapa", "font.size": 9,
                                "axes.spines.top": False,
                                "axes.spines.right": False})
    return pyplot


def save(figure, path):
    """Writes a figure, which appears under its name only when it is complete."""
    os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
    kind = os.path.splitext(path)[1][1:]
    metadata = {"Date": None} if kind == "svg" else {}
    figure.savefig(path + ".new", format=kind, dpi=110, bbox_inches="tight",
                   metadata=metadata)
    os.replace(path + ".new", path)
    _pyplot().close(figure)


def _curve(axes, method, index, points):
    """points: (x, share or None); where there is None the line is broken."""
    color, marker = _STYLES[index % len(_STYLES)]
    axes.plot([x for x, _ in points],
              [None if y is None else 100 * y for _, y in points],
              color=color, marker=marker, markersize=4, linewidth=1.4,
              label=label(method))


def _percent_axis(axes, text):
    axes.set_ylim(0, 100)
    axes.set_yticks(range(0, 101, 20))
    axes.set_ylabel(text)
    axes.grid(axis="y", linestyle="--", linewidth=0.5, alpha=0.7)


def error_points(runs, errors=None):
    """(error in metres, share of the measured pixels below it) of a method."""
    scores = [(error, results.depth_score(runs, error))
              for error in errors or ERRORS]
    return [(error, score and score.completeness) for error, score in scores]


def textureness_points(runs, error):
    """(bound, share of the measured pixels of lower textureness below error)."""
    bounds = sorted({entry["max_textureness"] for run in runs or []
                     for entry in (run.depth or {}).get("by_textureness", [])})
    points = []
    for bound in bounds or depth_scores.TEXTURENESS:
        score = results.depth_score(runs, error, "m", bound)
        points.append((bound, score and score.completeness))
    return points


def _draw_curves(axes, found, methods, points_of):
    """Draws those methods that have points. Returns how many these are."""
    count = 0
    for index, method in enumerate(methods):
        points = points_of(found.get(method))
        if any(y is not None for _, y in points):
            _curve(axes, method, index, points)
            count += 1
    return count


def draw_errors(path, found, methods, title):
    """The paper's figure of the distribution of depth errors."""
    pyplot = _pyplot()
    figure, axes = pyplot.subplots(figsize=(5.5, 3.4))
    if not _draw_curves(axes, found, methods, error_points):
        pyplot.close(figure)
        return None
    axes.set_xscale("log")
    axes.set_xticks(ERRORS, [f"{100 * error:g}" for error in ERRORS])
    axes.minorticks_off()
    axes.set_xlabel("error of depth, cm")
    _percent_axis(axes, "pixels with a smaller error, %")
    axes.set_title(title)
    axes.legend(loc="lower right", fontsize=8)
    save(figure, path)
    return ("**How far the depth maps are off.** For each error on the "
            "horizontal axis the curves show the share of all measured pixels "
            "whose depth is that close to the measurement. Higher is better. "
            "On the left stands what is right to the centimetre; how high a "
            "curve ends on the right tells how many pixels got an estimate at "
            "all.")


def draw_textureness(path, found, methods, title):
    """The paper's three figures of errors against textureness, side by side."""
    pyplot = _pyplot()
    figure, row = pyplot.subplots(1, len(TEXTURENESS_ERRORS), sharey=True,
                                  figsize=(9, 3.1))
    count = 0
    for axes, error in zip(row, TEXTURENESS_ERRORS):
        count += _draw_curves(
            axes, found, methods,
            lambda runs, error=error: textureness_points(runs, error))
        _percent_axis(axes, "")
        axes.set_title(f"error below {100 * error:g} cm", fontsize=9)
        axes.set_xlim(0.5, 1.01)
        axes.set_xlabel("textureness below")
    if count == 0:
        pyplot.close(figure)
        return None
    row[0].set_ylabel("pixels with a smaller error, %")
    row[-1].legend(loc="lower right", fontsize=8)
    figure.suptitle(title)
    figure.tight_layout()
    save(figure, path)
    return ("**Where there is little texture.** Each point takes only the "
            "pixels whose textureness is below the value on the horizontal "
            "axis: 0.5 is a flat wall, and 1 takes all pixels. The curves show "
            "which share of them has a depth within 10, 20 and 50 cm of the "
            "measurement. A method that needs texture falls to the left; one "
            "that does not stays level.")
