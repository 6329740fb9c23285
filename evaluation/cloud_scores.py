"""Scores of points against laser scans, as ETH3D defines them.

cloud_scores.json has, by the name of the cloud (FOLDER/NAME.ply),

    {"tolerances": [..], "completeness": [..], "accuracy": [..], "f1": [..],
     "made_from": {"cloud", "scans", "evaluator", "options"}}

The last says what was scored, against what and how, so that the score of another
cloud or by another program is not taken for it.
evaluator is evaluate_point_cloud or ETH3D's own program, which takes the same
options and prints the same lines.
"""

import math
import os
import re

from . import files, machine, processes

# Metres; those of the paper's Table 2.
TOLERANCES = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5]

_LINES = {"tolerances": "Tolerances", "completeness": "Completenesses",
          "accuracy": "Accuracies", "f1": "F1-scores"}

_SHAPE = {str: {**{key: [float] for key in _LINES},
                "made_from?": {"cloud": str, "scans": str, "evaluator": str,
                               "options": [str]}}}


def default_evaluator(bin_dir=None):
    """Path of evaluate_point_cloud. Raises Failure if it is not built."""
    return machine.find_program(bin_dir or machine.default_bin_dir(),
                                "evaluate_point_cloud")


def named_evaluator(path):
    """Absolute path of a program that the user names. Raises Failure if it is none."""
    if not (os.path.isfile(path) and os.access(path, os.X_OK)):
        raise processes.Failure(f"--eth3d_evaluator: {path} is no program")
    return os.path.abspath(path)


def command(evaluator, cloud, scans, tolerances=None, options=()):
    """cloud: a PLY; scans: a MeshLab project of scans with their poses.

    options: more options of the evaluator.
    """
    return [evaluator, "--tolerances",
            ",".join(map(processes.number_text, tolerances or TOLERANCES)),
            "--reconstruction_ply_path", cloud,
            "--ground_truth_mlp_path", scans, *options]


def parse(text, tolerances):
    """The score at tolerances, in ascending order, in what an evaluator printed."""
    result = {}
    for key, name in _LINES.items():
        matches = re.findall(rf"^{name}: (.*)$", text, re.MULTILINE)
        if not matches:
            raise processes.Failure(f"the evaluator printed no line {name}:")
        try:
            result[key] = [float(word) for word in matches[-1].split()]
        except ValueError as error:
            raise processes.Failure(f"the evaluator printed no numbers behind "
                                    f"{name}: {matches[-1]}") from error
    if len({len(values) for values in result.values()}) != 1:
        raise processes.Failure("the evaluator printed lines of different "
                                "length")
    printed = result["tolerances"]  # Six digits of each.
    if len(printed) != len(tolerances) or not all(
            math.isclose(*pair, rel_tol=1e-5) for pair in zip(printed, tolerances)):
        raise processes.Failure("the evaluator printed other tolerances than asked")
    result["tolerances"] = list(tolerances)
    return result


def score(folder, clouds, scans, evaluator=None, tolerances=None, options=()):
    """Scores clouds, by name, unless FOLDER/cloud_scores.json has them.

    Returns all that is in cloud_scores.json.
    """
    path = os.path.join(folder, "cloud_scores.json")
    evaluator = evaluator or default_evaluator()
    tolerances = sorted(tolerances or TOLERANCES)
    scores = load(folder)
    way = {"scans": files.fingerprint(os.path.dirname(scans)),
           "evaluator": os.path.basename(evaluator), "options": list(options)}
    for name in clouds:
        if _covers(scores.get(name), tolerances, way):
            continue
        cloud = os.path.join(folder, name + ".ply")
        log = os.path.join(folder, f"cloud_scores_{name}.log")
        if os.path.exists(log):
            os.remove(log)
        processes.say(f"{folder}: score of {name}.ply ...")
        processes.run(command(evaluator, cloud, scans, tolerances, options), log)
        with open(log, encoding="utf-8", errors="replace") as file:
            scores[name] = parse(file.read(), tolerances)
        scores[name]["made_from"] = {"cloud": files.fingerprint(cloud), **way}
        files.write_json(path, scores)
    return scores


def _covers(score_, tolerances, way):
    if score_ is None or not all(
            any(abs(value - there) < 1e-9 for there in score_["tolerances"])
            for value in tolerances):
        return False
    known = score_.get("made_from", way)
    return all(known[key] == value for key, value in way.items())


def load(folder):
    """The scores of the clouds in a folder, by name; those of other clouds not.

    Scores stay where the cloud is gone.
    """
    scores = files.read_json(os.path.join(folder, "cloud_scores.json"), _SHAPE) or {}
    return {name: one for name, one in scores.items()
            if _is_of(one, os.path.join(folder, name + ".ply"))}


def _is_of(score_, cloud):
    known, now = score_.get("made_from"), files.fingerprint(cloud)
    return known is None or not now or known["cloud"] == now


def at(score_, value):
    """{"completeness", "accuracy", "f1"} at a tolerance, or None."""
    for i, tolerance in enumerate(score_["tolerances"]):
        if abs(tolerance - value) < 1e-9:
            return {key: score_[key][i] for key in _LINES
                    if key != "tolerances"}
    return None
