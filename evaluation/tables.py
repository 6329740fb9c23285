"""Tables as Markdown and as CSV."""

import csv
import dataclasses
import io

from . import depth_scores, results
from .methods import label
from .texts import number, percent, tolerance_text


@dataclasses.dataclass
class Table:
    """Rows of text for a reader, and the same with all figures for a program."""
    caption: str
    header: list
    rows: list
    csv_header: list
    csv_rows: list

    def markdown(self):
        lines = ["| " + " | ".join(row) + " |" for row in [self.header, *self.rows]]
        lines.insert(1, "|" + "---|" * len(self.header))
        return self.caption + "\n\n" + "\n".join(lines) + "\n"

    def csv(self):
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows([self.csv_header, *self.csv_rows])
        return text.getvalue()


def score_text(score, digits=1):
    """Completeness / accuracy / F1, with the range of F1 over several seeds."""
    if score is None:
        return "-"
    text = " / ".join(percent(getattr(score, key), digits) for key in results.KEYS)
    if score.count > 1:
        text += f" ({percent(score.least_f1)}-{percent(score.most_f1)})"
    return text


def _score_cells(score):
    return [None] * 5 + [0] if score is None else dataclasses.astuple(score)


def _score_table(caption, by_method, methods, tolerances, score_of):
    """score_of(runs, tolerance, unit): a Score or None."""
    if any(len(runs) > 1 for runs in by_method.values()):
        seeds = ", means over seeds, and the smallest and largest F1"
    else:
        seeds = ""
    scores = {(method, *pair): score_of(by_method.get(method), *pair)
              for method in methods for pair in tolerances}
    return Table(
        f"{caption} In each cell: completeness / accuracy / F1 in per cent{seeds}.",
        ["method"] + [tolerance_text(*pair) for pair in tolerances],
        [[label(method)] + [score_text(scores[method, *pair]) for pair in tolerances]
         for method in methods],
        ["method", "tolerance", "unit", *results.KEYS, "least_f1", "most_f1", "runs"],
        [[*key, *_score_cells(score)] for key, score in scores.items()])


def depth_table(by_method, methods, tolerances, bound=None):
    """Scores of depth maps; by_method: as load_set(); tolerances: (value, unit)."""
    pixels = ("all pixels" if bound is None
              else f"pixels of low texture (textureness below {bound:g})")
    return _score_table(
        f"**Depth maps, {pixels}.**", by_method, methods, tolerances,
        lambda runs, value, unit: results.depth_score(runs, value, unit, bound))


def cloud_table(by_method, methods, tolerances, cloud="fused"):
    """Scores of points; tolerances in metres."""
    rule = {"fused_default": "with COLMAP's own thresholds",
            "fused_agreement": "by weighing agreement"}.get(
                cloud, "with TAPA's thresholds for all methods")
    return _score_table(
        f"**Points, fused {rule}.**", by_method, methods,
        [(value, "m") for value in tolerances],
        lambda runs, value, _: results.cloud_score(runs, value, cloud))


def _cost_columns(runs):
    """(heading, name in CSV, value, text) of each column."""
    first = runs[0].record if runs else None
    views = first and first.views
    size = first and first.image_size and "x".join(map(str, first.image_size))
    columns = [("runs", "runs", len(runs), str(len(runs))),
               ("views", "views", views, str(views or "-")), ("size", "size", size, size or "-")]
    for heading, name, key, bound, digits, factor in (
            ("coverage %", "coverage", "coverage", None, 1, 100),
            ("of measured %", "measurement_coverage", "measurement_coverage", None, 1, 100),
            ("of low texture %", "low_texture_coverage", "coverage", depth_scores.LOW_TEXTURE,
             1, 100),
            ("median error mm", "median_absolute_error", "median_absolute_error", None, 1, 1000),
            ("median error %", "median_relative_error", "median_relative_error", None, 2, 100)):
        value = results.depth_value(runs, key, bound)
        columns.append((heading, name, value, number(value, digits, factor)))
    for heading, name, value, factor in (
            ("CPU s / MP", "cpu_seconds_per_megapixel", results.cpu_per_megapixel(runs), 1),
            ("stereo s", "stereo_seconds", results.step_value(runs, "seconds"), 1),
            ("memory MB", "peak_memory_bytes", results.step_value(runs, "peak_memory_bytes"),
             1e-6)):
        columns.append((heading, name, value, number(value, 0, factor)))
    return columns


def cost_table(by_method, methods):
    """How much was estimated, the median error, and what it took."""
    rows = [list(zip(*_cost_columns(by_method.get(method, [])))) for method in methods]
    headings, names = list(zip(*_cost_columns([])))[:2]
    return Table(
        "**What was estimated, and what it took.** Coverage: share of all pixels with an "
        "estimate, and of those that were measured or have low texture. The median error is "
        "that of the estimates only: a method that dares more difficult pixels has a larger "
        "one. CPU seconds are per megapixel and view, for all passes of stereo.",
        ["method", *headings],
        [[label(method), *row[3]] for method, row in zip(methods, rows)],
        ["method", *names], [[method, *row[2]] for method, row in zip(methods, rows)])


def _trade_values(by_method, method, tolerances):
    """CPU seconds and their share of COLMAP's, F1 at each tolerance and its mean, and
    the mean where there is little texture; None where it is not known."""
    def f1(bound=None):
        scores = [results.depth_score(by_method.get(method), *pair, bound)
                  for pair in tolerances]
        return [score and score.f1 for score in scores]

    cost, of_colmap = (results.cpu_per_megapixel(by_method.get(name, []))
                       for name in (method, "colmap"))
    share = cost / of_colmap if cost is not None and of_colmap else None
    scores, low = f1(), f1(depth_scores.LOW_TEXTURE)
    means = [None if None in values else results.mean(values) for values in (scores, low)]
    return [cost, share, *scores, *means]


def trade_table(by_method, methods, tolerances):
    """What a method costs beside what it scores; tolerances: (value, unit)."""
    rows = [_trade_values(by_method, method, tolerances) for method in methods]
    columns = [tolerance_text(*pair) for pair in tolerances]
    return Table(
        "**Cost and score.** CPU seconds per megapixel and view for all passes, and their "
        "share of COLMAP's; F1 of the depth maps in per cent, its mean over the tolerances, "
        "and that mean over the pixels of low texture.",
        ["method", "CPU s / MP", "of COLMAP's", *columns, "mean", "low texture"],
        [[label(method), number(row[0]), number(row[1], 2), *map(percent, row[2:])]
         for method, row in zip(methods, rows)],
        ["method", "cpu_seconds_per_megapixel", "share_of_colmap", *columns, "mean_f1",
         "low_texture_mean_f1"],
        [[method, *row] for method, row in zip(methods, rows)])
