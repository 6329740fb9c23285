"""Methods that are compared on a set of photographs, and the jobs that this takes."""

import functools
import os
import re
import shutil
from typing import List, Optional, Tuple

import pydantic

from . import (cloud_scores, depth_maps, depth_scans, depth_scores, machine, processes, record,
               schemas, stereo_run, workspaces)
from .methods import METHODS, check_method
from .processes import Failure
from .schemas import Positive, Text
from .steps import Job, Step

Whole = pydantic.conint(strict=True, ge=0)
Count = pydantic.conint(strict=True, ge=1)
Tolerances = pydantic.conlist(Positive, min_items=1)


def methods_validator():
    """Of a model's key methods."""
    return pydantic.validator("methods", each_item=True, allow_reuse=True)(check_method)


class Settings(schemas.Model):
    """What is to be done on photographs, as a plan may say it."""

    class Config:
        extra = "forbid"

    # Has images/, sparse/ and gt_depth/ or scans/, in the format of examples/room; in a plan
    # also a scene of examples/ that is rendered first.
    data: Text
    methods: List[Text] = ["plain", "tapa"]
    seeds: pydantic.conlist(Whole, min_items=1) = [0]
    # More options of patch_match_stereo, for all methods.
    options: Optional[List[Text]] = []
    sources: Count = 10
    every: Count = 1
    # Those that tables show, in metres and in per cent of the depth. Scored are
    # those of depth_scores, too.
    tolerances: Tolerances = [0.01, 0.02, 0.05, 0.1]
    relative_tolerances: Tolerances = [1]
    # Names of the photographs that pictures show.
    views: List[Text] = []

    _methods_are_known = methods_validator()


class Experiment(Settings):
    """What is compared on one set of photographs. Runs stand in OUT/NAME/METHOD-SEED."""
    name: Text
    # (name, path) of what others made: maps or a PLY.
    compare: List[Tuple[Text, Text]] = []

    def folder(self, out, *parts):
        return os.path.join(out, self.name, *parts)

    def truth(self):
        return os.path.join(self.data, "gt_depth")

    def scans(self):
        """The MeshLab project of scans that comes with the photographs, "" if none does."""
        folder = os.path.join(self.data, "scans")
        projects = sorted(name for name in (os.listdir(folder) if os.path.isdir(folder) else [])
                          if name.endswith(".mlp"))
        return os.path.join(folder, projects[0]) if projects else ""

    def shown_methods(self):
        return list(dict.fromkeys([*self.methods, *dict(self.compare)]))

    def shown_tolerances(self):
        """(value, unit) of each."""
        return ([(value, "m") for value in self.tolerances]
                + [(value, "%") for value in self.relative_tolerances])


def command_text(experiment):
    """What to type for this on a command line; DATA is the data sets' folder."""
    inside = os.path.basename(os.path.normpath(experiment.data))
    # Sets with the same photographs must not share a folder of results.
    is_example = os.path.isfile(os.path.join(machine.ROOT, "examples", inside, "scene.pov"))
    words = ["scripts/evaluate", f"{'examples' if is_example else 'DATA'}/{inside}",
             "--out", "OUT" if inside == experiment.name else f"OUT/{experiment.name}"]
    for key in ("methods", "seeds", "sources", "every", "tolerances", "relative_tolerances"):
        value = getattr(experiment, key)
        if value != Experiment.__fields__[key].default:
            words += ["--" + key, processes.list_text(value if isinstance(value, list)
                                                      else [value])]
    return " ".join(words + (["--", *experiment.options] if experiment.options else []))


def check(experiment):
    """Raises Failure if this cannot be run."""
    data, truth = experiment.data, experiment.truth()
    for part in ("images", "sparse"):
        if not os.path.isdir(os.path.join(data, part)):
            raise Failure(f"{data} has no folder {part}")
    if not (os.path.isdir(truth) or experiment.scans()):
        raise Failure(f"{data} has neither gt_depth/ nor a MeshLab project in scans/, so that "
                      "nothing can be scored")
    photographs = workspaces.photographs(data, experiment.every)
    if len(photographs) < 2:
        raise Failure(f"{data}/images has fewer than two photographs to use")
    if os.path.isdir(truth) and not any(depth_maps.find(truth, name) for name in photographs):
        raise Failure(f"{truth} has no depth of any photograph that takes part, such as "
                      f"{os.path.splitext(photographs[0])[0]}.png")
    for name, path in experiment.compare:
        check_comparison(name, path)
    for view in experiment.views:
        if view not in photographs:
            raise Failure(f"{data}/images has no photograph {view} that takes part")


def check_comparison(name, path):
    if name in METHODS or not re.fullmatch(r"[\w.+-]+", name):
        raise Failure(f"{name} cannot be compared under this name; choose letters, digits and "
                      "_.+-, and no method's name")
    if not os.path.exists(path):
        raise Failure(f"there is no {path} to compare with")
    if not os.path.isdir(path) and not path.lower().endswith(".ply"):
        raise Failure(f"{path} is neither a folder of depth maps nor a PLY")


class MakeScans(Step):
    """What scanners at the cameras would have measured, in a folder."""
    name = "scans from measured depth"

    def __init__(self, data, folder):
        self._data = data
        self._folder = folder
        self.project = os.path.join(folder, "scan_alignment.mlp")

    def is_done(self):
        return (os.path.exists(self.project)
                and not depth_scans.are_of_other_data(self._data, self._folder))

    def commands(self):
        return [[os.path.join(machine.ROOT, "evaluation", "depth_scans.py"), self._data,
                 self._folder]]

    def run(self):
        depth_scans.make_scans(self._data, self._folder)

    def beam_options(self):
        """Of the evaluator: beams as wide as the pixels that scans were made from."""
        about = depth_scans.read_about(self._folder)
        return ["--beam_divergence_halfangle_deg",
                f"{about.beam_divergence_halfangle_deg:.6g}" if about
                else "(as scans.json says)"]


class LinkComparison(Step):
    """Links to what another tool made, in a folder of results."""
    name = "comparison"
    is_quick = True  # The other tool may have made other maps since.

    def __init__(self, experiment, folder, name, paths):
        self._experiment = experiment
        self._folder = folder
        self._method = name
        self._paths = [os.path.abspath(path) for path in paths]

    def commands(self):
        return [f"# {self._folder}: links to {path}" for path in self._paths]

    def run(self):
        photographs = workspaces.photographs(self._experiment.data, self._experiment.every)
        known = record.load(self._folder)
        if isinstance(known, record.RunRecord):
            raise Failure(f"{self._folder} has results of this program, which are no links to "
                          "another tool's; name another folder for results")
        if known is not None and known.compare != self._paths:
            shutil.rmtree(self._folder)  # Links and scores of something else.
        shutil.rmtree(os.path.join(self._folder, "stereo"), ignore_errors=True)
        os.makedirs(self._folder, exist_ok=True)
        content = record.empty(
            record.ComparisonRecord, set=self._experiment.name, method=self._method, seed=0,
            options=[], compare=self._paths, photographs=len(photographs))
        for path in self._paths:
            if os.path.isdir(path):
                workspaces.make_view_workspace(self._experiment.data, path, self._folder,
                                               photographs)
                content.views, content.image_size = stereo_run.describe_maps(self._folder)
            else:
                workspaces.link(path, os.path.join(self._folder, "fused.ply"))
        record.save(self._folder, content)


def jobs(experiment, out, bin_dir, evaluator=None):
    """All that is to be made in OUT/NAME. evaluator: of points; None: they are not scored."""
    planned = []
    scans, options = experiment.scans(), list
    if evaluator is not None and not scans:
        step = MakeScans(experiment.data, experiment.folder(out, "scans"))
        scans, options = step.project, step.beam_options
        planned.append(Job(experiment.folder(out, "scans"), [step]))

    def add(folder, steps, has_maps, clouds):
        if has_maps and os.path.isdir(experiment.truth()):
            steps.append(depth_scores.ScoreDepth(
                folder, experiment.truth(), experiment.tolerances,
                experiment.relative_tolerances))
        if evaluator is not None:
            steps += [cloud_scores.ScoreCloud(folder, name, scans, evaluator,
                                              experiment.tolerances, options) for name in clouds]
        planned.append(Job(folder, steps, functools.partial(record.note_failure, folder)))

    for seed in experiment.seeds:
        for method in experiment.methods:
            run = stereo_run.Run(
                data=experiment.data, set=experiment.name, method=method, seed=seed,
                folder=experiment.folder(out, stereo_run.folder_name(method, seed)),
                options=experiment.options, sources=experiment.sources, every=experiment.every,
                bin_dir=bin_dir)
            add(run.folder, run.steps(), True, run.fusions)
    for name in dict(experiment.compare):
        folder = experiment.folder(out, stereo_run.folder_name(name, 0))
        paths = [path for other, path in experiment.compare if other == name]
        add(folder, [LinkComparison(experiment, folder, name, paths)],
            any(map(os.path.isdir, paths)),
            [] if all(map(os.path.isdir, paths)) else ["fused"])
    return planned
