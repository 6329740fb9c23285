"""Runs this program on the multi-view benchmark of ETH3D and reports how it does.

    scripts/eth3d download DIR      # archives of the scenes, into DIR/archives and DIR/scenes
    scripts/eth3d prepare DIR       # DIR/sets: photographs, model, measured depth, scans
    scripts/eth3d run DIR           # DIR/runs: depth maps and points of every method
    scripts/eth3d evaluate DIR      # scores beside them
    scripts/eth3d report DIR        # DIR/report: tables, figures and pictures
    scripts/eth3d submit DIR        # DIR/submission: what the benchmark's server takes
    scripts/eth3d miniature DIR     # DIR/scenes: a small scene to try all of this with

Each goes on where it was stopped. A scene that fails does not stop the others; it is
named at the end, and the exit status is 1. --dry_run prints every command and does
nothing. "scripts/eth3d COMMAND --help" lists the options; docs/eth3d.md explains them.
"""

import argparse
import contextlib
import functools
import os
import sys

from .. import (cloud_scores, command_line, depth_scores, files, methods, record, steps,
                stereo_run)
from ..processes import Failure
from ..steps import Job
from . import download as archives, prepare as sets, scenes, submit as submission
from .miniature import MakeMiniature
from .report import Eth3dReport

DEFAULT_METHODS = ["tapa", *methods.ABLATION]
# Metres, as ETH3D's unit (paper, section 4.1). COLMAP's algorithm fits no planes.
PLANE_OPTIONS = ["--PatchMatchStereo.tapa_plane_distance", "0.1"]


def _chosen(arguments, known, advice):
    """The scenes that the options choose."""
    names = arguments.scenes.split(",") if arguments.scenes else None
    chosen = scenes.select(known, arguments.resolution, arguments.split, names)
    if not chosen:
        raise Failure(f"there is no such scene; {advice}")
    return chosen


def _path(arguments, *parts):
    return os.path.join(arguments.dir, *parts)


def _unpacked(arguments):
    return arguments.unpacked or _path(arguments, "scenes")


def _prepared(arguments):
    return _chosen(arguments, scenes.prepared_scenes(_path(arguments, "sets")),
                   f"make sets with: scripts/eth3d prepare {arguments.dir}")


def _size_name(size):
    return "full" if size == 0 else str(size)


def _run_of(arguments, scene, method, seed, size):
    """The run of a method on a prepared scene."""
    return stereo_run.Run(
        data=_path(arguments, "sets", scene.set_name), set=scene.set_name, method=method,
        folder=_path(arguments, "runs", _size_name(size), scene.set_name,
                     stereo_run.folder_name(method, seed)),
        seed=seed, fusions={**stereo_run.FUSIONS, "fused": scene.track.fusion},
        options=[*stereo_run.size_options(size),
                 *([] if method in ("plain", "colmap") else PLANE_OPTIONS),
                 *arguments.options],
        sources=arguments.sources)


def _all_runs(arguments):
    """The runs of everything that the options choose, by their names."""
    runs = [_run_of(arguments, scene, method, seed, size)
            for size in arguments.image_sizes for scene in _prepared(arguments)
            for method in arguments.methods for seed in arguments.seeds]
    return {os.path.relpath(run.folder, _path(arguments, "runs")): run for run in runs}


def _check_complete(scored):
    if not scored.is_complete():
        raise Failure("it is not complete; make it with scripts/eth3d run")


def _perform(arguments, jobs):
    failures = steps.perform(jobs, arguments.dry_run)
    return steps.exit_status(failures, len(jobs))


def download(arguments):
    out = _unpacked(arguments)
    missing = [archive for archive in archives.archives_of(
        _chosen(arguments, scenes.all_scenes(), "ETH3D has others"), _path(arguments, "archives"),
        out, arguments.base_url, not arguments.without_depth, arguments.remove_archives)
        if not archive.is_done()]
    archives.seven_zip()
    failures, answered = [], missing
    if not arguments.dry_run:
        failures = steps.perform(Job(archive.name, [steps.Call("size", archive.ask_size)])
                                 for archive in missing)
        answered = [archive for archive in missing if archive.size is not None]
        if answered:
            archives.confirm(answered, out, arguments.yes)
    failures += steps.perform([Job(archive.name, [archive]) for archive in answered],
                              arguments.dry_run)
    return steps.exit_status(failures, len(missing))


def miniature(arguments):
    out = os.path.join(_unpacked(arguments), arguments.scene)
    return _perform(arguments, [Job(arguments.scene, [MakeMiniature(
        out, arguments.split, arguments.image_size, arguments.views, arguments.voxel_size)])])


def prepare(arguments):
    folder = _unpacked(arguments)
    chosen = _chosen(arguments, scenes.unpacked_scenes(folder),
                     f"{folder} has no unpacked scene; fetch them with: "
                     f"scripts/eth3d download {arguments.dir}")
    return _perform(arguments, [Job(scene.set_name, [sets.Prepare(
        scene, os.path.join(folder, scene.name), _path(arguments, "sets", scene.set_name),
        arguments.depth_size)]) for scene in chosen])


def run(arguments):
    return _perform(arguments, [
        Job(name, planned.steps(), functools.partial(record.note_failure, planned.folder))
        for name, planned in _all_runs(arguments).items()])


def evaluate(arguments):
    """Scores of what runs made, as far as there is a truth for it."""
    evaluator, jobs = cloud_scores.choose_evaluator(arguments.eth3d_evaluator), []
    for name, scored in _all_runs(arguments).items():
        wanted = [steps.Call("run", functools.partial(_check_complete, scored))]
        scans = os.path.join(scored.data, "scans", "scan_alignment.mlp")
        if os.path.exists(scans):
            wanted += [cloud_scores.ScoreCloud(scored.folder, cloud, scans, evaluator)
                       for cloud in scored.fusions]
        truth = os.path.join(scored.data, "gt_depth")
        if any(map_name.endswith(".bin") for map_name in files.names_below(truth)):
            wanted.append(depth_scores.ScoreDepth(scored.folder, truth))
        jobs.append(Job(name, wanted))
    return _perform(arguments, jobs)


def report(arguments):
    chosen, jobs = _prepared(arguments), []
    for size in map(_size_name, arguments.image_sizes):
        runs = _path(arguments, "runs", size)
        page = Eth3dReport(_path(arguments, "report", size), runs, _path(arguments, "sets"),
                           chosen, arguments.methods, arguments.seeds)
        jobs.append(Job(size, [steps.Call("report", lambda page=page: print(page.write()),
                                          f"# {page.folder}/report.md from {runs}")]))
    return _perform(arguments, jobs)


def submit(arguments):
    if len(arguments.image_sizes) != 1 or len(arguments.seeds) != 1:
        raise Failure("a submission is of one image size and one seed")
    size, seed = arguments.image_sizes[0], arguments.seeds[0]
    jobs, folders = [], {}
    for scene in _prepared(arguments):
        folder = _path(arguments, "submission", f"{arguments.method}-{_size_name(size)}",
                       scene.track.name)
        folders[folder] = scene.track.name
        made_by = _run_of(arguments, scene, arguments.method, seed, size)
        jobs.append(Job(scene.set_name, [submission.AddScene(
            folder, scene.name, made_by.folder, arguments.cloud)]))
    failures = steps.perform(jobs, arguments.dry_run)
    if not failures:
        jobs = [Job(name, [submission.Pack(folder)]) for folder, name in folders.items()]
        failures = steps.perform(jobs, arguments.dry_run)
    return steps.exit_status(failures, len(jobs))


def _choice_options(command, resolution="high", split="training"):
    command.add_argument("dir", metavar="DIR", help="folder for everything")
    command.add_argument("--resolution", choices=("high", "low", "both"), default=resolution,
                         help="dslr scenes, rig scenes or both (%(default)s)")
    command.add_argument("--split", choices=("training", "test", "both"), default=split,
                         help="with the truth, without, or both (%(default)s)")
    command.add_argument("--scenes", help="only these, for example office,pipes")
    command.add_argument("--dry_run", action="store_true", help="print what would be done")


def _run_options(command, several=True):
    command.add_argument("--seeds", type=command_line.whole_numbers, default=[0], help="0")
    command.add_argument("--image_sizes", type=command_line.whole_numbers, default=[2000],
                         help="longest side in pixels that stereo works at, 0: full (2000)")
    command.add_argument("--sources", type=command_line.whole_number(1), default=20,
                         help="source views each (20)")
    if several:
        command.add_argument("--methods", type=command_line.methods,
                             default=",".join(DEFAULT_METHODS),
                             help="of " + ",".join(methods.METHODS) + " (%(default)s)")


def _parse(words):
    parser = command_line.Parser(description=__doc__,
                                 formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")

    def add(function, text):
        command = commands.add_parser(function.__name__, help=text)
        command.set_defaults(function=function)
        return command

    command = add(download, "fetch, verify and unpack archives")
    _choice_options(command)
    command.add_argument("--without_depth", action="store_true",
                         help="no depth maps: points can be scored, depth maps cannot")
    command.add_argument("--remove_archives", action="store_true", help="once they are unpacked")
    command.add_argument("--yes", action="store_true", help="do not ask")
    command.add_argument("--base_url", help=f"where the archives are ({scenes.BASE_URL})")
    command.set_defaults(unpacked=None)
    command = add(prepare, "make sets of what was unpacked")
    _choice_options(command, "both", "both")
    command.add_argument("--unpacked", help="folder with unpacked scenes (DIR/scenes)")
    command.add_argument("--depth_size", type=command_line.whole_number(0), default=2000,
                         help="longest side of maps of measured depth, 0: full (%(default)s)")
    command = add(run, "make depth maps and points")
    _choice_options(command)
    _run_options(command)
    command = add(evaluate, "score them")
    _choice_options(command)
    _run_options(command)
    command.add_argument("--eth3d_evaluator", help="ETH3D's own program, to use in place of ours")
    command = add(report, "write tables, figures and pictures")
    _choice_options(command, "both", "both")
    _run_options(command)
    command = add(submit, "pack results for the benchmark's server")
    _choice_options(command, split="both")
    _run_options(command, several=False)
    command.add_argument("--method", type=command_line.method, default="tapa",
                         help="%(default)s")
    command.add_argument("--cloud", choices=tuple(stereo_run.FUSIONS), default="fused",
                         help="fused with TAPA's or with COLMAP's thresholds, or by weighing "
                              "agreement (%(default)s)")
    command = add(miniature, "make a small scene of the built-in example, to try all of this")
    command.add_argument("dir", metavar="DIR", help="folder for everything")
    command.add_argument("--scene", default="miniature", help="its name (%(default)s)")
    command.add_argument("--split", choices=("training", "test"), default="training",
                         help="with the truth or without (%(default)s)")
    command.add_argument("--image_size", type=command_line.whole_number(1), default=360,
                         help="longest side in pixels (%(default)s)")
    command.add_argument("--views", type=command_line.whole_number(1), default=8,
                         help="photographs of each track (%(default)s)")
    command.add_argument("--voxel_size", type=float, default=0.01,
                         help="metres between points of its scans (%(default)s)")
    command.set_defaults(unpacked=None, dry_run=False)
    arguments = parser.parse(words)
    if arguments.options and arguments.function in (download, prepare, miniature):
        parser.error("there is nothing to give on behind --")
    arguments.dir = os.path.abspath(arguments.dir)
    return arguments


def main():
    arguments = _parse(sys.argv[1:])
    with contextlib.nullcontext() if arguments.dry_run else files.lock(
            arguments.dir, "eth3d-" + arguments.command):
        return arguments.function(arguments)
