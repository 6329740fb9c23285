"""What stands in a folder of results, OUT/SET/METHOD-SEED.

Missing values are None everywhere and "-" in tables: never zero.
"""

import dataclasses
import os
import statistics

from . import cloud_scores, depth_scores, record

KEYS = ("completeness", "accuracy", "f1")


@dataclasses.dataclass
class Result:
    """One run, or another tool's maps or points."""
    folder: str
    record: record.Record
    # None where there are none.
    depth: depth_scores.DepthScores
    # By name of the cloud.
    clouds: dict

    @property
    def failure(self):
        """What went wrong, in one line; None if nothing did."""
        failed = self.record.failed
        return failed and f"{failed.step}: {failed.message}"


@dataclasses.dataclass
class Score:
    """Means over runs that differ in their seed. Shares, 0 to 1."""
    completeness: float
    accuracy: float
    f1: float
    # The smallest and the largest F1, and the number of runs.
    least_f1: float
    most_f1: float
    count: int


def load_set(out, name):
    """All results of a set, by method, in the order of the seeds."""
    results = []
    folder = os.path.join(out, name)
    for entry in sorted(os.listdir(folder)) if os.path.isdir(folder) else []:
        inside = os.path.join(folder, entry)
        content = record.load(inside)
        if content is not None:
            results.append(Result(inside, content, depth_scores.load(inside),
                                  cloud_scores.load(inside)))
    by_method = {}
    for result in sorted(results, key=lambda result: result.record.seed):
        by_method.setdefault(result.record.method, []).append(result)
    return by_method


def _known(values):
    return [value for value in values if value is not None]


def mean(values):
    """The mean of the values that are known, None if there is none."""
    known = _known(values)
    return statistics.fmean(known) if known else None


def median(values):
    """The median of the values that are known, None if there is none."""
    known = _known(values)
    return statistics.median(known) if known else None


def _mean_score(entries):
    entries = [entry for entry in _known(entries) if entry.f1 is not None]
    if not entries:
        return None
    f1 = [entry.f1 for entry in entries]
    return Score(mean(entry.completeness for entry in entries),
                 mean(entry.accuracy for entry in entries), mean(f1), min(f1), max(f1),
                 len(entries))


def _pixel_scores(runs, bound):
    """The scores of all pixels, or of those of textureness below a bound."""
    return _known(run.depth.overall if bound is None else run.depth.below(bound)
                  for run in runs or [] if run.depth)


def depth_score(runs, tolerance, unit="m", bound=None):
    """The Score of the depth maps of a method's runs, None if there is none."""
    return _mean_score([part.at(tolerance, unit) for part in _pixel_scores(runs, bound)])


def depth_value(runs, key, bound=None):
    """The mean of another value of the depth scores, such as "coverage"."""
    return mean(getattr(part, key) for part in _pixel_scores(runs, bound))


def cloud_score(runs, tolerance, cloud="fused"):
    """The Score of the points of a method's runs, None if there is none."""
    return _mean_score([run.clouds[cloud].at(tolerance)
                        for run in runs or [] if cloud in run.clouds])


def mean_over_sets(sets, method, tolerance, cloud="fused"):
    """The mean of a method's cloud scores over sets (as ETH3D does over scenes).

    sets: what load_set() returns, one for each set. None unless all have one.
    """
    scores = [cloud_score(by_method.get(method), tolerance, cloud) for by_method in sets]
    return None if None in scores else _mean_score(scores)


def evaluators(runs):
    """Names of the programs that scored the points of runs."""
    return {score.made_from.evaluator for run in runs for score in run.clouds.values()}


def step_value(runs, measure, step="stereo"):
    """The median of what a step took, None if no run knows it.

    What it took so far in a run that is not complete is not what it takes.
    """
    return median(getattr(run.record, measure).get(step) for run in runs or []
                  if step in run.record.done)


def cpu_per_megapixel(runs):
    """Median CPU seconds of stereo per megapixel and view; None: not known."""
    values = []
    for content in (run.record for run in runs or []):
        seconds, size = content.cpu_seconds.get("stereo"), content.image_size
        if seconds is not None and size and content.views:
            values.append(seconds * 1e6 / (content.views * size[0] * size[1]))
    return median(values)


def pool(sets):
    """The runs of several sets by method, as if they were runs of one.

    Means are then means over the sets, where each has the same number of runs.
    Methods whose depth maps are not scored on all of the sets are left out, as
    their means would be over others.
    """
    sets, pooled = list(sets), {}
    for method in sorted({method for by_method in sets for method in by_method}):
        runs = [[run for run in by_method.get(method, []) if run.depth] for by_method in sets]
        if all(runs):
            pooled[method] = [run for part in runs for run in part]
    return pooled
