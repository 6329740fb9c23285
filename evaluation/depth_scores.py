"""Scores of depth maps against measured depth.

depth_scores.json is what evaluate_depth_maps writes with --json, and "made_from", which says
of which maps and measurements, so that scores of others are not taken for theirs.
"""

import contextlib
import os
from typing import List, Optional

from . import evaluate_depth_maps, files, machine, processes, schemas
from .schemas import Number, Text
from .steps import Step

# Metres: those of the paper's figure of errors. Per cent of the depth.
TOLERANCES = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5]
RELATIVE_TOLERANCES = [0.5, 1, 2]
# Upper bounds of textureness, which is 0.5 to 1.
TEXTURENESS = [0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 1]
LOW_TEXTURE = 0.75


class ToleranceScore(schemas.Model):
    """unit: m, or % of the depth. None is what is not a number, as accuracy of no estimates."""
    tolerance: Number
    unit: Text
    completeness: Optional[Number] = ...
    accuracy: Optional[Number] = ...
    f1: Optional[Number] = ...


class PixelScore(schemas.Model):
    """Of all pixels, or of those of low textureness."""
    coverage: Optional[Number] = ...
    measurement_coverage: Optional[Number] = ...
    median_absolute_error: Optional[Number] = ...
    median_relative_error: Optional[Number] = ...
    tolerances: List[ToleranceScore]

    def at(self, value, unit="m"):
        """The score at a tolerance, None if it was not scored."""
        return next((entry for entry in self.tolerances
                     if entry.unit == unit and abs(entry.tolerance - value) < 1e-9), None)


class BoundedScore(schemas.Model):
    """Of the pixels of lower textureness."""
    max_textureness: Number
    score: PixelScore


class Source(schemas.Model):
    """Fingerprints of what was scored and of the measurements."""
    maps: Text
    truth: Text


class DepthScores(schemas.Model):
    """depth_scores.json."""
    overall: PixelScore
    by_textureness: List[BoundedScore] = []
    made_from: Source

    def below(self, bound):
        """The score of the pixels of lower textureness, None if not scored."""
        return next((entry.score for entry in self.by_textureness
                     if abs(entry.max_textureness - bound) < 1e-9), None)


def _maps(folder):
    return os.path.join(folder, "stereo", "depth_maps")


def _is_of(known, path):
    """Whether a score is of what is at a path. Where that is gone, it stays."""
    return files.fingerprint(path) in ("", known)


def load(folder):
    """The scores in a folder, None where there are none of the maps in it."""
    scores = files.read_json(os.path.join(folder, "depth_scores.json"), DepthScores)
    return scores if scores and _is_of(scores.made_from.maps, _maps(folder)) else None


class ScoreDepth(Step):
    """FOLDER/depth_scores.json of a workspace."""
    name = "scores of depth maps"

    def __init__(self, folder, truth, tolerances=(), relative_tolerances=()):
        """truth: folder of measured depth; tolerances: more than those above."""
        self._folder = folder
        self._truth = truth
        self._tolerances = sorted({*TOLERANCES, *tolerances})
        self._relative = sorted({*RELATIVE_TOLERANCES, *relative_tolerances})
        self._path = os.path.join(folder, "depth_scores.json")

    def is_done(self):
        scores = load(self._folder)
        return (scores is not None and _is_of(scores.made_from.truth, self._truth)
                and all(scores.overall.at(value) for value in self._tolerances)
                and all(scores.overall.at(value, "%") for value in self._relative)
                and all(map(scores.below, TEXTURENESS)))

    def commands(self):
        return [[os.path.join(machine.ROOT, "scripts", "evaluate_depth_maps"),
                 "--workspace_path", self._folder, "--ground_truth_path", self._truth,
                 "--tolerances", processes.list_text(self._tolerances),
                 "--relative_tolerances", processes.list_text(self._relative),
                 "--max_textureness", processes.list_text(TEXTURENESS),
                 "--json", self._path]]

    def run(self):
        log = os.path.join(self._folder, "depth_scores.log")
        with open(log, "w", encoding="utf-8", errors="surrogateescape") as file, \
                contextlib.redirect_stdout(file):
            scores = evaluate_depth_maps.evaluate(evaluate_depth_maps.parse(
                self.commands()[0][1:]))
        files.write_json(self._path, {
            **scores, "made_from": {"maps": files.fingerprint(_maps(self._folder)),
                                    "truth": files.fingerprint(self._truth)}})
