"""A run in parts, as on several machines, ends with the files of a single one."""

import os
import re
import shutil
import signal
import subprocess
import time
import unittest

import tiny_workspace as tiny

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scripts/cluster")
# Two levels, so that steps have a folder to hand on and to remove.
OPTIONS = {"num_levels": 2}


class PartsTest(tiny.TestCase):

    def setUp(self):
        super().setUp()
        self.names = tiny.make_workspace(self.folder, num_views=5)

    def part(self, step, share="1/1", **options):
        return tiny.run_stereo(self.folder, step=step, share=share, **{**OPTIONS, **options})

    def prepare(self, **options):
        """Returns the number of steps."""
        result = self.part(0, **options)
        self.assert_success(result)
        self.assertNotIn("megapixels in", result.stdout)
        return int(re.search(r"Step 1 of (\d+)", result.stdout)[1])

    def compute(self, steps, num_shares, **options):
        for step in steps:
            for share in range(1, num_shares + 1):
                self.assert_success(self.part(step, "%d/%d" % (share, num_shares), **options))

    def single_run(self, make=lambda path: tiny.make_workspace(path, num_views=5), **options):
        """Files of a run by one program, in a workspace of its own."""
        make(self.path("single"))
        self.assert_success(tiny.run_stereo(self.path("single"), **{**OPTIONS, **options}))
        return tiny.snapshot(self.path("single"))

    def assert_finished(self, expected, **options):
        """An ordinary run finds nothing to do and tidies up."""
        result = tiny.run_stereo(self.folder, **{**OPTIONS, **options})
        self.assert_success(result)
        self.assertNotIn("megapixels in", result.stdout)
        self.assertIn("there is nothing to do", result.stdout)
        self.assert_same_files(expected, tiny.snapshot(self.folder))

    def test_same_files(self):
        for options in ({}, {"tapa": 1}, {"geom_consistency": 0},
                        {"write_consistency_graph": 1},
                        {"tapa": 1, "write_consistency_graph": 1}):
            with self.subTest(options=options):
                shutil.rmtree(self.path("stereo"))
                tiny.make_config(self.folder, self.names)
                shutil.rmtree(self.path("single"), True)
                num_steps = self.prepare(**options)
                self.assertEqual(num_steps, 2 if "geom_consistency" in options else
                                 5 if "tapa" in options else 4)
                self.compute(range(1, num_steps + 1), 2, **options)
                self.assert_finished(self.single_run(**options), **options)

    def test_more_shares_than_views(self):
        num_steps = self.prepare()
        self.compute(range(1, num_steps + 1), 7)
        self.assert_finished(self.single_run())

    def test_drafts_without_the_graphs_that_the_last_step_needs(self):
        num_steps = self.prepare(tapa=1)
        self.compute(range(1, num_steps), 2, tapa=1)
        result = self.part(num_steps, tapa=1, write_consistency_graph=1)
        self.assert_one_error(result, "consistency_graphs", "step before")

    def test_sources_that_are_not_listed_with_tapa(self):
        """They have no drafts either."""
        def make(path):
            tiny.make_workspace(path, num_views=5)
            tiny.make_config(path, self.names[:2])
        tiny.make_config(self.folder, self.names[:2])
        num_steps = self.prepare(tapa=1)
        self.compute(range(1, num_steps + 1), 3, tapa=1)
        self.assert_finished(self.single_run(make, tapa=1), tapa=1)

    def test_sources_that_are_not_listed(self):
        """They have no result, but photometric maps."""
        def make(path):
            tiny.make_workspace(path, num_views=5)
            tiny.make_config(path, self.names[:2])
        tiny.make_config(self.folder, self.names[:2])
        num_steps = self.prepare()
        self.compute(range(1, num_steps + 1), 3)
        self.assert_finished(self.single_run(make))

    def test_each_view_once(self):
        num_steps = self.prepare()
        for step in range(1, num_steps + 1):
            views = []
            for share in ("1/3", "2/3", "3/3"):
                result = self.part(step, share)
                self.assert_success(result)
                views += re.findall(r"\d+/5 (\S+): [\d.]+ megapixels in", result.stdout)
            self.assertEqual(sorted(views), self.names)
            self.assertIn("0 views to compute", self.part(step, "1/3").stdout)

    def test_workers_side_by_side(self):
        expected = self.single_run()
        for step in range(1, self.prepare() + 1):
            workers = [subprocess.Popen(
                tiny.stereo_command(self.folder, step=step, share="%d/3" % share, **OPTIONS),
                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
                for share in (1, 2, 3)]
            for worker in workers:
                output, _ = worker.communicate()
                self.assertEqual(worker.returncode, 0, output)
        self.assert_finished(expected)

    def test_worker_is_killed_and_started_again(self):
        options = {"num_iterations": 6, "tapa": 1}
        expected = self.single_run(**options)
        num_steps = self.prepare(**options)
        for step in range(1, num_steps + 1):
            worker = subprocess.Popen(
                tiny.stereo_command(self.folder, step=step, share="1/2",
                                    **{**OPTIONS, **options}),
                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(0.2)
            worker.send_signal(signal.SIGKILL)
            worker.wait()
            self.compute([step], 2, **options)
        self.assert_finished(expected, **options)

    def test_ordinary_run_goes_on_from_any_part(self):
        expected = self.single_run()
        self.prepare()
        self.compute([1, 2], 2)
        self.compute([3], 1)
        self.assert_success(self.part(4, "2/2"))
        self.assert_success(tiny.run_stereo(self.folder, **OPTIONS))
        self.assert_same_files(expected, tiny.snapshot(self.folder))

    def test_parts_go_on_from_an_ordinary_run(self):
        expected = self.single_run()
        self.assert_success(tiny.run_stereo(self.folder, **OPTIONS))
        os.remove(tiny.map_path(self.folder, self.names[1]))
        os.remove(tiny.map_path(self.folder, self.names[2], which="photometric"))
        num_steps = self.prepare()
        self.compute(range(1, num_steps + 1), 2)
        self.assert_finished(expected)

    def test_only_workers_share_a_workspace(self):
        options = {"num_iterations": 1000, "window_radius": 15}
        self.prepare(**options)
        worker = subprocess.Popen(
            tiny.stereo_command(self.folder, step=1, share="1/2", **{**OPTIONS, **options}),
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.addCleanup(worker.communicate)
        self.addCleanup(worker.kill)
        for line in worker.stdout:
            if "views to compute" in line:
                break
        for step in (-1, 0):
            self.assert_one_error(self.part(step), "Another run is at work in")
        self.assertIsNone(worker.poll(), "it ended before the others began")

    def test_what_was_not_prepared(self):
        self.assert_one_error(self.part(1, "1/2"), "has not been prepared",
                              "PatchMatchStereo.step 0")
        num_steps = self.prepare()
        self.assert_one_error(self.part(1, "1/2", seed=7), "seed was 0, is 7",
                              "PatchMatchStereo.step 0")
        self.assert_one_error(self.part(2), "all shares of the step before")
        self.assert_one_error(self.part(num_steps + 1), "only the steps 1 to %d" % num_steps)
        tiny.write_mask(self.path("images", self.names[0]))
        self.assert_one_error(self.part(1), "was prepared from other photographs")
        self.assertEqual(
            [name for name in tiny.snapshot(self.folder) if name.endswith(".bin")], [])

    def test_shares_that_are_none(self):
        for share in ("0/2", "3/2", "1", "", "1/0", "a/b", "-1/2", "1/2/3", "1/9999999"):
            self.assert_one_error(self.part(1, share), "PatchMatchStereo.share", "2/10")
        self.assert_one_error(self.part(0, "1/2"), "PatchMatchStereo.step")
        self.assert_one_error(self.part(-1, "1/2"), "PatchMatchStereo.step")
        self.assert_one_error(self.part(-2), "PatchMatchStereo.step")


class WithoutSlurm(tiny.TestCase):

    def test_there_is_no_sbatch(self):
        names = tiny.make_workspace(self.folder)
        result = tiny.run([SCRIPT, self.folder],
                          env={**os.environ, "PATH": self.path("nothing")})
        self.assert_one_error(result, "there is no sbatch", "docs/usage.md")
        self.assertFalse(os.path.exists(tiny.map_path(self.folder, names[0])))


if __name__ == "__main__":
    unittest.main()
