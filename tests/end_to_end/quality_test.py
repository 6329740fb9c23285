#!/usr/bin/env python3
"""Runs dense stereo on a data set with measured depth and judges the scores.

    quality_test.py SOURCE_DIR BIN_DIR OUT_DIR CASE

Exits with 77 (skipped) where the data set is absent.
"""

import json
import os
import re
import shutil
import subprocess
import sys

# What each case runs on, and the bounds that its scores must keep. The bounds
# leave room for other seeds and processors, not for a broken engine:
# docs/results.md has what was measured.
CASES = {
    "room": {
        "data": "examples/room",
        "bounds": [
            ("accuracy", "%", 2.0, ">=", 0.79),
            ("f1", "%", 2.0, ">=", 0.64),
            ("median_relative_error", None, None, "<=", 0.0025),
        ],
    },
    "fountain": {
        "data": "../shared/data/fountain",
        "options": ["--PatchMatchStereo.max_image_size", "768"],
        "bounds": [
            ("accuracy", "%", 1.0, ">=", 0.93),
            ("f1", "%", 1.0, ">=", 0.88),
            ("f1", "m", 0.05, ">=", 0.84),
            ("median_relative_error", None, None, "<=", 0.0016),
        ],
    },
    "office": {
        "data": "../shared/data/office_entrance",
        "environment": {"EVERY": "4"},
        "bounds": [
            ("accuracy", "m", 0.10, ">=", 0.85),
            ("f1", "m", 0.10, ">=", 0.47),
        ],
    },
}

MAX_CPU_SECONDS_PER_MEGAPIXEL = 400


def find_value(scores, name, unit, tolerance):
    if unit is None:
        return scores[name]
    for row in scores["tolerances"]:
        if row["unit"] == unit and abs(row["tolerance"] - tolerance) < 1e-9:
            return row[name]
    raise KeyError(f"{name} at {tolerance} ({unit})")


def check_scores(case, scores):
    failures = 0
    for name, unit, tolerance, relation, bound in case["bounds"]:
        value = find_value(scores, name, unit, tolerance)
        good = value >= bound if relation == ">=" else value <= bound
        at = "" if unit is None else f" at {tolerance:g} ({unit})"
        print(f"{'ok    ' if good else 'FAILED'} {name}{at}: {value:.4f}, "
              f"must be {relation} {bound}")
        failures += not good
    return failures


def check_speed(log):
    """CPU seconds per megapixel and view, both passes together."""
    values = [float(v) for v in re.findall(
        r"\(CPU ([0-9.]+) s\) per megapixel", log)]
    if not values:
        print("FAILED the log does not say how long a megapixel took")
        return 1
    total = 2 * sum(values) / len(values)
    good = total <= MAX_CPU_SECONDS_PER_MEGAPIXEL
    print(f"{'ok    ' if good else 'FAILED'} {total:.0f} CPU seconds per "
          f"megapixel and view, must be <= {MAX_CPU_SECONDS_PER_MEGAPIXEL}")
    return 0 if good else 1


def main():
    source_dir, bin_dir, out_dir, name = sys.argv[1:]
    case = CASES[name]
    data = os.path.join(source_dir, case["data"])
    if not os.path.isdir(data):
        print(f"SKIPPED: {case['data']} is not there")
        return 77
    out = os.path.join(out_dir, name)
    shutil.rmtree(out, ignore_errors=True)
    environment = dict(os.environ, TAPA_BIN_DIR=bin_dir,
                       **case.get("environment", {}))
    run = subprocess.run(
        [os.path.join(source_dir, "scripts", "evaluate_dataset.sh"), data, out,
         *case.get("options", [])],
        env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        text=True, check=False)
    print(run.stdout)
    if run.returncode != 0:
        print(f"FAILED with exit status {run.returncode}")
        return 1
    with open(os.path.join(out, "scores.json"), encoding="utf-8") as file:
        scores = json.load(file)["overall"]
    return min(1, check_scores(case, scores) + check_speed(run.stdout))


if __name__ == "__main__":
    sys.exit(main())
