"""The programs that are disturbed, each on a tiny workspace."""

import os
import shutil
import signal
import subprocess
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..",
                                "end_to_end"))
import tiny_workspace as tiny  # noqa: E402

import snapshots  # noqa: E402

NAMES = ["view0.png", "view1.png", "view2.png"]
# Every step of stereo, in little time.
STEREO = {"num_iterations": 1, "window_radius": 3, "num_samples": 5,
          "num_levels": 2, "write_consistency_graph": 1, "num_threads": 2}
# More threads of OpenMP than processors wait for each other most of the time.
ENVIRONMENT = {**os.environ, "OMP_NUM_THREADS": "1", "LC_ALL": "C.UTF-8"}


def _options(group, values):
    return [word for name, value in values.items()
            for word in (f"--{group}.{name}", str(value))]


def stereo_command(**options):
    return [tiny.COLMAP, "patch_match_stereo", "--workspace_path", ".",
            *_options("PatchMatchStereo", {**STEREO, **options})]


def fusion_command(**options):
    return [tiny.COLMAP, "stereo_fusion", "--workspace_path", ".",
            "--output_path", "fused.ply", *_options("StereoFusion", options)]


def automatic_command():
    # Poisson's mesher makes another mesh every time.
    return [tiny.COLMAP, "automatic_reconstructor", "--image_path", "photos",
            "--workspace_path", ".", "--quality", "low", "--use_gpu", "0",
            "--num_threads", "1", "--mesher", "delaunay"]


def start(command, folder, environment=None, **options):
    """Starts a command in a folder, which it names by relative paths only, so that its
    files are the same in any."""
    return subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            env={**ENVIRONMENT, **(environment or {})},
                            text=True, errors="replace", **options)


def run(command, folder, environment=None, **options):
    """Returns the exit status, negative: of a signal, and all output."""
    process = start(command, folder, environment, **options)
    output, _ = process.communicate(timeout=300)
    return process.returncode, output


def copy(source, target):
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(source, target)


class Program:
    """A command, the folder that it starts from, and what it makes of it."""

    def __init__(self, name, command, prepare):
        self.name = name
        self.command = command
        self._prepare = prepare

    def measure(self, folder):
        """Runs it undisturbed; all else happens in folders below."""
        self.folder = os.path.join(folder, self.name)
        self.origin = os.path.join(self.folder, "origin")
        shutil.rmtree(self.folder, ignore_errors=True)
        self._prepare(self.origin)
        self.start = snapshots.take(self.origin)
        work = self.fresh()
        begin = time.monotonic()
        status, output = run(self.command, work)
        # Of the whole run, starting it and all.
        self.duration = time.monotonic() - begin
        if status != 0:
            sys.exit(f"ERROR: {self.name} fails without being disturbed:\n{output}")
        self.expected = snapshots.take(work)
        faults = snapshots.faults_at_names(work, self.start, self.expected)
        again = self.fresh()
        run(self.command, again)
        faults += snapshots.faults_at_end(again, self.expected)
        if faults:
            sys.exit(f"ERROR: two undisturbed runs of {self.name} differ: {faults}")

    def fresh(self, name="work"):
        """A folder to run in."""
        folder = os.path.join(self.folder, name)
        copy(self.origin, folder)
        return folder


def _prepare_stereo(folder):
    tiny.make_workspace(folder, names=NAMES)


def _prepare_fusion(folder):
    _prepare_stereo(folder)
    status, output = run(stereo_command(write_consistency_graph=0), folder)
    assert status == 0, output


def _prepare_automatic(folder):
    tiny.make_images(os.path.join(folder, "photos"), NAMES)
    tiny.make_model(os.path.join(folder, "sparse", "0"), NAMES)


def all_programs():
    return [
        Program("stereo", stereo_command(), _prepare_stereo),
        Program("tapa", stereo_command(tapa=1), _prepare_stereo),
        Program("fusion", fusion_command(), _prepare_fusion),
        # Its points depend on which of its threads is faster.
        Program("colmap_fusion",
                fusion_command(agreement=0, min_num_pixels=3, num_threads=1),
                _prepare_fusion),
        Program("automatic", automatic_command(), _prepare_automatic),
    ]
