"""One run: from photographs and poses to depth maps and points.

    run = Run(data, folder, "room", "tapa", seed=0)
    steps.perform([steps.Job(folder, run.steps())])

The folder becomes a COLMAP workspace (scripts/make_workspace.sh). Where there are maps
without a record, the run goes on from them. record.json says how the results were made.
"""

import dataclasses
import glob
import os

import numpy as np

from . import files, machine, point_clouds, processes, record
from .methods import FUSION_AGREEMENT, FUSION_COLMAP, FUSION_HIGH, METHODS
from .processes import Failure
from .steps import Step

_NO_POINTS = "No points could be fused"  # As stereo_fusion says it.
# Options of stereo_fusion by the name of the cloud, FOLDER/NAME.ply.
FUSIONS = {"fused": FUSION_HIGH, "fused_default": FUSION_COLMAP,
           "fused_agreement": FUSION_AGREEMENT}


def folder_name(method, seed):
    return f"{method}-{seed}"


def size_options(image_size):
    """Options that limit photographs to so many pixels; None: full size."""
    return ["--PatchMatchStereo.max_image_size", str(image_size)] if image_size else []


def all_options(method, seed, options):
    """Options of patch_match_stereo with those of the method and the seed.

    Those given in options take the place of the method's.
    """
    given = {word.partition("=")[0] for word in options}
    own = ["--PatchMatchStereo.seed", str(seed), *METHODS[method]]
    return [word for name, value in zip(own[::2], own[1::2]) if name not in given
            for word in (name, value)] + list(options)


def is_record_of(content, options, sources, every):
    """Whether a record is of a run with these settings."""
    return (content.method in METHODS
            and content.options == all_options(content.method, content.seed, options)
            and (content.sources, content.every) == (sources, every))


@dataclasses.dataclass
class Run:
    """What to run. data has images/ and sparse/, undistorted."""
    data: str
    folder: str
    set: str
    method: str
    seed: int = 0
    # More options of patch_match_stereo.
    options: list = dataclasses.field(default_factory=list)
    fusions: dict = dataclasses.field(default_factory=lambda: dict(FUSIONS))
    sources: int = 10
    every: int = 1
    bin_dir: str = dataclasses.field(default_factory=machine.default_bin_dir)

    def path(self, *parts):
        return os.path.join(self.folder, *parts)

    def colmap(self, command, *options):
        return [os.path.join(self.bin_dir, "colmap"), command, "--workspace_path", self.folder,
                *options]

    def steps(self):
        return [Stereo(self), *(Fusion(self, name) for name in self.fusions)]

    def is_complete(self):
        """Whether all steps were done, with these options or others."""
        content = record.load(self.folder)
        return content is not None and {"stereo", *self.fusions} <= set(content.done)

    def load_record(self):
        """The record, None where there is none.

        Raises Failure if it is of other options, which are not to be mixed with these.
        """
        content = record.load(self.folder)
        if content is None:
            return None
        if isinstance(content, record.ComparisonRecord):
            raise Failure(f"{self.folder} has results of another tool; remove it or name "
                          "another folder for results")
        for key, value in (("options", all_options(self.method, self.seed, self.options)),
                           ("sources", self.sources), ("every", self.every)):
            known = getattr(content, key)
            if known != value:
                if isinstance(value, list):
                    known, value = " ".join(known), " ".join(value)
                raise Failure(f"{self.folder} was made with {key} {known}, not {value}; "
                              "remove it or name another folder for results")
        return content

    def new_record(self):
        """That of a run which begins, or goes on from what was there before."""
        content = record.empty(
            record.RunRecord, set=self.set, method=self.method, seed=self.seed,
            options=all_options(self.method, self.seed, self.options), sources=self.sources,
            every=self.every)
        if _map_paths(self.folder):
            content.set_unknown("stereo")
        for name in self.fusions:
            if os.path.exists(self.path(name + ".ply")):
                content.set_unknown(name)
                content.fusion_options[name] = None
        return content

    def execute(self, content, step, command, log):
        """Runs a program, and adds to the record with what and what it took."""
        log = self.path(log)

        def end_part(usage):
            content.set_usage(step, None if None in (known, usage) else known + usage)
            content.end_part(step, machine.gpus_in(processes.last_output(log)))
            record.save(self.folder, content)

        # Should this process be killed, the time of this part is not known.
        known = content.usage(step)
        end_part(None)  # The one before may have been killed.
        content.begin_part(step, machine.program_version(self.bin_dir), machine.describe())
        record.save(self.folder, content)
        try:
            end_part(processes.run(command, log))
        except (processes.ProgramFailed, processes.Interrupted) as stop:
            end_part(stop.usage)
            raise

    def finish(self, content, step):
        content.failed = None
        if step not in content.done:
            content.done.append(step)
        record.save(self.folder, content)


class Stereo(Step):
    """The depth and normal maps of a run, in its workspace."""
    name = "stereo"

    def __init__(self, run):
        self._run = run

    def is_done(self):
        content = self._run.load_record()
        return content is not None and "stereo" in content.done

    def commands(self):
        run = self._run
        return [[os.path.join(machine.ROOT, "scripts", "make_workspace.sh"), run.data,
                 run.folder, str(run.sources), str(run.every)],
                run.colmap("patch_match_stereo",
                           *all_options(run.method, run.seed, run.options))]

    def run(self):
        run = self._run
        machine.find_program(run.bin_dir, "colmap")
        content = run.load_record() or run.new_record()
        make_workspace, stereo = self.commands()
        self._make_workspace(make_workspace, content)
        before = files.fingerprint(run.path("stereo", "depth_maps"))
        run.execute(content, "stereo", stereo, "stereo.log")
        if files.fingerprint(run.path("stereo", "depth_maps")) != before:
            self._remove_clouds()
        content.views, content.image_size = describe_maps(run.folder)
        run.finish(content, "stereo")

    def _make_workspace(self, command, content):
        """Refuses to mix maps of other photographs with those of this run."""
        run = self._run
        config = run.path("stereo", "patch-match.cfg")
        before = _content(config) if _map_paths(run.folder) else None
        try:
            processes.run(command, run.path("workspace.log"))
        finally:
            record.save(run.folder, content)  # For what failed to be noted in it.
        if before is not None and _content(config) != before:
            files.write_text(config, before)
            raise Failure(
                f"{run.folder} has maps of other photographs or sources than sources "
                f"{run.sources}, every {run.every} gives; remove it or name another folder for "
                "results")

    def _remove_clouds(self):
        """Clouds of maps that are no more, as of a run whose record was lost."""
        for name in self._run.fusions:
            for end in (".ply", ".ply.vis"):
                if os.path.exists(self._run.path(name + end)):
                    os.remove(self._run.path(name + end))


class Fusion(Step):
    """One cloud of a run. It is fused into FOLDER/NAME.new.ply, and renamed when complete."""

    def __init__(self, run, name):
        self._run = run
        self._cloud = name
        self.name = name + ".ply"

    def is_done(self):
        """Refuses points that were fused with other options."""
        run, content = self._run, self._run.load_record()
        is_there = os.path.exists(run.path(self.name))
        options = run.fusions[self._cloud]
        known = content and content.fusion_options.get(self._cloud)
        if is_there and known is not None and known != options:
            known, options = (" ".join(words) or "none" for words in (known, options))
            raise Failure(f"{run.path(self.name)} was made with the fusion options {known}, not "
                          f"{options}; remove it to make it anew")
        return is_there and content is not None and self._cloud in content.done

    def commands(self):
        run = self._run
        if os.path.exists(run.path(self.name)):
            return []  # It was there before, and is only noted.
        return [run.colmap("stereo_fusion", "--output_path", run.path(self._cloud + ".new.ply"),
                           *run.fusions[self._cloud])]

    def run(self):
        run, content = self._run, self._run.load_record()
        machine.find_program(run.bin_dir, "colmap")
        for command in self.commands():
            content.forget(self._cloud)
            content.fusion_options[self._cloud] = run.fusions[self._cloud]
            try:
                run.execute(content, self._cloud, command, "fusion.log")
            except processes.ProgramFailed as error:
                if _NO_POINTS not in str(error):
                    raise
                # That is a result here, and has a score.
                point_clouds.write_ply(run.path(self._cloud + ".new.ply"),
                                       np.empty((0, 3), np.float32), np.empty((0, 3), np.uint8))
            for end in (".ply.vis", ".ply"):
                new = run.path(self._cloud + ".new" + end)
                if os.path.exists(new):
                    os.replace(new, run.path(self._cloud + end))
        run.finish(content, self._cloud)


def _content(path):
    try:
        with open(path, encoding="utf-8") as file:
            return file.read()
    except FileNotFoundError:
        return None


def _map_paths(folder):
    return sorted(glob.glob(os.path.join(glob.escape(folder), "stereo", "depth_maps", "**",
                                         "*.geometric.bin"), recursive=True))


def describe_maps(folder):
    """Number of depth maps, and [width, height] of the first one."""
    paths = _map_paths(folder)
    if not paths:
        return 0, None
    with open(paths[0], "rb") as file:
        header = file.read(64).split(b"&")
    return len(paths), [int(header[0]), int(header[1])]
