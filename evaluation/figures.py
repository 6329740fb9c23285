"""The figures of the TAPA-MVS paper: errors of depth maps.

Each function writes a PNG and returns its caption as Markdown, or None where there is
nothing to draw; then no file is written. by_method: what results.load_set() returns.
"""


from . import depth_scores, files, results
from .methods import METHODS, label

# Colours that colour-blind readers can tell apart (Okabe and Ito), and markers.
_STYLES = [("#0072B2", "o"), ("#D55E00", "^"), ("#009E73", "s"), ("#CC79A7", "D"),
           ("#E69F00", "v"), ("#56B4E9", "P"), ("#000000", "X")]

# Metres.
ERRORS = depth_scores.TOLERANCES
TEXTURENESS_ERRORS = [0.1, 0.2, 0.5]


def chosen_methods(methods):
    """Those that figures show: not the ones that leave parts of TAPA out."""
    return [method for method in methods
            if method not in METHODS or "-" not in method] or methods


def _pyplot():
    import matplotlib  # Takes a second.
    matplotlib.use("Agg")
    import matplotlib.pyplot as pyplot
    matplotlib.rcParams.update({"font.size": 9, "axes.spines.top": False,
                                "axes.spines.right": False})
    return pyplot


def _percent_axis(axes, text):
    axes.set_ylim(0, 100)
    axes.set_yticks(range(0, 101, 20))
    axes.set_ylabel(text)
    axes.grid(axis="y", linestyle="--", linewidth=0.5, alpha=0.7)


def error_points(runs):
    """(error in metres, share of the measured pixels below it) of a method."""
    scores = [(error, results.depth_score(runs, error)) for error in ERRORS]
    return [(error, score and score.completeness) for error, score in scores]


def textureness_points(runs, error):
    """(bound, share of the measured pixels of lower textureness below error)."""
    bounds = sorted({entry.max_textureness for run in runs or [] if run.depth
                     for entry in run.depth.by_textureness})
    scores = [(bound, results.depth_score(runs, error, "m", bound))
              for bound in bounds or depth_scores.TEXTURENESS]
    return [(bound, score and score.completeness) for bound, score in scores]


def _draw_curves(axes, by_method, methods, points_of):
    """Draws those methods that have points; where a share is None the line is broken."""
    for index, method in enumerate(methods):
        points = points_of(by_method.get(method))
        if any(share is not None for _, share in points):
            color, marker = _STYLES[index % len(_STYLES)]
            axes.plot([x for x, _ in points],
                      [None if share is None else 100 * share for _, share in points],
                      color=color, marker=marker, markersize=4, linewidth=1.4,
                      label=label(method))


def _save(path, figure, axes, caption):
    """Writes the figure if there is a curve in these axes."""
    if axes.lines:
        axes.legend(loc="lower right", fontsize=8)
        with files.replacing(path) as new:
            figure.savefig(new, format="png", dpi=110, bbox_inches="tight")
    has_curves = bool(axes.lines)
    _pyplot().close(figure)
    return caption if has_curves else None


def draw_errors(path, by_method, methods, title):
    """The paper's figure of the distribution of depth errors."""
    figure, axes = _pyplot().subplots(figsize=(5.5, 3.4))
    _draw_curves(axes, by_method, methods, error_points)
    axes.set_xscale("log")
    axes.set_xticks(ERRORS, [f"{100 * error:g}" for error in ERRORS])
    axes.minorticks_off()
    axes.set_xlabel("error of depth, cm")
    _percent_axis(axes, "pixels with a smaller error, %")
    axes.set_title(title)
    return _save(path, figure, axes, (
        "**How far the depth maps are off.** For each error on the horizontal axis the curves "
        "show the share of all measured pixels whose depth is that close to the measurement. "
        "Higher is better. On the left stands what is right to the centimetre; how high a "
        "curve ends on the right tells how many pixels got an estimate at all."))


def draw_textureness(path, by_method, methods, title):
    """The paper's three figures of errors against textureness, side by side."""
    figure, row = _pyplot().subplots(1, len(TEXTURENESS_ERRORS), sharey=True, figsize=(9, 3.1))
    for axes, error in zip(row, TEXTURENESS_ERRORS):
        _draw_curves(axes, by_method, methods,
                     lambda runs, error=error: textureness_points(runs, error))
        _percent_axis(axes, "")
        axes.set_title(f"error below {100 * error:g} cm", fontsize=9)
        axes.set_xlim(0.5, 1.01)
        axes.set_xlabel("textureness below")
    row[0].set_ylabel("pixels with a smaller error, %")
    figure.suptitle(title)
    figure.tight_layout()
    return _save(path, figure, row[-1], (
        "**Where there is little texture.** Each point takes only the pixels whose textureness "
        "is below the value on the horizontal axis: 0.5 is a flat wall, and 1 takes all pixels. "
        "The curves show which share of them has a depth within 10, 20 and 50 cm of the "
        "measurement. A method that needs texture falls to the left; one that does not stays "
        "level."))
