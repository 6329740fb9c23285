"""Tables as Markdown and as CSV."""

import csv
import dataclasses
import io

from . import depth_scores, results
from .methods import label


@dataclasses.dataclass
class Table:
    """Rows of text for a reader, and the same with all figures for a program."""
    caption: str
    header: list
    rows: list
    csv_header: list
    csv_rows: list

    def markdown(self):
        lines = ["| " + " | ".join(self.header) + " |",
                 "|" + "---|" * len(self.header)]
        lines += ["| " + " | ".join(row) + " |" for row in self.rows]
        return self.caption + "\n\n" + "\n".join(lines) + "\n"

    def csv(self):
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(self.csv_header)
        for row in self.csv_rows:
            writer.writerow(["" if cell is None else cell for cell in row])
        return text.getvalue()


def percent(share, digits=1):
    """A share in per cent, "-" if it is not known."""
    return "-" if share is None else f"{100 * share:.{digits}f}"


def number(value, digits=0):
    return "-" if value is None else f"{value:.{digits}f}"


def tolerance_text(value, unit="m"):
    """2 cm, 1.5 m or 0.5 %."""
    if unit == "%":
        return f"{value:.12g} %"
    return f"{100 * value:.12g} cm" if value < 1 else f"{value:.12g} m"


def score_text(score):
    """Completeness / accuracy / F1, with the range of F1 over several seeds."""
    if score is None:
        return "-"
    text = " / ".join(percent(value) for value in (
        score.completeness, score.accuracy, score.f1))
    if score.count > 1:
        text += f" ({percent(score.least_f1)}-{percent(score.most_f1)})"
    return text


_SCORE_COLUMNS = ["tolerance", "unit", "completeness", "accuracy", "f1",
                  "least_f1", "most_f1", "runs"]


def _score_cells(tolerance, unit, score):
    cells = [tolerance, unit]
    if score is None:
        return cells + [None] * 5 + [0]
    return cells + [score.completeness, score.accuracy, score.f1,
                    score.least_f1, score.most_f1, score.count]


def _score_table(caption, methods, tolerances, find):
    """find(method, tolerance, unit): a Score or None."""
    return Table(
        caption,
        ["method"] + [tolerance_text(*pair) for pair in tolerances],
        [[label(method)] + [score_text(find(method, *pair))
                            for pair in tolerances] for method in methods],
        ["method"] + _SCORE_COLUMNS,
        [[method] + _score_cells(*pair, find(method, *pair))
         for method in methods for pair in tolerances])


def _reading(found):
    text = "In each cell: completeness / accuracy / F1 in per cent"
    if any(len(runs) > 1 for runs in found.values()):
        text += ", means over seeds, and the smallest and largest F1"
    return text + "."


def depth_table(found, methods, tolerances, bound=None):
    """Scores of depth maps; found: as load_set(); tolerances: (value, unit)."""
    pixels = ("all pixels" if bound is None
              else f"pixels of low texture (textureness below {bound:g})")
    return _score_table(
        f"**Depth maps, {pixels}.** " + _reading(found),
        methods, tolerances,
        lambda method, value, unit: results.depth_score(
            found.get(method), value, unit, bound))


def cloud_table(found, methods, tolerances, cloud="fused"):
    """Scores of points; tolerances in metres."""
    thresholds = ("COLMAP's own thresholds" if cloud == "fused_default"
                  else "TAPA's thresholds for all methods")
    return _score_table(
        f"**Points, fused with {thresholds}.** " + _reading(found),
        methods, [(value, "m") for value in tolerances],
        lambda method, value, _: results.cloud_score(
            found.get(method), value, cloud))


def cost_table(found, methods):
    """How much was estimated, the median error, and what it took."""
    rows, csv_rows = [], []
    for method in methods:
        runs = found.get(method)
        first = runs[0].record if runs else {}
        size = first.get("image_size")
        cells = [
            len(runs) if runs else 0, first.get("views"),
            f"{size[0]}x{size[1]}" if size else None,
            results.depth_value(runs, "coverage"),
            results.depth_value(runs, "measurement_coverage"),
            results.depth_value(runs, "coverage", depth_scores.LOW_TEXTURE),
            results.depth_value(runs, "median_absolute_error"),
            results.depth_value(runs, "median_relative_error"),
            results.cpu_per_megapixel(runs),
            results.step_value(runs, "seconds"),
            results.step_value(runs, "peak_memory_bytes")]
        csv_rows.append([method] + cells)
        error = cells[6]
        rows.append([
            label(method), str(cells[0]), str(cells[1] or "-"), cells[2] or "-",
            percent(cells[3]), percent(cells[4]), percent(cells[5]),
            number(None if error is None else 1000 * error, 1),
            percent(cells[7], 2), number(cells[8]), number(cells[9]),
            number(None if cells[10] is None else cells[10] / 1e6)])
    return Table(
        "**What was estimated, and what it took.** Coverage: share of all "
        "pixels with an estimate, and of those that were measured or have low "
        "texture. The median error is that of the estimates only: a method "
        "that dares more difficult pixels has a larger one. CPU seconds are "
        "per megapixel and view, for both passes of stereo.",
        ["method", "runs", "views", "size", "coverage %", "of measured %",
         "of low texture %", "median error mm", "median error %", "CPU s / MP",
         "stereo s", "memory MB"], rows,
        ["method", "runs", "views", "size", "coverage", "measurement_coverage",
         "low_texture_coverage", "median_absolute_error",
         "median_relative_error",
         "cpu_seconds_per_megapixel", "stereo_seconds", "peak_memory_bytes"],
        csv_rows)
