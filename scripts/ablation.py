#!/usr/bin/env python3
"""Compares TAPA with COLMAP's algorithm and with TAPA without one of its parts.

    scripts/ablation.py DATA OUT [--methods NAMES] [--seeds 0,1,2]
                        [--tolerances 0.05,0.1] [--relative_tolerances 1]
                        [-- OPTION ...]

Runs scripts/evaluate_dataset.sh on DATA once per method and seed, into
OUT/METHOD-SEED, and prints the scores as a table, means over the seeds; of
several seeds the smallest and the largest F1, too. What follows -- goes to
patch_match_stereo. SOURCES and EVERY are as in make_workspace.sh. A run that
was stopped goes on where it left off. Pictures of depth are not written.
"""

import argparse
import json
import os
import re
import statistics
import subprocess
import sys

PAPER = ["--PatchMatchStereo.tapa", "1",
         "--PatchMatchStereo.tapa_completion", "0"]
FULL = ["--PatchMatchStereo.tapa", "1"]


def without(part):
    return ["--PatchMatchStereo.tapa_" + part, "0"]


# The paper's Table 2 is plain and paper*; the others are what this program does.
METHODS = {
    "plain": [],
    "paper-weights": PAPER + without("texture_weighting"),
    "paper-coarse": PAPER + without("coarse_superpixels"),
    "paper-fine": PAPER + without("fine_superpixels"),
    "paper-refinement": PAPER + without("refinement"),
    "paper": PAPER,
    "tapa-weights": FULL + without("texture_weighting"),
    "tapa-coarse": FULL + without("coarse_superpixels"),
    "tapa-fine": FULL + without("fine_superpixels"),
    "tapa": FULL,
}


def run(arguments, method, seed):
    """Scores of one run: of all pixels, of low texture, and CPU seconds."""
    here = os.path.dirname(os.path.abspath(__file__))
    out = os.path.join(arguments.out, f"{method}-{seed}")
    done = os.path.join(out, "ablation.json")
    if not os.path.exists(done):
        print(f"{method}, seed {seed} ...", file=sys.stderr, flush=True)
        environment = dict(os.environ, TOLERANCES=arguments.tolerances,
                           RELATIVE_TOLERANCES=arguments.relative_tolerances,
                           MAX_TEXTURENESS="0.75")
        result = subprocess.run(
            [os.path.join(here, "evaluate_dataset.sh"), arguments.data, out,
             "--PatchMatchStereo.seed", str(seed), *METHODS[method],
             *arguments.options],
            env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            text=True, check=False)
        if result.returncode != 0:
            sys.exit(f"ERROR: {method}, seed {seed}: {result.stdout[-2000:]}")
        # Of each pass, as the program prints them in its last lines.
        cpu = [float(value) for value in re.findall(
            r"\(CPU ([0-9.]+) s\) per megapixel", result.stdout)]
        scores = {"cpu": 2 * statistics.mean(cpu) if cpu else None}
        for key, name in (("all", "scores"), ("low", "scores_low_texture")):
            path = os.path.join(out, name + ".json")
            with open(path, encoding="utf-8") as file:
                scores[key] = json.load(file)["overall"]
        with open(done + ".new", "w", encoding="utf-8") as file:
            json.dump(scores, file)
        os.replace(done + ".new", done)
    with open(done, encoding="utf-8") as file:
        return json.load(file)


def row(results, index):
    """Text of one row, the means over the seeds."""
    def mean(value):
        return 100 * statistics.mean(value(result) for result in results)

    cells = []
    for tolerance in range(len(results[0]["all"]["tolerances"])):
        for name in ("completeness", "accuracy", "f1"):
            def value(result, name=name, tolerance=tolerance):
                return result["all"]["tolerances"][tolerance][name]
            text = f"{mean(value):.1f}"
            if name == "f1" and len(results) > 1:
                values = [100 * value(result) for result in results]
                text += f" ({min(values):.1f}-{max(values):.1f})"
            cells.append(text)
    cells.append("%.1f" % mean(
        lambda result: result["low"]["tolerances"][index]["completeness"]))
    # Times are compared, not added up: other work makes both longer.
    cells.append("%.0f" % statistics.median(
        result["cpu"] or 0 for result in results))
    return cells


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("data")
    parser.add_argument("out")
    parser.add_argument("--methods", default=",".join(METHODS))
    parser.add_argument("--seeds", default="0")
    parser.add_argument("--tolerances", default="0.05,0.1")
    parser.add_argument("--relative_tolerances", default="1")
    # argparse cannot tell options after -- from a third position.
    words = sys.argv[1:]
    end = words.index("--") if "--" in words else len(words)
    arguments = parser.parse_args(words[:end])
    arguments.options = words[end + 1:]
    methods = arguments.methods.split(",")
    for method in methods:
        if method not in METHODS:
            parser.error(f"unknown method {method}; there are "
                         + ", ".join(METHODS))
    seeds = [int(seed) for seed in arguments.seeds.split(",")]
    # Low texture is scored at 10 cm, or what comes closest to it.
    metres = [float(value) for value in arguments.tolerances.split(",")]
    index = min(range(len(metres)), key=lambda i: abs(metres[i] - 0.1))

    header_printed = False
    for method in methods:
        results = [run(arguments, method, seed) for seed in seeds]
        if not header_printed:
            header_printed = True
            print("| method |", end="")
            for entry in results[0]["all"]["tolerances"]:
                name = (f"{100 * entry['tolerance']:g} cm"
                        if entry["unit"] == "m"
                        else f"{entry['tolerance']:g} %")
                print(f" {name}: C | A | F1 |", end="")
            entry = results[0]["low"]["tolerances"][index]
            print(f" low texture, {100 * entry['tolerance']:g} cm: C "
                  "| CPU s / MP |")
            columns = 3 * len(results[0]["all"]["tolerances"]) + 3
            print("|" + "---|" * columns)
        print(f"| {method} | " + " | ".join(row(results, index)) + " |",
              flush=True)


if __name__ == "__main__":
    main()
