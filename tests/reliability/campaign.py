"""Disturbs the programs in every way, and says what they did not stand; see --help."""

import argparse
import os
import random
import shutil
import sys
import tempfile
import time

import clocks
import disks
import io_errors
import kills
import memory
import programs
import trials
import two_runs

# By name: the module, and how often it tries each program in the whole campaign.
SCENARIOS = {"kills": (kills, 40), "io_errors": (io_errors, 12), "disks": (disks, 8),
             "memory": (memory, 8), "two_runs": (two_runs, 4), "clocks": (clocks, 3)}


def run(counts, chosen_programs, seed, folder):
    """Returns a Report by scenario; counts: by scenario and name of the program."""
    for program in chosen_programs:
        program.measure(folder)
    reports = {}
    for name, count_of in counts.items():
        begin = time.monotonic()
        report = reports[name] = trials.Report()
        for program in chosen_programs:
            if program.name in count_of:
                rng = random.Random(f"{seed} {name} {program.name}")
                SCENARIOS[name][0].run(program, count_of[program.name], rng, report)
        print(f"{SCENARIOS[name][0].TITLE}: {report.num_trials} times, "
              f"{report.num_ended} of them cut off or refused, "
              f"{len(report.faults)} faults, {time.monotonic() - begin:.0f} s",
              flush=True)
    return reports


def _choices(words):
    def parse(text):
        chosen = text.split(",")
        if not set(chosen) <= set(words):
            raise argparse.ArgumentTypeError(f"choose from {', '.join(words)}")
        return chosen
    return parse


def main(words):
    parser = argparse.ArgumentParser(
        description="Kills stereo, fusion and the automatic reconstructor at random "
        "moments, takes disk, memory and working files from them, and runs them again: "
        "their files have to be those of an undisturbed run.")
    every = [program.name for program in programs.all_programs()]
    parser.add_argument("--scenarios", type=_choices(list(SCENARIOS)),
                        default=list(SCENARIOS), help=", ".join(SCENARIOS))
    parser.add_argument("--programs", type=_choices(every), default=every,
                        help=", ".join(every))
    parser.add_argument("--share", type=float, default=1,
                        help="how much of the campaign; 1 kills 200 times")
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args(words)
    if not os.path.exists(programs.tiny.COLMAP):
        sys.exit(f"ERROR: there is no {programs.tiny.COLMAP}; scripts/build.sh makes it")
    counts = {name: {program: max(1, round(arguments.share * SCENARIOS[name][1]))
                     for program in arguments.programs}
              for name in arguments.scenarios}
    folder = tempfile.mkdtemp(prefix="tapa-reliability-")
    try:
        reports = run(counts, [program for program in programs.all_programs()
                               if program.name in arguments.programs],
                      arguments.seed, folder)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return int(any(report.faults for report in reports.values()))
