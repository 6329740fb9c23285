"""Computes dense stereo, and fusion, as jobs of a Slurm cluster.

    scripts/cluster WORKSPACE [--shares N] [--fuse PLY] [-- PatchMatchStereo options]

The workspace, this program and colmap have to be on storage that all nodes share, under the
same names. A job prepares the run; then each step (a pass over all views at one level) is an array
of jobs, of which each computes a share of the views, and which waits for the step before; an
ordinary run makes sure that all is there; the last jobs fuse and join all logs to WORKSPACE/cluster.log.
The maps are those of a run on one machine.
"""

import argparse
import os
import re
import shlex
import shutil
import sys

from .. import command_line, files, machine
from ..processes import Failure
from . import slurm
from .jobs import Jobs

_STEP = re.compile(r"Step (\d+) of \d+: .*, (\d+) views to compute")


def parse_arguments(words=None):
    parser = command_line.Parser(prog="scripts/cluster", description=__doc__,
                                 formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("workspace", help="dense workspace, as image_undistorter makes it")
    parser.add_argument("--shares", type=command_line.whole_number(1), default=10, metavar="N",
                        help="jobs to divide the views of each step among (default: %(default)s)")
    parser.add_argument("--attempts", type=command_line.whole_number(1), default=3, metavar="N",
                        help="how often a job may be run that fails (default: %(default)s)")
    parser.add_argument("--sbatch", type=shlex.split, default=[], metavar="OPTIONS",
                        help="options of sbatch for every job, in one word, as in "
                        "--sbatch='--partition=long --cpus-per-task=8 --mem=8G'")
    parser.add_argument("--fuse", metavar="PLY", help="file of points to fuse the maps to")
    parser.add_argument("--fusion_options", type=shlex.split, default=[], metavar="OPTIONS",
                        help="options of stereo_fusion, in one word")
    parser.add_argument("--wait", action="store_true", help="come back when the run has ended, "
                        "with the exit status 0 if it is complete")
    return parser.parse(sys.argv[1:] if words is None else words)


class Cluster:
    """One run: its jobs in the order in which they are submitted."""

    def __init__(self, arguments):
        self.arguments = arguments
        self.workspace = os.path.abspath(arguments.workspace)
        self.colmap = machine.find_program(os.path.abspath(machine.default_bin_dir()), "colmap")
        self.log = os.path.join(self.workspace, "cluster.log")
        self.submitted = []
        self.jobs = Jobs(os.path.join(self.workspace, "cluster"), arguments.attempts)

    def make_folder(self):
        """The folder of logs, which is there as long as jobs are."""
        try:
            os.mkdir(self.jobs.logs)
        except FileExistsError as error:
            raise Failure(f"{self.jobs.logs} is there: jobs of another run are under way, or were "
                          "cancelled; wait until they have ended, or remove it") from error
        except OSError as error:
            raise Failure(f"{self.jobs.logs} cannot be made: {error.strerror}") from error

    def stereo(self, *options):
        return [self.colmap, "patch_match_stereo", "--workspace_path", self.workspace,
                *self.arguments.options, *options]

    def prepare(self):
        """Returns the steps that have something to compute: number, and number of views."""
        script = self.jobs.run("00-prepare", self.stereo("--PatchMatchStereo.step", "0"),
                               attempts=1)
        status = slurm.submit_and_wait(script, "prepare", self.jobs.output,
                                       *self.arguments.sbatch)
        lines = self.read_log("00-prepare")
        if status != 0:
            raise Failure(_last_error(lines) or f"the job that prepares the run has ended with "
                          f"status {status}; scripts/cluster --help says what it needs")
        steps = [tuple(map(int, match.groups())) for match in map(_STEP.match, lines) if match]
        if not steps:
            raise Failure(f"the job that prepares the run says of no steps; see {self.jobs.logs}")
        return [(step, num_views) for step, num_views in steps if num_views > 0]

    def read_log(self, name):
        path = self.jobs.log_of(name)
        if not os.path.exists(path):
            path = self.jobs.output
        if not os.path.exists(path):
            return []
        return files.read_bytes(path).decode("utf-8", errors="surrogateescape").splitlines()

    def submit(self, steps):
        """Returns the number of the last job before the one that joins the logs."""
        last = None
        for step, num_views in steps:
            num_shares = min(self.arguments.shares, num_views)
            script = self.jobs.run(f"{step:02}-step", self.stereo(
                "--PatchMatchStereo.step", str(step)), share_of=num_shares)
            last = self.submit_one(script, f"step{step}", last, f"--array=1-{num_shares}")
            print(f"Step {step}: {num_views} views in {num_shares} shares, job {last}")
        script = self.jobs.run("98-finish", self.stereo(), is_last=not self.arguments.fuse)
        last = self.submit_one(script, "finish", last)
        if self.arguments.fuse:
            script = self.jobs.run("99-fuse", [
                self.colmap, "stereo_fusion", "--workspace_path", self.workspace, "--output_path",
                os.path.abspath(self.arguments.fuse), *self.arguments.fusion_options],
                is_last=True)
            last = self.submit_one(script, "fuse", last)
        return last

    def submit_one(self, script, name, after, *options):
        self.submitted.append(slurm.submit(
            script, name, self.jobs.output, *options, *self.arguments.sbatch, after_ok=after))
        return self.submitted[-1]

    def cancel(self):
        """Leaves no job behind of a run that was stopped or cannot be submitted."""
        slurm.cancel(self.submitted)
        shutil.rmtree(self.jobs.logs, ignore_errors=True)

    def end(self, last):
        """Joins the logs when all has ended. Returns the exit status."""
        script = self.jobs.join(self.log)
        # Not in the folder that it removes.
        where = ["join", "/dev/null"]
        if not self.arguments.wait:
            slurm.submit(script, *where, *self.arguments.sbatch, after_any=last)
            print(f"All jobs are submitted; squeue shows them. In the end {self.log} has the "
                  "log of all.")
            return 0
        status = slurm.submit_and_wait(script, *where, *self.arguments.sbatch, after_any=last)
        if status != 0:
            raise Failure(f"the run has failed; {self.log} says why, and the same command goes on "
                          "from there")
        print(f"The run is complete; its log is {self.log}.")
        return 0


def _last_error(lines):
    errors = [line for line in lines if line.startswith("ERROR: ")]
    return errors[-1].removeprefix("ERROR: ") if errors else ""


def main():
    arguments = parse_arguments()
    slurm.check()
    cluster = Cluster(arguments)
    cluster.make_folder()
    try:
        return cluster.end(cluster.submit(cluster.prepare()))
    except BaseException:
        cluster.cancel()
        raise
