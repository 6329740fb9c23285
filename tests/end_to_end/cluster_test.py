"""scripts/cluster on a Slurm of two nodes, which it starts for itself (small_slurm.py)."""

import os
import signal
import subprocess
import time
import unittest

import small_slurm
import tiny_workspace as tiny

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scripts/cluster")
OPTIONS = {**tiny.FAST, "num_levels": 2}
# Runs the real program, after something else in the one job of the first attempt of which
# the words have this in them.
WRAPPER = """#!/bin/sh
case "$*" in *"step {step} "*"share {share}"*)
  if mkdir {marker} 2>/dev/null; then
    echo "$SLURMD_NODENAME" >{marker}/node
    {then}
  fi ;;
esac
exec {colmap} "$@"
"""


@unittest.skipIf(small_slurm.what_is_missing(), small_slurm.what_is_missing())
class ClusterTest(tiny.TestCase):

    def setUp(self):
        super().setUp()
        os.mkdir(self.path("slurm"))
        self.slurm = small_slurm.SmallSlurm(self.path("slurm"))
        self.addCleanup(self.slurm.stop)
        self.slurm.start()
        self.workspace = self.path("workspace")
        self.names = tiny.make_workspace(self.workspace, num_views=4)
        self.bin_dir = os.path.dirname(os.path.abspath(tiny.COLMAP))

    def wrap(self, then, step=2, share="1/2"):
        """Has one job do something before the program starts; returns the marker of that."""
        self.bin_dir = self.path("bin")
        os.makedirs(self.bin_dir, exist_ok=True)
        marker = self.path("marker")
        with open(self.path("bin", "colmap"), "w") as file:
            file.write(WRAPPER.format(step=step, share=share, marker=marker, then=then,
                                      colmap=os.path.abspath(tiny.COLMAP)))
        os.chmod(self.path("bin", "colmap"), 0o755)
        return marker

    def start(self, *arguments, **options):
        words = [SCRIPT, self.workspace, "--shares", "2", "--wait", *arguments, "--"]
        for name, value in {**OPTIONS, **options}.items():
            words += ["--PatchMatchStereo." + name, str(value)]
        return subprocess.Popen(
            words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            text=True, env={**self.slurm.environment, "TAPA_BIN_DIR": self.bin_dir})

    def run_script(self, *arguments, **options):
        process = self.start(*arguments, **options)
        output, _ = process.communicate(timeout=600)
        return subprocess.CompletedProcess([], process.returncode, output)

    def log(self):
        with open(os.path.join(self.workspace, "cluster.log")) as file:
            return file.read()

    def assert_complete(self, result, **options):
        """The files are those of a run by one program."""
        self.assert_success(result)
        self.assertIn("# The run is complete.", self.log())
        self.assertFalse(os.path.exists(os.path.join(self.workspace, "cluster")))
        single = self.path("single")
        tiny.make_workspace(single, num_views=4)
        self.assert_success(tiny.run_stereo(single, **{**OPTIONS, **options}))
        self.assert_same_files(tiny.snapshot(single), tiny.snapshot(self.workspace))
        return single

    def test_same_files(self):
        result = self.run_script("--fuse", self.path("cluster.ply"),
                                 "--fusion_options=--StereoFusion.agreement_num_views 3")
        single = self.assert_complete(result)
        self.assert_success(tiny.run([
            tiny.COLMAP, "stereo_fusion", "--workspace_path", single, "--output_path",
            self.path("single.ply"), "--StereoFusion.agreement_num_views", "3"]))
        for end in ("", ".vis"):
            with open(self.path("cluster.ply" + end), "rb") as file:
                with open(self.path("single.ply" + end), "rb") as other:
                    self.assertEqual(file.read(), other.read())
        # Both nodes have computed, every share once.
        for node in small_slurm.NODES:
            self.assertIn(", on %s," % node, self.log())
        self.assertEqual(self.log().count("ended with status 0"), 1 + 4 * 2 + 2)
        # Started again it finds nothing to do.
        result = self.run_script()
        self.assert_success(result)
        self.assertNotIn("Step", result.stdout)

    def test_job_that_fails_once(self):
        self.wrap('echo "ERROR: This node has no luck."; exit 1')
        self.assert_complete(self.run_script())
        self.assertEqual(self.log().count("ERROR: This node has no luck."), 1)
        self.assertIn("02-step, job", self.log())
        self.assertIn("share 000001, attempt 2, ended with status 0", self.log())

    def test_job_that_fails_always(self):
        self.wrap('rmdir {0} 2>/dev/null || rm -r {0}; echo "ERROR: No luck at all."; exit 1'
                  .format(self.path("marker")))
        result = self.run_script("--attempts", "2")
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn("ERROR: the run has failed", result.stdout)
        self.assertEqual(self.log().count("ERROR: No luck at all."), 2)
        self.assertNotIn("03-step", self.log())
        self.assertNotIn("run is complete", self.log())
        # Where it does not fail any more the same command goes on.
        self.bin_dir = os.path.dirname(os.path.abspath(tiny.COLMAP))
        result = self.run_script("--attempts", "2")
        self.assertNotIn("Step 1:", result.stdout)
        self.assert_complete(result)

    def test_node_is_killed(self):
        # Some seconds of computing.
        options = {"num_iterations": 60, "num_samples": 15}
        marker = self.wrap(":", step=1, share="2/2")
        process = self.start(**options)
        self.addCleanup(process.kill)
        while not os.path.exists(os.path.join(marker, "node")):
            self.assertIsNone(process.poll(), "the job did not run")
            time.sleep(0.05)
        time.sleep(0.5)
        with open(os.path.join(marker, "node")) as file:
            node = file.read().strip()
        self.slurm.kill_node(node)
        output, _ = process.communicate(timeout=600)
        self.assert_complete(subprocess.CompletedProcess([], process.returncode, output),
                             **options)
        other, = set(small_slurm.NODES) - {node}
        self.assertRegex(self.log(), "01-step, job [0-9]+, share 000002, attempt 2, on %s"
                         % other)

    def test_stopped_while_it_waits(self):
        """No job is left, and what is done is kept."""
        marker = self.wrap("sleep 60", step=2)
        process = self.start()
        self.addCleanup(process.kill)
        while not os.path.exists(marker):
            self.assertIsNone(process.poll(), "the job did not run")
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        output, _ = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 130, output)
        self.assertFalse(os.path.exists(os.path.join(self.workspace, "cluster")))
        while self.slurm.run("squeue", "-h").strip():
            time.sleep(0.2)
        result = self.run_script()
        self.assertNotIn("Step 1:", result.stdout)
        self.assert_complete(result)

    def test_what_cannot_be_prepared(self):
        result = self.run_script(num_samples=0)
        self.assert_one_error(result, "num_samples")
        self.assertFalse(os.path.exists(os.path.join(self.workspace, "cluster")))
        # There is no such partition, which Slurm says at the first job.
        result = self.run_script("--sbatch=--partition=nowhere")
        self.assert_one_error(result, "sbatch refuses")
        self.assertFalse(os.path.exists(os.path.join(self.workspace, "cluster")))
        os.mkdir(os.path.join(self.workspace, "cluster"))
        self.assert_one_error(self.run_script(), "jobs of another run are under way")


if __name__ == "__main__":
    unittest.main()
