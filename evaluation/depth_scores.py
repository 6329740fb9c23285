"""Scores of depth maps against measured depth, by evaluate_depth_maps.

depth_scores.json is what that program writes with --json: "overall" and "images",
and "by_textureness" with the score of all pixels of lower textureness for
several bounds. "made_from" says of which maps and measurements, so that scores of
others are not taken for theirs.
"""

import os

from . import files, machine, processes

# Metres: those of the paper's figure of errors. Per cent of the depth.
TOLERANCES = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5]
RELATIVE_TOLERANCES = [0.5, 1, 2]
# Upper bounds of textureness, which is 0.5 to 1.
TEXTURENESS = [0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 1]
LOW_TEXTURE = 0.75

# null is what is not a number, as the accuracy of no estimates.
_PART = {
    **{key: (None, float) for key in (
        "coverage", "measurement_coverage", "median_absolute_error",
        "median_relative_error")},
    "tolerances": [{"tolerance": float, "unit": str, **{
        key: (None, float) for key in ("completeness", "accuracy", "f1")}}]}
_SHAPE = {"overall": _PART,
          "by_textureness?": [{"max_textureness": float, "score": _PART}],
          "made_from?": {"maps": str, "truth": str}}


def _list(values):
    return ",".join(map(processes.number_text, values))


def command(workspace, ground_truth, output, tolerances=None,
            relative_tolerances=None, textureness=None, bin_dir=None):
    """The command that writes the scores of a workspace to output."""
    return [os.path.join(bin_dir or machine.default_bin_dir(),
                         "evaluate_depth_maps"),
            "--workspace_path", workspace, "--ground_truth_path", ground_truth,
            "--tolerances", _list(tolerances or TOLERANCES),
            "--relative_tolerances",
            _list(relative_tolerances or RELATIVE_TOLERANCES),
            "--max_textureness", _list(textureness or TEXTURENESS),
            "--json", output]


def score(workspace, ground_truth, folder=None, **options):
    """Scores a workspace unless FOLDER/depth_scores.json has it. Returns scores.

    folder: the workspace itself where it is None. options: as in command().
    """
    folder = folder or workspace
    path = os.path.join(folder, "depth_scores.json")
    found = load(folder)
    if (found is not None and _covers(found, **options)
            and _same(found, "truth", ground_truth)):
        return found
    machine.find_program(options.get("bin_dir") or machine.default_bin_dir(),
                         "evaluate_depth_maps")
    processes.say(f"{folder}: scores of depth maps ...")
    raw = path + ".raw"
    processes.run(command(workspace, ground_truth, raw, **options),
                  os.path.join(folder, "depth_scores.log"))
    scores = files.read_json(raw, _SHAPE)
    scores["made_from"] = {"maps": files.fingerprint(_maps(workspace)),
                           "truth": files.fingerprint(ground_truth)}
    files.write_json(path, scores)
    os.remove(raw)
    return scores


def _maps(workspace):
    return os.path.join(workspace, "stereo", "depth_maps")


def _same(scores, what, path):
    """Whether scores are of what is at a path. Where that is gone, they stay."""
    known = scores.get("made_from")  # Not of scores that the program alone wrote.
    now = files.fingerprint(path)
    return known is None or not now or known[what] == now


def _covers(scores, tolerances=None, relative_tolerances=None,
            textureness=None, bin_dir=None):
    del bin_dir
    there = {(entry["unit"], entry["tolerance"])
             for entry in scores["overall"]["tolerances"]}
    bounds = {entry["max_textureness"]
              for entry in scores.get("by_textureness", [])}
    asked = ({("m", value) for value in tolerances or TOLERANCES}
             | {("%", value)
                for value in relative_tolerances or RELATIVE_TOLERANCES})
    return asked <= there and set(textureness or TEXTURENESS) <= bounds


def load(folder):
    """The scores in a folder, None where there are none of the maps in it."""
    scores = files.read_json(os.path.join(folder, "depth_scores.json"), _SHAPE)
    return (scores if scores is not None
            and _same(scores, "maps", _maps(folder)) else None)


def at(part, value, unit="m"):
    """The entry of a tolerance: {"completeness", "accuracy", "f1", ...} or None.

    part: "overall", an entry of "images", or the "score" of a bound.
    """
    for entry in part["tolerances"]:
        if entry["unit"] == unit and abs(entry["tolerance"] - value) < 1e-9:
            return entry
    return None


def below(scores, bound):
    """The score of the pixels of lower textureness, None if not scored."""
    for entry in scores.get("by_textureness", []):
        if abs(entry["max_textureness"] - bound) < 1e-9:
            return entry["score"]
    return None
