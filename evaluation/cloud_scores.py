"""Scores of points against laser scans, as ETH3D defines them.

cloud_scores.json has them by the name of the cloud (FOLDER/NAME.ply). The evaluator is
evaluate_point_cloud or ETH3D's own program, which takes the same options and prints the
same lines.
"""

import collections
import math
import os
import re
from typing import Dict, List

from . import files, machine, processes, schemas
from .processes import Failure
from .schemas import Number, Text
from .steps import Step

# Metres; those of the paper's Table 2.
TOLERANCES = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5]

_LINES = {"tolerances": "Tolerances", "completeness": "Completenesses",
          "accuracy": "Accuracies", "f1": "F1-scores"}

CloudScoreAt = collections.namedtuple("CloudScoreAt", ["completeness", "accuracy", "f1"])


class Source(schemas.Model):
    """What was scored, against what and how: two fingerprints, a name, more options."""
    cloud: Text
    scans: Text
    evaluator: Text
    options: List[Text]


class CloudScore(schemas.Model):
    """Of one cloud, at each tolerance."""
    tolerances: List[Number]
    completeness: List[Number]
    accuracy: List[Number]
    f1: List[Number]
    made_from: Source

    def at(self, value):
        """The score at a tolerance, None if it was not scored."""
        return next((CloudScoreAt(*scores) for tolerance, *scores in zip(
            self.tolerances, self.completeness, self.accuracy, self.f1)
            if abs(tolerance - value) < 1e-9), None)


def choose_evaluator(path=None):
    """Absolute path of ours, or of a program that the user names. Raises Failure if it is none."""
    if path is None:
        return os.path.join(machine.ROOT, "scripts", "evaluate_point_cloud")
    if not (os.path.isfile(path) and os.access(path, os.X_OK)):
        raise Failure(f"--eth3d_evaluator: {path} is no program")
    return os.path.abspath(path)


def parse(text, tolerances):
    """The score at tolerances, in ascending order, in what an evaluator printed."""
    score = {}
    for key, name in _LINES.items():
        matches = re.findall(rf"^{name}: (.*)$", text, re.MULTILINE)
        if not matches:
            raise Failure(f"the evaluator printed no line {name}:")
        try:
            score[key] = [float(word) for word in matches[-1].split()]
        except ValueError as error:
            raise Failure("the evaluator printed no numbers behind "
                          f"{name}: {matches[-1]}") from error
    if len(set(map(len, score.values()))) != 1:
        raise Failure("the evaluator printed lines of different length")
    printed = score["tolerances"]  # Six digits of each.
    if len(printed) != len(tolerances) or not all(
            math.isclose(*pair, rel_tol=1e-5) for pair in zip(printed, tolerances)):
        raise Failure("the evaluator printed other tolerances than asked")
    return {**score, "tolerances": list(tolerances)}


def _read(folder):
    return files.read_json(os.path.join(folder, "cloud_scores.json"), Dict[str, CloudScore]) or {}


def load(folder):
    """The scores of the clouds in a folder, by name; those of other clouds not.

    Scores stay where the cloud is gone.
    """
    return {name: score for name, score in _read(folder).items()
            if files.fingerprint(os.path.join(folder, name + ".ply"))
            in ("", score.made_from.cloud)}


class ScoreCloud(Step):
    """The score of FOLDER/CLOUD.ply in FOLDER/cloud_scores.json."""

    def __init__(self, folder, cloud, scans, evaluator, tolerances=(), options=list):
        """scans: a MeshLab project; tolerances: more than those above.

        options: a function that gives more options of the evaluator.
        """
        self.name = f"score of {cloud}.ply"
        self._folder = folder
        self._cloud = cloud
        self._scans = scans
        self._evaluator = evaluator
        self._tolerances = sorted({*TOLERANCES, *tolerances})
        self._options = options

    def _source(self):
        return {"scans": files.fingerprint(os.path.dirname(self._scans)),
                "evaluator": os.path.basename(self._evaluator), "options": self._options()}

    def is_done(self):
        score = load(self._folder).get(self._cloud)
        return (score is not None and all(map(score.at, self._tolerances))
                and score.made_from.dict(exclude={"cloud"}) == self._source())

    def commands(self):
        return [[self._evaluator, "--tolerances", processes.list_text(self._tolerances),
                 "--reconstruction_ply_path", os.path.join(self._folder, self._cloud + ".ply"),
                 "--ground_truth_mlp_path", self._scans, *self._options()]]

    def run(self):
        log = os.path.join(self._folder, f"cloud_scores_{self._cloud}.log")
        if os.path.exists(log):
            os.remove(log)
        processes.run(self.commands()[0], log)
        with open(log, encoding="utf-8", errors="replace") as file:
            score = parse(file.read(), self._tolerances)
        cloud = files.fingerprint(os.path.join(self._folder, self._cloud + ".ply"))
        scores = {name: other.dict() for name, other in load(self._folder).items()}
        scores[self._cloud] = {**score, "made_from": {"cloud": cloud, **self._source()}}
        files.write_json(os.path.join(self._folder, "cloud_scores.json"), scores)
