"""Compares methods of dense stereo on photographs with measured depth.

    scripts/evaluate DATA... --out OUT [--methods plain,tapa] [--seeds 0,1,2]
                     [--image_size N] [--every N] [--sources N]
                     [--tolerances 0.01,0.05] [--relative_tolerances 1]
                     [--compare NAME=PATH]... [--views NAMES | --num_views N]
                     [--no_clouds | --eth3d_evaluator PATH] [--dry_run]
                     [--report_only] [-- OPTION...]
    scripts/evaluate --plan PLAN --out OUT [--data FOLDER] [--only SETS]
                     [--report_only] [--dry_run]

DATA has images/, sparse/ and gt_depth/ in the format of examples/room; for a
first look:

    scripts/evaluate examples/room --out build/evaluation

A scene of examples/ that has no photographs, such as examples/office, is rendered
first, into OUT/scenes, which takes some minutes and needs POV-Ray.

Each method runs once per seed in OUT/SET/METHOD-SEED, where SET is the name of
DATA. OUT/report.md has tables, figures and pictures, OUT/report.html the same in
one file with points to turn and zoom, OUT/tables/ the same figures as CSV. A run that
was stopped goes on where it was. A method that fails does not stop the others, and is
listed at the end. While one is at work in
OUT, another is refused; --report_only is not. Options of patch_match_stereo follow --.
--dry_run prints, in order, the commands that are still to be run.

--compare also scores what another tool made: a folder of depth maps in COLMAP's
format (PHOTOGRAPH.geometric.bin), a COLMAP workspace, or a PLY with points in
the frame of DATA. --tolerances are in metres, --relative_tolerances in per cent
of the depth. Points are scored against DATA/scans/*.mlp, or else against what
scanners at the cameras would have measured.

--plan makes a page like docs/results.md from docs/results_plan.toml: runs what
is missing in OUT and writes the page and its figures beside the plan, or into OUT
as long as a set has no results at all. FOLDER has the plan's data sets. With --only
the page is about these sets alone, and goes to OUT.
"""

import argparse
import contextlib
import os
import subprocess
import sys

from . import (cloud_scores, command_line, experiment, files, machine, pictures, plan, processes,
               report, scenes, steps, stereo_run)
from .experiment import Experiment
from .page import report_page
from .processes import Failure


def _comparison(text):
    name, equals, path = text.partition("=")
    if not (name and equals and path):
        raise argparse.ArgumentTypeError(f"'{text}' is not NAME=PATH")
    return name, path


def _parse(words):
    parser = command_line.Parser(usage=__doc__)
    defaults = {name: field.default for name, field in Experiment.__fields__.items()}

    def add(name, kind, default=None):
        parser.add_argument("--" + name, type=kind, default=defaults.get(name, default))

    parser.add_argument("data_sets", nargs="*")
    parser.add_argument("--out")
    add("methods", command_line.methods)
    add("seeds", command_line.whole_numbers)
    add("image_size", command_line.whole_number(1))
    add("every", command_line.whole_number(1))
    add("sources", command_line.whole_number(1))
    add("tolerances", command_line.once(command_line.positive_numbers))
    add("relative_tolerances", command_line.once(command_line.positive_numbers))
    parser.add_argument("--compare", type=_comparison, action="append", default=[])
    add("views", command_line.texts)
    add("num_views", command_line.whole_number(0), 1)
    add("only", command_line.texts)
    for name in ("eth3d_evaluator", "plan", "data"):
        parser.add_argument("--" + name)
    for name in ("no_clouds", "report_only", "dry_run"):
        parser.add_argument("--" + name, action="store_true")
    arguments = parser.parse(words)
    if not arguments.out:
        parser.error("--out is required")
    if bool(arguments.plan) == bool(arguments.data_sets):
        parser.error("either data sets or --plan is required")
    return arguments


def _experiments(arguments):
    """What the command line asks for."""
    experiments = {}
    for data in map(os.path.abspath, arguments.data_sets):
        name = os.path.basename(data)
        if name in experiments:
            raise Failure(f"two data sets are called {name}; run them with an --out of their own")
        is_there = _prepare(data, arguments)
        data = scenes.rendered(data, os.path.abspath(arguments.out))
        experiments[name] = planned = Experiment(
            name=name, data=data, methods=arguments.methods, seeds=arguments.seeds,
            options=stereo_run.size_options(arguments.image_size) + arguments.options,
            sources=arguments.sources, every=arguments.every,
            tolerances=sorted(arguments.tolerances),
            relative_tolerances=sorted(arguments.relative_tolerances),
            compare=arguments.compare, views=arguments.views)
        if is_there:
            experiment.check(planned)
        if is_there and not arguments.views and arguments.num_views > 0:
            planned.views = pictures.choose_views(data, planned.every, arguments.num_views)
    return list(experiments.values())


def _prepare(data, arguments):
    """Renders a folder of photographs that is a scene. Returns False if it is to be rendered,
    but only the commands are asked for."""
    if scenes.is_scene(data) and not arguments.report_only:
        out = os.path.abspath(arguments.out)
        if not arguments.dry_run:
            scenes.render(data, out)
        elif not os.path.isdir(scenes.rendered(data, out)):
            print(processes.command_text(scenes.command(data, out)), flush=True)
            return False
    return True


def _planned(page, arguments):
    """The sets of a plan that can be run here."""
    planned = []
    for name, one_set in page.sets.items():
        if arguments.only and name not in arguments.only:
            continue
        if page.scenes[name]:
            try:
                if not _prepare(page.scenes[name], arguments):
                    planned.append(one_set)
                    continue
            except Failure as error:
                processes.say(f"SKIPPED: {name}: {error}")
                continue
            page.choose_views(name)
        if not os.path.isdir(one_set.data):
            processes.say(f"SKIPPED: {name}: there is no {one_set.data}")
            continue
        experiment.check(one_set)
        planned.append(one_set)
    return planned


def _programs(arguments):
    """The folder of the programs, which are built if they are missing and needed."""
    bin_dir = machine.default_bin_dir()
    if not (arguments.dry_run or arguments.report_only or os.environ.get("TAPA_BIN_DIR")
            or os.path.exists(os.path.join(bin_dir, "colmap"))):
        result = subprocess.run([os.path.join(machine.ROOT, "scripts", "build.sh")],
                                check=False, stdout=sys.stderr)
        if result.returncode != 0:
            sys.exit(result.returncode)
    return bin_dir


def _write_report(experiments, arguments, failures):
    out = arguments.out
    path = os.path.join(out, "report.md")
    reports = [report.SetReport(planned, out, out, os.path.join(out, "figures"),
                                os.path.join(out, "tables")) for planned in experiments]
    text = report.write_report(path, reports, failures,
                               ["Points were not scored, as asked."] if arguments.no_clouds
                               else [])
    print(f"Report: {path}")
    page = report_page.write_beside(path, text, reports)
    if page:
        print(f"Page: {page}")


def _write_page(page, arguments):
    path, missing = page.write(arguments.out, arguments.only)
    if missing:
        print("Missing:\n" + "\n".join(missing))
    print(f"Page: {path}")


def main(words=None):
    arguments = _parse(sys.argv[1:] if words is None else words)
    bin_dir = _programs(arguments)
    page = None
    if arguments.plan:
        page = plan.Plan(arguments.plan, arguments.data, machine.ROOT,
                         os.path.abspath(arguments.out))
        for name in arguments.only or []:
            if name not in page.sets:
                raise Failure(f"{arguments.plan} has no set {name}; there are "
                              + ", ".join(page.sets))
        experiments = _planned(page, arguments)
    else:
        experiments = _experiments(arguments)
    evaluator = (None if arguments.no_clouds
                 else cloud_scores.choose_evaluator(arguments.eth3d_evaluator))
    # A report may be made while a run goes on.
    is_reading = arguments.dry_run or arguments.report_only
    jobs, failures = [], []
    with contextlib.nullcontext() if is_reading else files.lock(arguments.out, "evaluation"):
        if not arguments.report_only:
            jobs = [job for planned in experiments
                    for job in experiment.jobs(planned, arguments.out, bin_dir, evaluator)]
            failures = steps.perform(jobs, arguments.dry_run)
        if not arguments.dry_run:
            if page:
                _write_page(page, arguments)
            else:
                _write_report(experiments, arguments, failures)
    return steps.exit_status(failures, len(jobs))
