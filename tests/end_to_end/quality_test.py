#!/usr/bin/env python3
"""Runs dense stereo without and with TAPA on a data set with measured depth and
judges the scores.

    quality_test.py SOURCE_DIR BIN_DIR DATA OUT CASE

Exits with 77 (skipped) where DATA is absent.
"""

import json
import os
import shutil
import subprocess
import sys

# What each case runs on, the bounds that the scores of COLMAP's own algorithm
# must keep, those of TAPA's, and how much TAPA's must be above (positive) or may be
# below (negative) them. The bounds leave room for other seeds and processors, not
# for a broken engine: docs/results.md has what was measured in full size. Small
# cases were measured with 2, 3 and 5 iterations, and with rays through integer and
# half coordinates; scores must come to within about 5 points of the worst, and
# gains to half of the smallest. "low" is of low texture.
CASES = {
    "room_small": {
        "arguments": ["--image_size", "240"],
        "plain": [
            ("all", "accuracy", "%", 2.0, ">=", 0.60),
            ("all", "f1", "%", 2.0, ">=", 0.55),
            ("all", "median_relative_error", None, None, "<=", 0.0115),
        ],
        "tapa": [
            ("all", "f1", "%", 2.0, ">=", 0.66),
            ("low", "completeness", "m", 0.10, ">=", 0.65),
        ],
        "gain": [
            ("all", "f1", "m", 0.05, 0.055),
            ("all", "f1", "%", 1.0, 0.05),
            ("low", "f1", "m", 0.10, 0.12),
        ],
    },
    "room_full_size": {
        "arguments": [],
        "plain": [
            ("all", "accuracy", "%", 2.0, ">=", 0.79),
            ("all", "f1", "%", 2.0, ">=", 0.64),
            ("all", "median_relative_error", None, None, "<=", 0.0025),
        ],
        "tapa": [
            ("all", "f1", "%", 2.0, ">=", 0.72),
            ("low", "completeness", "m", 0.10, ">=", 0.60),
        ],
        "gain": [
            ("all", "f1", "m", 0.05, 0.05),
            ("all", "f1", "%", 1.0, 0.05),
            ("low", "f1", "m", 0.10, 0.20),
        ],
    },
    "fountain_small": {
        "arguments": ["--image_size", "384", "--every", "2"],
        "plain": [
            ("all", "accuracy", "%", 1.0, ">=", 0.88),
            ("all", "f1", "%", 1.0, ">=", 0.73),
            ("all", "f1", "m", 0.05, ">=", 0.68),
            ("all", "median_relative_error", None, None, "<=", 0.0025),
        ],
        "tapa": [
            ("all", "f1", "%", 1.0, ">=", 0.75),
        ],
        "gain": [
            ("all", "f1", "m", 0.02, -0.02),
            ("all", "f1", "m", 0.05, -0.01),
            ("all", "f1", "%", 1.0, -0.01),
        ],
    },
    "fountain_full_size": {
        "arguments": ["--image_size", "768"],
        "plain": [
            # Rays through the corners of pixels: 0.482; through their centres: 0.574.
            ("all", "f1", "m", 0.01, ">=", 0.53),
            ("all", "accuracy", "%", 1.0, ">=", 0.93),
            ("all", "f1", "%", 1.0, ">=", 0.88),
            ("all", "f1", "m", 0.05, ">=", 0.84),
            ("all", "median_relative_error", None, None, "<=", 0.0016),
        ],
        "tapa": [
            ("all", "f1", "%", 1.0, ">=", 0.88),
        ],
        # Nothing may get worse where there is texture.
        "gain": [
            ("all", "f1", "m", 0.02, -0.01),
            ("all", "f1", "m", 0.05, -0.01),
            ("all", "f1", "%", 1.0, -0.01),
        ],
    },
    "office_small": {
        "arguments": ["--image_size", "270", "--every", "4"],
        "plain": [
            ("all", "accuracy", "m", 0.10, ">=", 0.84),
            ("all", "f1", "m", 0.10, ">=", 0.55),
        ],
        "tapa": [
            ("all", "f1", "m", 0.10, ">=", 0.76),
            ("low", "completeness", "m", 0.10, ">=", 0.75),
        ],
        "gain": [
            ("all", "f1", "m", 0.05, 0.08),
            ("all", "f1", "m", 0.10, 0.10),
            ("all", "completeness", "m", 0.10, 0.16),
            ("all", "accuracy", "m", 0.10, -0.11),
        ],
    },
    "office_full_size": {
        "arguments": ["--every", "4"],
        "plain": [
            ("all", "accuracy", "m", 0.10, ">=", 0.85),
            ("all", "f1", "m", 0.10, ">=", 0.47),
        ],
        "tapa": [
            ("all", "f1", "m", 0.10, ">=", 0.70),
            ("low", "completeness", "m", 0.10, ">=", 0.60),
        ],
        "gain": [
            ("all", "f1", "m", 0.05, 0.10),
            ("all", "f1", "m", 0.10, 0.10),
            ("all", "completeness", "m", 0.10, 0.20),
            ("all", "accuracy", "m", 0.10, -0.06),
        ],
    },
}

MAX_CPU_SECONDS_PER_MEGAPIXEL = 400

# Of TAPA's CPU time to that of COLMAP's algorithm. 1.23 was measured
# (docs/results.md); the two runs follow each other, and other work on the machine
# may slow down one of them.
MAX_TIME_RATIO = 2


def find_value(scores, name, unit, tolerance):
    if unit is None:
        return scores[name]
    for row in scores["tolerances"]:
        if row["unit"] == unit and abs(row["tolerance"] - tolerance) < 1e-9:
            return row[name]
    raise KeyError(f"{name} at {tolerance} ({unit})")


def report(good, text):
    print(("ok     " if good else "FAILED ") + text)
    return 0 if good else 1


def name_of(part, name, unit, tolerance):
    at = "" if unit is None else f" at {tolerance:g} ({unit})"
    return ("low texture: " if part == "low" else "") + name + at


def check_scores(bounds, scores):
    failures = 0
    for part, name, unit, tolerance, relation, bound in bounds:
        value = find_value(scores[part], name, unit, tolerance)
        good = value >= bound if relation == ">=" else value <= bound
        failures += report(good, f"{name_of(part, name, unit, tolerance)}: "
                           f"{value:.4f}, must be {relation} {bound}")
    return failures


def check_gain(bounds, plain, tapa):
    failures = 0
    for part, name, unit, tolerance, bound in bounds:
        values = [find_value(scores[part], name, unit, tolerance)
                  for scores in (plain, tapa)]
        failures += report(
            values[1] - values[0] >= bound,
            f"{name_of(part, name, unit, tolerance)}: {values[1]:.4f} with "
            f"TAPA, {values[0]:.4f} without, must rise by {bound:+g}")
    return failures


def run(source_dir, bin_dir, data, out, arguments):
    """Runs COLMAP's own algorithm and TAPA. Returns the exit status."""
    shutil.rmtree(out, ignore_errors=True)
    status = subprocess.run(
        [os.path.join(source_dir, "scripts", "evaluate"), data, "--out", out,
         "--no_clouds", *arguments],
        env=dict(os.environ, TAPA_BIN_DIR=bin_dir), check=False).returncode
    if status == 0:
        with open(os.path.join(out, "report.md"), encoding="utf-8") as file:
            print(file.read())
    return status


def read_json(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def read_results(folder):
    """Scores by part, and CPU seconds of both passes per megapixel and view."""
    scores, record = (read_json(os.path.join(folder, name))
                      for name in ("depth_scores.json", "record.json"))
    (low,) = (entry["score"] for entry in scores["by_textureness"]
              if entry["max_textureness"] == 0.75)
    width, height = record["image_size"]
    return ({"all": scores["overall"], "low": low},
            record["cpu_seconds"]["stereo"] * 1e6
            / (record["views"] * width * height))


def main():
    source_dir, bin_dir, data, out, name = sys.argv[1:]
    case = CASES[name]
    if not os.path.isdir(data):
        print(f"SKIPPED: {data} is not there")
        return 77
    status = run(source_dir, bin_dir, data, out, case["arguments"])
    if status != 0:
        return report(False, f"scripts/evaluate: exit status {status}")
    (plain, plain_time), (tapa, tapa_time) = (
        read_results(os.path.join(out, os.path.basename(data), method))
        for method in ("plain-0", "tapa-0"))
    failures = (check_scores(case["plain"], plain)
                + check_scores(case["tapa"], tapa)
                + check_gain(case["gain"], plain, tapa))
    failures += report(plain_time <= MAX_CPU_SECONDS_PER_MEGAPIXEL,
                       f"{plain_time:.0f} CPU seconds per megapixel and view, "
                       f"must be <= {MAX_CPU_SECONDS_PER_MEGAPIXEL}")
    failures += report(tapa_time <= MAX_TIME_RATIO * plain_time,
                       f"with TAPA {tapa_time / plain_time:.2f} times as many, "
                       f"must be <= {MAX_TIME_RATIO}")
    return min(1, failures)


if __name__ == "__main__":
    sys.exit(main())
