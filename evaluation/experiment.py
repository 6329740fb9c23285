"""Runs and scores methods on sets of photographs."""

import dataclasses
import os
import re
import shutil

from . import (cloud_scores, depth_maps, depth_scans, depth_scores, links,
               processes, run_record, stereo_run)
from .methods import METHODS
from .processes import Failure


_DEPTH_SCANS = os.path.join(os.path.dirname(os.path.abspath(__file__)),
                            "depth_scans.py")


@dataclasses.dataclass
class Experiment:
    """What is compared on one set of photographs.

    Runs stand in OUT/NAME/METHOD-SEED. data has images/, sparse/ and gt_depth/
    or scans/, in the format of examples/room.
    """
    name: str
    data: str
    methods: list = dataclasses.field(default_factory=lambda: ["plain", "tapa"])
    seeds: list = dataclasses.field(default_factory=lambda: [0])
    # More options of patch_match_stereo, for all methods.
    options: list = dataclasses.field(default_factory=list)
    sources: int = 10
    every: int = 1
    # Those that tables show, in metres and in per cent of the depth. Scored are
    # those of depth_scores, too.
    tolerances: list = dataclasses.field(
        default_factory=lambda: [0.01, 0.02, 0.05, 0.1])
    relative_tolerances: list = dataclasses.field(default_factory=lambda: [1])
    # (name, path) of what others made: maps or a PLY.
    compare: list = dataclasses.field(default_factory=list)
    # Names of the photographs that pictures show.
    views: list = dataclasses.field(default_factory=list)

    def folder(self, out, *parts):
        return os.path.join(out, self.name, *parts)

    def shown_methods(self):
        return self.methods + [name for name in dict(self.compare)
                               if name not in self.methods]

    def shown_tolerances(self):
        """(value, unit) of each."""
        return ([(value, "m") for value in self.tolerances]
                + [(value, "%") for value in self.relative_tolerances])


def command_text(experiment):
    """What to type for this on a command line; DATA is the data sets' folder."""
    words = ["scripts/evaluate"]
    inside = os.path.basename(os.path.normpath(experiment.data))
    # Sets with the same photographs must not share a folder of results.
    words += ["examples/room" if inside == "room" else f"DATA/{inside}",
              "--out", "OUT" if inside == experiment.name
              else f"OUT/{experiment.name}"]
    for key in ("methods", "seeds", "sources", "every", "tolerances",
                "relative_tolerances"):
        value = getattr(experiment, key)
        if value != getattr(Experiment("", ""), key):
            values = value if isinstance(value, list) else [value]
            words += ["--" + key, ",".join(
                one if isinstance(one, str) else processes.number_text(one)
                for one in values)]
    return " ".join(words + (["--", *experiment.options]
                             if experiment.options else []))


def check(experiment):
    """Raises Failure if this cannot be run."""
    for part in ("images", "sparse"):
        if not os.path.isdir(os.path.join(experiment.data, part)):
            raise Failure(f"{experiment.data} has no folder {part}")
    if not (has_depth(experiment) or own_scans(experiment)):
        raise Failure(f"{experiment.data} has neither gt_depth/ nor a MeshLab "
                      "project in scans/, so that nothing can be scored")
    photographs = links.photographs(experiment.data, experiment.every)
    if len(photographs) < 2:
        raise Failure(f"{experiment.data}/images has fewer than two photographs "
                      "to use")
    truth = os.path.join(experiment.data, "gt_depth")
    if has_depth(experiment) and not any(
            depth_maps.find(truth, name) for name in photographs):
        stem = os.path.splitext(photographs[0])[0]
        raise Failure(f"{truth} has no depth of any photograph that takes part, "
                      f"such as {stem}.png")
    for name, path in experiment.compare:
        check_comparison(name, path)
    for view in experiment.views:
        if view not in photographs:
            raise Failure(f"{experiment.data}/images has no photograph {view} "
                          "that takes part")


def check_comparison(name, path):
    if name in METHODS or not re.fullmatch(r"[\w.+-]+", name):
        raise Failure(f"{name} cannot be compared under this name; choose "
                      "letters, digits and _.+-, and no method's name")
    if not os.path.exists(path):
        raise Failure(f"there is no {path} to compare with")
    if not os.path.isdir(path) and not path.lower().endswith(".ply"):
        raise Failure(f"{path} is neither a folder of depth maps nor a PLY")


def has_depth(experiment):
    return os.path.isdir(os.path.join(experiment.data, "gt_depth"))


def own_scans(experiment):
    """The MeshLab project of scans that comes with a set, "" if none does."""
    folder = os.path.join(experiment.data, "scans")
    projects = sorted(name for name in (
        os.listdir(folder) if os.path.isdir(folder) else [])
        if name.endswith(".mlp"))
    return os.path.join(folder, projects[0]) if projects else ""


def stereo_runs(experiment, out, bin_dir):
    """The runs of all methods and seeds."""
    return [stereo_run.Run(
        data=experiment.data, set=experiment.name, method=method, seed=seed,
        folder=experiment.folder(out, stereo_run.folder_name(method, seed)),
        options=list(experiment.options), sources=experiment.sources,
        every=experiment.every, bin_dir=bin_dir)
        for seed in experiment.seeds for method in experiment.methods]


class Scorer:
    """Scores what is in the folders of one set."""

    def __init__(self, experiment, out, bin_dir, evaluator=None):
        """evaluator: of points; None: points are not scored."""
        self._experiment = experiment
        self._out = out
        self._bin_dir = bin_dir
        self._evaluator = evaluator
        self._scans = None

    def score_depth(self, folder):
        if has_depth(self._experiment):
            depth_scores.score(
                folder, os.path.join(self._experiment.data, "gt_depth"),
                tolerances=sorted({*depth_scores.TOLERANCES,
                                   *self._experiment.tolerances}),
                relative_tolerances=sorted({
                    *depth_scores.RELATIVE_TOLERANCES,
                    *self._experiment.relative_tolerances}),
                bin_dir=self._bin_dir)

    def score_clouds(self, folder):
        if self._evaluator is None:
            return
        names = [name for name in stereo_run.FUSIONS
                 if os.path.exists(os.path.join(folder, name + ".ply"))]
        project, options = self._find_scans()
        cloud_scores.score(
            folder, names, project, self._evaluator,
            sorted({*cloud_scores.TOLERANCES, *self._experiment.tolerances}),
            options)

    def _find_scans(self):
        """The MeshLab project, and options of the evaluator that go with it."""
        if self._scans is None:
            own = own_scans(self._experiment)
            self._scans = (own, []) if own else self._make_scans()
        return self._scans

    def _make_scans(self):
        """What scanners at the cameras would have measured."""
        folder = self._experiment.folder(self._out, "scans")
        project = os.path.join(folder, "scan_alignment.mlp")
        if (not os.path.exists(project)
                or depth_scans.are_of_other_data(self._experiment.data, folder)):
            processes.say(f"{folder}: scans from measured depth ...")
            try:
                depth_scans.make_scans(self._experiment.data, folder)
            except ValueError as error:
                raise Failure(str(error)) from error
        return project, _beam_options(folder)


def _beam_options(folder):
    """Beams as wide as the pixels that scans were made from."""
    about = depth_scans.read_about(folder)
    return ["--beam_divergence_halfangle_deg",
            f"{about['beam_divergence_halfangle_deg']:.6g}"
            if about else "(as scans.json says)"]


def run(experiment, out, bin_dir, evaluator=None):
    """Does what is missing. What fails is recorded, and the others go on.

    Returns a list of (folder, message) of what failed. Raises Interrupted.
    """
    scorer = Scorer(experiment, out, bin_dir, evaluator)
    failures = []
    for one in stereo_runs(experiment, out, bin_dir):
        _attempt(failures, one.folder,
                 [("stereo", lambda one=one: stereo_run.complete(one)),
                  ("depth scores", lambda one=one: scorer.score_depth(one.folder)),
                  ("cloud scores",
                   lambda one=one: scorer.score_clouds(one.folder))])
    for name in dict(experiment.compare):
        folder = experiment.folder(out, stereo_run.folder_name(name, 0))
        paths = [path for other, path in experiment.compare if other == name]
        _attempt(failures, folder, [
            ("comparison",
             lambda: take_comparison(experiment, folder, name, paths)),
            ("depth scores", lambda: _has_maps(folder)
             and scorer.score_depth(folder)),
            ("cloud scores", lambda: scorer.score_clouds(folder))])
    return failures


def _attempt(failures, folder, steps):
    """Steps one after the other until one fails."""
    for step, function in steps:
        try:
            function()
        except processes.Interrupted:
            raise
        except Exception as error:  # pylint: disable=broad-except
            # Whatever it is, the hours of the others are not lost to it.
            text = processes.reason(error)
            processes.say(f"FAILED {folder}: {text}")
            failures.append((folder, text))
            if step != "stereo":  # That records it by itself.
                run_record.note_failure(folder, step, text)
            return
    run_record.note_failure(folder, "", None)


def _has_maps(folder):
    return os.path.isdir(os.path.join(folder, "stereo"))


def take_comparison(experiment, folder, name, paths):
    """Links what another tool made into a folder of results."""
    paths = [os.path.abspath(path) for path in paths]
    photographs = links.photographs(experiment.data, experiment.every)
    record = run_record.load(folder)
    if record is not None and "compare" not in record:
        raise Failure(f"{folder} has results of this program, which are no links "
                      "to another tool's; name another folder for results")
    if record is not None and record["compare"] != paths:
        shutil.rmtree(folder)  # Links and scores of something else.
    # The other tool may have made maps of fewer photographs since.
    shutil.rmtree(os.path.join(folder, "stereo"), ignore_errors=True)
    os.makedirs(folder, exist_ok=True)
    record = {"set": experiment.name, "method": name, "seed": 0, "options": [],
              "fusion_options": {}, "compare": paths, "done": [],
              "failed": None, "views": None, "image_size": None,
              "photographs": len(photographs), "made_with": {},
              "seconds": {}, "cpu_seconds": {}, "peak_memory_bytes": {}}
    for path in paths:
        if os.path.isdir(path):
            links.make_view_workspace(
                experiment.data, path, folder, photographs)
            record["views"], record["image_size"] = (
                stereo_run.describe_maps(folder))
        else:
            links.link(path, os.path.join(folder, "fused.ply"))
    run_record.save(folder, record)


def missing_commands(experiment, out, bin_dir, evaluator=None):
    """The commands that run() would execute for the methods, in order."""
    commands = []
    scans, options = own_scans(experiment), []
    if evaluator is not None and not scans:
        folder = experiment.folder(out, "scans")
        scans = os.path.join(folder, "scan_alignment.mlp")
        options = _beam_options(folder)
        if not os.path.exists(scans):
            commands.append([_DEPTH_SCANS, experiment.data, folder])
    for one in stereo_runs(experiment, out, bin_dir):
        commands += stereo_run.missing_commands(one)
        if has_depth(experiment) and depth_scores.load(one.folder) is None:
            commands.append(depth_scores.command(
                one.folder, os.path.join(experiment.data, "gt_depth"),
                one.path("depth_scores.json"), bin_dir=bin_dir))
        if evaluator is None or cloud_scores.load(one.folder):
            continue
        commands += [cloud_scores.command(evaluator, one.path(name + ".ply"),
                                          scans, options=options)
                     for name in one.fusions]
    return commands
