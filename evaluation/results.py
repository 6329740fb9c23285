"""What stands in a folder of results, OUT/SET/METHOD-SEED.

Missing values are None everywhere and "-" in tables: never zero.
"""

import dataclasses
import os
import statistics

from . import cloud_scores, depth_scores, run_record

KEYS = ("completeness", "accuracy", "f1")


@dataclasses.dataclass
class Result:
    """One run, or another tool's maps or points."""
    folder: str
    record: dict
    # None where there are none.
    depth: dict = None
    # By name of the cloud.
    clouds: dict = dataclasses.field(default_factory=dict)

    @property
    def method(self):
        return self.record["method"]

    @property
    def failure(self):
        """What went wrong, in one line; None if nothing did."""
        failed = self.record.get("failed")
        return failed and f"{failed['step']}: {failed['message']}"


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


def load_result(folder):
    """The result in a folder, None where there is no record."""
    record = run_record.load(folder)
    if record is None:
        return None
    return Result(folder, record, depth_scores.load(folder),
                  cloud_scores.load(folder))


def load_set(out, name):
    """All results of a set, by method, in the order of the seeds."""
    found = {}
    folder = os.path.join(out, name)
    for entry in sorted(os.listdir(folder)) if os.path.isdir(folder) else []:
        result = load_result(os.path.join(folder, entry))
        if result is not None:
            found.setdefault(result.method, []).append(result)
    for runs in found.values():
        runs.sort(key=lambda result: result.record["seed"])
    return found


def mean(values):
    """The mean of the values that are known, None if there is none."""
    known = [value for value in values if value is not None]
    return statistics.fmean(known) if known else None


def _mean_score(entries):
    entries = [entry for entry in entries
               if entry is not None and entry["f1"] is not None]
    if not entries:
        return None
    f1 = [entry["f1"] for entry in entries]
    return Score(mean(entry["completeness"] for entry in entries),
                 mean(entry["accuracy"] for entry in entries),
                 mean(f1), min(f1), max(f1), len(entries))


def _parts(runs, bound):
    """The scores of all pixels, or of those of textureness below a bound."""
    for run in runs or []:
        if run.depth is not None:
            yield (run.depth["overall"] if bound is None
                   else depth_scores.below(run.depth, bound))


def depth_score(runs, tolerance, unit="m", bound=None):
    """The Score of the depth maps of a method's runs, None if there is none."""
    return _mean_score([depth_scores.at(part, tolerance, unit)
                        for part in _parts(runs, bound) if part is not None])


def depth_value(runs, key, bound=None):
    """The mean of another value of the depth scores, such as "coverage"."""
    return mean(part[key] for part in _parts(runs, bound) if part is not None)


def cloud_score(runs, tolerance, cloud="fused"):
    """The Score of the points of a method's runs, None if there is none."""
    return _mean_score([cloud_scores.at(run.clouds[cloud], tolerance)
                        for run in runs or [] if cloud in run.clouds])


def mean_over_sets(sets, method, tolerance, cloud="fused"):
    """The mean of a method's cloud scores over sets (as ETH3D does over scenes).

    sets: what load_set() returns, one for each set. None unless all have one.
    """
    scores = [cloud_score(found.get(method), tolerance, cloud)
              for found in sets]
    if not scores or None in scores:
        return None
    return _mean_score([dataclasses.asdict(score) for score in scores])


def evaluators(runs):
    """Names of the programs that scored the points of runs."""
    return {score["made_from"]["evaluator"] for run in runs
            for score in run.clouds.values() if "made_from" in score}


def step_value(runs, measure, step="stereo"):
    """The median of what a step took, None if no run knows it.

    What it took so far in a run that is not complete is not what it takes.
    """
    values = [run.record.get(measure, {}).get(step) for run in runs or []
              if step in run.record["done"]]
    values = [value for value in values if value is not None]
    return statistics.median(values) if values else None


def cpu_per_megapixel(runs):
    """Median CPU seconds of stereo per megapixel and view; None: not known."""
    values = []
    for run in runs or []:
        seconds = run.record.get("cpu_seconds", {}).get("stereo")
        size = run.record.get("image_size")
        if seconds is not None and size and run.record["views"]:
            values.append(seconds * 1e6
                          / (run.record["views"] * size[0] * size[1]))
    return statistics.median(values) if values else None


def pool(sets):
    """The runs of several sets by method, as if they were runs of one.

    Means are then means over the sets, where each has the same number of runs.
    Methods whose depth maps are not scored on all of the sets are left out, as
    their means would be over others.
    """
    sets = list(sets)
    found = {}
    for method in {method for one in sets for method in one}:
        runs = [[run for run in one.get(method, []) if run.depth] for one in sets]
        if all(runs):
            found[method] = [run for part in runs for run in part]
    return found
