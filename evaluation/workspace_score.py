"""Scores of all views of a workspace, and of those of their pixels that have little texture."""

from . import images
from .depth_map_score import DepthMapScorer
from .processes import Failure
from .texts import number, percent, tolerance_text
from .textureness import textureness


class WorkspaceScorer:
    """Scores all views once, whatever their number of bounds of textureness."""

    def __init__(self, tolerances, bounds):
        self._tolerances = tolerances
        self._scorer = DepthMapScorer(tolerances)
        self._bounded = {bound: DepthMapScorer(tolerances) for bound in bounds}
        self.scores = {}  # By name of the view.

    def add(self, view, depth, truth):
        """Scores a view (workspaces.View)."""
        try:
            self.scores[view.name] = self._scorer.add(depth, truth)
        except Failure as error:
            raise Failure(f"{view.name}: {error}") from error
        if self._bounded:
            # At the size of the truth, so that maps of all sizes are judged at the same places.
            height, width = truth.shape
            values = textureness(images.read_grey(view.photograph, width, height)).astype(float)
            for bound, scorer in self._bounded.items():
                scorer.add(depth, truth, values < bound)

    def overall(self):
        return self._scorer.overall()

    def text(self):
        """What a person wants to see: a line per view, then all views at every tolerance, and
        the same for every bound of textureness. "-" where there is nothing to share."""
        overall = self.overall()
        parts = [_table([["View", "Pixels", "Coverage %", "of truth %", "Median mm", "Median %",
                          *(f"F1 {tolerance_text(*pair)}" for pair in self._tolerances)],
                         *(_view_row(name, score) for name, score in self.scores.items()),
                         _view_row("all", overall)]), self._totals(overall)]
        for bound, scorer in self._bounded.items():
            score = scorer.overall()
            parts.append(f"Textureness below {bound:g}: coverage {percent(score.coverage)} % of "
                         f"{score.num_pixels} pixels, {percent(score.measurement_coverage)} % of "
                         f"those with a measurement\n{self._totals(score)}")
        return "\n".join(parts)

    def _totals(self, score):
        return _table([["Tolerance", "Completeness %", "Accuracy %", "F1 %"],
                       *([tolerance_text(*pair), *(percent(share, 2) for share in score.at(i))]
                         for i, pair in enumerate(self._tolerances))])

    def json(self):
        """All figures. Shares are 0 to 1, errors in metres or relative to the true depth, None
        where there is nothing to measure."""
        def with_number(score):
            return {**_json(score), "num_maps": score.num_maps}

        return {"overall": with_number(self.overall()),
                "images": [{**_json(score), "name": name} for name, score in self.scores.items()],
                "by_textureness": [{"max_textureness": bound,
                                    "score": with_number(scorer.overall())}
                                   for bound, scorer in self._bounded.items()]}


def _view_row(name, score):
    return [name, str(score.num_pixels), percent(score.coverage),
            percent(score.measurement_coverage), number(score.median_absolute_error, 2, 1000),
            percent(score.median_relative_error, 3),
            *(percent(score.at(i)[2]) for i in range(len(score.tolerances)))]


def _table(rows):
    """Rows of the same length, the first of which is the heading, in columns as wide as needed:
    the first to the left, the others to the right."""
    widths = [max(map(len, column)) for column in zip(*rows)]
    lines = ["  ".join([row[0].ljust(widths[0]),
                        *(cell.rjust(width) for cell, width in zip(row[1:], widths[1:]))])
             for row in rows]
    lines.insert(1, "-" * len(lines[0]))
    return "\n".join(lines) + "\n"


def _json(score):
    keys = ("num_pixels", "num_estimates", "num_invalid", "num_measurements",
            "num_measurements_covered", "num_estimates_measured", "coverage",
            "measurement_coverage", "median_absolute_error", "median_relative_error")
    shares = ("completeness", "accuracy", "f1")
    return {**{key: getattr(score, key) for key in keys},
            "tolerances": [{"tolerance": tolerance.value, "unit": tolerance.unit,
                            **dict(zip(shares, score.at(i)))}
                           for i, tolerance in enumerate(score.tolerances)]}
