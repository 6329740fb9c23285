"""Runs, their scores and records, with programs that only pretend."""

import functools
import glob
import os
import signal
import subprocess
import sys
import threading
import time
import unittest

import cv2
import numpy as np

from helpers import ROOT, TestCase, make_record, run_step, write_map
from evaluation import (cloud_scores, depth_scores, experiment, files, machine, processes, record,
                        steps, stereo_run, workspaces)
from evaluation.experiment import Experiment
from evaluation.processes import Failure

# Makes a depth map of 4x3 pixels for each photograph, a PLY, or fails if asked.
_COLMAP = r"""#!/bin/sh
echo "$@" >> "$(dirname "$0")/calls"
case "$1" in
help) echo "COLMAP 3.8 -- Structure"; echo "  (Commit 1234 without CUDA)"; exit ;;
patch_match_stereo)
  if [ -e "$(dirname "$0")/fail" ]; then
    echo "ERROR: no source images"; exit 1
  fi
  if [ -e "$(dirname "$0")/slow" ]; then
    trap 'exit 130' INT TERM; touch "$(dirname "$0")/started"
    while true; do sleep 0.05; done
  fi
  cat "$(dirname "$0")/says" 2>/dev/null
  for photo in "$3"/images/*; do
    printf '4&3&1&' > "$3/stereo/depth_maps/$(basename "$photo").geometric.bin"
    head -c 48 /dev/zero >> "$3/stereo/depth_maps/$(basename "$photo").geometric.bin"
  done ;;
stereo_fusion) echo ply > "$5"; echo vis > "$5.vis" ;;
esac
"""


def complete(run):
    """Does what is missing of a run. Returns the record; raises Failure."""
    failures = steps.perform([steps.Job(run.folder, run.steps(), functools.partial(
        record.note_failure, run.folder))])
    for _, message in failures:
        raise Failure(message)
    return record.load(run.folder)


class StereoRunTest(TestCase):
    def setUp(self):
        super().setUp()
        self.write("bin/colmap", _COLMAP, True)
        for name in "abcd":
            self.write(f"data/images/{name}.jpg")
        self.write("data/sparse/cameras.txt")
        self.run_ = self.run_of()

    def run_of(self, **values):
        return stereo_run.Run(**{
            "data": self.path("data"), "folder": self.path("out", "tapa-3"), "set": "data",
            "method": "tapa", "seed": 3, "options": ["--PatchMatchStereo.num_iterations", "1"],
            "bin_dir": self.path("bin"), **values})

    def calls(self, command):
        return [line for line in self.read("bin/calls").splitlines() if line.startswith(command)]

    def test_everything_is_done_once_and_recorded(self):
        run = self.run_
        self.assertFalse(run.is_complete())
        self.assertEqual(sum(len(step.commands()) for step in run.steps()), 5)
        self.assertFalse(os.path.exists(run.folder))
        content = complete(run)
        self.assertTrue(run.is_complete())
        self.assertEqual(content.done, ["stereo", *stereo_run.FUSIONS])
        self.assertEqual(content.options, ["--PatchMatchStereo.seed", "3",
                                           "--PatchMatchStereo.tapa", "1",
                                           "--PatchMatchStereo.num_iterations", "1"])
        self.assertEqual(content.fusion_options, stereo_run.FUSIONS)
        self.assertEqual((content.views, content.image_size), (4, [4, 3]))
        self.assertEqual(list(content.made_with), content.done)
        self.assertFalse(content.is_mixed())
        for step in content.done:
            (maker,) = content.made_with[step]
            self.assertTrue(maker.version.startswith("COLMAP 3.8 (Commit 1234 without CUDA)"),
                            maker.version)
            self.assertEqual(maker.machine, machine.describe())
            self.assertGreater(content.seconds[step], 0)
            self.assertGreater(content.peak_memory_bytes[step], 1e5)
        self.assertAlmostEqual(content.total_seconds(),
                               content.seconds["stereo"] + content.seconds["fused"])
        self.assertTrue(os.path.exists(run.path("fused.ply.vis")))
        self.assertEqual(glob.glob(run.path("*.new*")), [])
        self.assertIn("--StereoFusion.max_reproj_error 1 --StereoFusion.max_normal_error 20",
                      self.calls("stereo_fusion")[0])
        self.assertNotIn("max_reproj_error", self.calls("stereo_fusion")[1])
        # Again: nothing is left to do.
        complete(run)
        self.assertEqual(len(self.calls("patch_match_stereo")), 1)
        self.assertEqual(len(self.calls("stereo_fusion")), 3)
        # A cloud that is gone is made anew.
        os.remove(run.path("fused.ply"))
        self.assertEqual(complete(run).done, content.done)
        self.assertEqual(len(self.calls("stereo_fusion")), 4)

    def test_a_failure_is_recorded_and_forgotten_when_it_is_over(self):
        self.write("bin/fail")
        with self.assertRaisesRegex(Failure, "patch_match_stereo: no source"):
            complete(self.run_)
        content = record.load(self.run_.folder)
        self.assertEqual(content.failed.step, "stereo")
        self.assertIn("no source images", content.failed.message)
        before = content.seconds["stereo"]
        self.assertGreater(before, 0)
        os.remove(self.path("bin/fail"))
        content = complete(self.run_)
        self.assertIsNone(content.failed)
        self.assertGreater(content.seconds["stereo"], before)

    def test_other_settings_are_refused(self):
        complete(self.run_)
        for values, part in (({"options": []}, "options"), ({"every": 2}, "every"),
                             ({"sources": 3}, "sources")):
            with self.assertRaisesRegex(Failure, f"made with {part}"):
                complete(self.run_of(**values))
        record.save(self.run_.folder, make_record(compare=["x"], photographs=4))
        with self.assertRaisesRegex(Failure, "has results of another tool"):
            complete(self.run_)

    def test_points_of_other_thresholds_are_refused_until_they_are_removed(self):
        complete(self.run_)
        other = self.run_of(fusions={"fused": ["--StereoFusion.max_reproj_error", "3"]})
        with self.assertRaisesRegex(
                Failure, "fused.ply was made with the fusion options "
                ".*max_reproj_error 1 .*, not .*max_reproj_error 3; remove it"):
            complete(other)
        self.assertEqual(len(self.calls("stereo_fusion")), 3)
        os.remove(other.path("fused.ply"))
        self.assertEqual(complete(other).fusion_options, {**stereo_run.FUSIONS, **other.fusions})

    def test_times_of_a_finished_workspace_are_unknown(self):
        complete(self.run_)
        os.remove(self.run_.path("record.json"))
        os.remove(self.run_.path("fused_default.ply"))
        content = complete(self.run_)
        for value in (content.seconds["stereo"], content.cpu_seconds["fused"],
                      content.peak_memory_bytes["stereo"], content.total_seconds(),
                      # This program looked whether all maps were there.
                      content.made_with["stereo"][0]):
            self.assertIsNone(value)
        self.assertEqual(content.fusion_options, {**stereo_run.FUSIONS, "fused": None,
                                                  "fused_agreement": None})
        self.assertEqual(content.made_with["fused"], [None])
        self.assertTrue(content.is_mixed())
        self.assertGreater(content.seconds["fused_default"], 0)
        self.assertEqual(content.views, 4)

    def test_a_cloud_of_maps_that_are_no_more_is_made_anew(self):
        complete(self.run_)
        os.remove(self.run_.path("record.json"))
        os.remove(self.run_.path("stereo", "depth_maps", "a.jpg.geometric.bin"))
        self.write("out/tapa-3/fused.ply", "of other maps")
        complete(self.run_)
        self.assertEqual(self.read("out/tapa-3/fused.ply"), "ply\n")

    def test_maps_of_other_photographs_are_refused(self):
        complete(self.run_)
        os.remove(self.run_.path("record.json"))
        before = self.read("out/tapa-3/stereo/patch-match.cfg")
        with self.assertRaisesRegex(Failure, "maps of other photographs"):
            complete(self.run_of(every=2))
        self.assertEqual(self.read("out/tapa-3/stereo/patch-match.cfg"), before)

    def test_a_stop_is_handed_on_and_its_time_counts(self):
        self.write("bin/slow")

        def stop():
            while not os.path.exists(self.path("bin/started")):
                time.sleep(0.02)
            os.kill(os.getpid(), signal.SIGINT)

        thread = threading.Thread(target=stop)
        thread.start()
        with self.assertRaises(processes.Interrupted) as caught:
            complete(self.run_)
        thread.join()
        self.assertEqual(caught.exception.number, signal.SIGINT)
        before = record.load(self.run_.folder).seconds["stereo"]
        self.assertGreater(before, 0)
        os.remove(self.path("bin/slow"))
        self.assertGreater(complete(self.run_).seconds["stereo"], before)

    def test_time_of_a_part_that_was_killed_is_unknown(self):
        content = complete(self.run_)
        # As it stands while a program runs.
        content.done, content.seconds = [], {"stereo": None}
        record.save(self.run_.folder, content)
        self.assertIsNone(complete(self.run_).seconds["stereo"])

    def test_gpus_are_recorded_where_they_were_used(self):
        says = self.write("bin/says", "Computing on GPU 0 (A), 1 (B).\n")
        content = complete(self.run_)
        self.assertEqual(content.made_with["stereo"][0].machine.gpu, "A, B")
        self.assertIsNone(content.made_with["fused"][0].machine.gpu)
        # A run that was killed there, and went on upon the CPU.
        content.done = []
        content.made_with["stereo"][0].machine.gpu = None
        record.save(self.run_.folder, content)
        os.remove(says)
        content = complete(self.run_)
        self.assertEqual([maker.machine.gpu for maker in content.made_with["stereo"]],
                         ["A, B", None])
        self.assertEqual(content.stereo_gpus(), {"A, B", None})
        self.assertTrue(content.is_mixed())

    def test_a_run_that_goes_on_with_another_version_says_so(self):
        self.write("bin/fail")
        for _ in range(2):  # The same twice is one part.
            with self.assertRaises(Failure):
                complete(self.run_)
        os.remove(self.path("bin/fail"))
        self.write("bin/colmap", _COLMAP.replace("1234", "5678"), True)
        content = complete(self.run_)
        self.assertEqual([maker.version[19:23] for maker in content.made_with["stereo"]],
                         ["1234", "5678"])
        self.assertEqual(len(content.made_with["fused"]), 1)
        self.assertTrue(content.is_mixed())

    def test_missing_programs_and_broken_records(self):
        with self.assertRaisesRegex(Failure, "has no colmap; run scripts/build"):
            complete(self.run_of(bin_dir=self.path("none")))
        path = self.write("out/tapa-3/record.json", "{")
        with self.assertRaisesRegex(Failure, "record.json cannot be read"):
            complete(self.run_)
        os.remove(path)
        with self.assertRaisesRegex(Failure, "make_workspace.sh: .*no folder images"):
            complete(self.run_of(data=self.path("bin")))
        self.assertIn("no folder images", record.load(self.run_.folder).failed.message)


class ProcessesTest(TestCase):
    def test_what_a_program_takes(self):
        usage = processes.run(
            [sys.executable, "-c", "x = bytearray(50_000_000); sum(range(10**6))"],
            self.path("log"))
        self.assertGreater(usage.cpu_seconds, 0)
        self.assertGreater(usage.peak_memory_bytes, 50e6)

    def test_failures_are_one_line(self):
        for script, text in (
                ("echo x; echo 'ERROR: bad'; echo more; exit 3", "sh: bad "),
                ("echo some words; exit 1", "sh: some words "),
                ("kill -KILL $$", "sh was ended by SIGKILL")):
            with self.assertRaisesRegex(processes.ProgramFailed, f"^{text}.*$") as caught:
                processes.run(["sh", "-c", script], self.path("log"))
            self.assertGreater(caught.exception.usage.seconds, 0)
        with self.assertRaisesRegex(Failure, "cannot be started"):
            processes.run([self.path("none")], self.path("log"))

    def test_names_that_are_no_text(self):
        processes.run(["test", "-n", os.fsdecode(b"\xff \xc3\xa9")], self.path("log"))
        with open(self.path("log"), "rb") as file:
            self.assertIn(b"\xff", file.read())


class FilesTest(TestCase):
    def test_a_full_disk_leaves_what_was_there(self):
        path = self.write("page.md", "before")
        # A device that is always full stands in for the disk.
        os.symlink("/dev/full", path + ".new")
        with self.assertRaisesRegex(Failure, "page.md cannot be written: No space"):
            files.write_text(path, "after")
        self.assertEqual(self.read("page.md"), "before")
        self.assertEqual(os.listdir(self.folder), ["page.md"])
        with self.assertRaisesRegex(Failure, "x cannot be written: "):
            files.write_text(os.path.join(path, "x"), "text")

    def test_a_lock_keeps_others_out(self):
        folder = self.path("new")
        script = (f"import sys\nsys.path.insert(0, {ROOT!r})\nfrom evaluation import files\n"
                  f"files.lock({folder!r}, sys.argv[1])\n")

        def other(name):
            return subprocess.run([sys.executable, "-B", "-c", script, name], text=True,
                                  stderr=subprocess.PIPE, check=False).stderr

        with files.lock(folder, "run"):
            self.assertIn(f"Failure: another run is at work in {folder}; ", other("run"))
            self.assertEqual(other("report"), "")
        self.assertEqual(other("run"), "")
        with self.assertRaisesRegex(Failure, "x cannot be written: Not a dir"):
            files.lock(os.path.join(self.write("file"), "x"), "run")

    def test_fingerprints(self):
        self.write("a/b.bin", "x" * 100000)
        before = files.fingerprint(self.path("a"))
        self.assertEqual(files.fingerprint(self.path("a")), before)
        self.assertEqual(files.fingerprint(self.path("none")), "")
        for name, text in (("b.bin", "x" * 99999), ("b.bin", "x" * 99999 + "y"), ("c.bin", "")):
            self.write("a/" + name, text)
            self.assertNotEqual(files.fingerprint(self.path("a")), before)
            before = files.fingerprint(self.path("a"))


class CloudScoresTest(TestCase):
    TOLERANCES = cloud_scores.TOLERANCES

    def output(self, tolerances=None):
        """What an evaluator prints: half of everything is right, but all accurate at 0.5."""
        halves = "0.5 " * len(tolerances or self.TOLERANCES)
        return (f"Loading reconstruction: x\nTolerances: "
                f"{' '.join(f'{value:g}' for value in tolerances or self.TOLERANCES)}\n"
                f"Completenesses: {halves}\nAccuracies: {halves[:-2]}75\nF1-scores: {halves}\n")

    def evaluator(self, output=None, code=0):
        self.write("output", output or self.output())
        return self.write("evaluator", "#!/bin/sh\n"
                          f"echo \"$@\" >> '{self.path('calls')}'\n"
                          f"cat '{self.path('output')}'\nexit {code}\n", True)

    def score(self, evaluator, tolerances=(), options=(), scans="scans.mlp"):
        """Returns the calls of the evaluator so far."""
        run_step(cloud_scores.ScoreCloud(self.folder, "fused", scans, evaluator, tolerances,
                                         lambda: list(options)))
        return self.read("calls").splitlines()

    def test_scores_are_kept(self):
        evaluator = self.evaluator()
        for _ in range(2):
            calls = self.score(evaluator, options=["--voxel_size", "0.1"])
            score = cloud_scores.load(self.folder)["fused"]
            self.assertEqual(score.at(0.5), (0.5, 0.75, 0.5))
            self.assertIsNone(score.at(0.3))
        self.assertEqual(calls, [
            "--tolerances 0.01,0.02,0.05,0.1,0.2,0.5 --reconstruction_ply_path "
            f"{self.path('fused.ply')} --ground_truth_mlp_path scans.mlp --voxel_size 0.1"])
        # Another tolerance needs another run.
        with self.assertRaisesRegex(Failure, "other tolerances than asked"):
            self.score(evaluator, [0.3], ["--voxel_size", "0.1"])
        self.assertEqual(len(self.read("calls").splitlines()), 2)

    def test_tolerances_keep_all_their_digits(self):
        exact = sorted([*self.TOLERANCES, 0.012345678901234, 1 / 3])
        evaluator = self.evaluator(self.output(exact))
        for _ in range(2):  # The second time there is nothing to do.
            (call,) = self.score(evaluator, exact)
            self.assertEqual(cloud_scores.load(self.folder)["fused"].tolerances, exact)
        self.assertEqual([float(word) for word in call.split()[1].split(",")], exact)

    def test_scores_are_not_taken_for_those_of_something_else(self):
        evaluator = self.evaluator()
        scans = self.write("scans/scan_alignment.mlp", "poses")
        self.write("fused.ply", "points")

        def calls(program=evaluator, options=()):
            return len(self.score(program, (), options, scans))

        self.assertEqual((calls(), calls()), (1, 1))
        self.write("scans/scan1.ply", "a scan")
        self.assertEqual((calls(), calls()), (2, 2))
        other = self.write("theirs", f"#!/bin/sh\nexec '{evaluator}' \"$@\"", True)
        self.assertEqual((calls(other), calls(other)), (3, 3))
        self.assertEqual((calls(other, ["--a", "1"]), calls(other, ["--a", "1"])), (4, 4))
        # What is shown without scoring is not that of another cloud, either.
        self.write("fused.ply", "Points")
        self.assertEqual(cloud_scores.load(self.folder), {})
        self.assertEqual(calls(other, ["--a", "1"]), 5)
        os.remove(self.path("fused.ply"))  # For want of space.
        self.assertIn("fused", cloud_scores.load(self.folder))

    def test_output_that_is_no_score(self):
        whole = self.output()
        for output, code, text in (
                ("Tolerances: 0.01\n", 0, "no line Completenesses"),
                (whole.replace("0.5 0.75", "0.75"), 0, "different length"),
                (whole.replace("0.5 0.75", "x y"), 0, "no numbers behind Acc"),
                ("ERROR: no vertices in fused.ply\n", 1, "no vertices")):
            with self.assertRaisesRegex(Failure, text):
                self.score(self.evaluator(output, code))
        self.assertEqual(cloud_scores.load(self.folder), {})


class DepthScoresTest(TestCase):
    def setUp(self):
        super().setUp()
        self.write("images/a.jpg")
        photograph = np.random.default_rng(1).integers(0, 255, (2, 3), np.uint8)
        cv2.imwrite(self.path("images/a.jpg"), photograph)
        self.maps = self.path("stereo/depth_maps/a.jpg.geometric.bin")
        write_map(self.maps, np.full((2, 3), 2))
        write_map(self.path("gt/a.bin"), np.full((2, 3), 2.25))

    def step(self, tolerances=(), relative_tolerances=()):
        return depth_scores.ScoreDepth(self.folder, self.path("gt"), tolerances,
                                       relative_tolerances)

    def is_scored_again(self, *tolerances):
        """Of two attempts the second never scores."""
        step = self.step(*tolerances)
        before = step.is_done()
        run_step(step)
        self.assertTrue(self.step(*tolerances).is_done())
        return not before

    def test_scored_again_only_for_other_tolerances(self):
        self.assertTrue(self.is_scored_again())
        scores = depth_scores.load(self.folder)
        self.assertEqual((scores.overall.at(0.2).f1, scores.overall.at(0.5).f1), (0, 1))
        self.assertEqual(scores.overall.at(0.5, "%").f1, 0)
        self.assertIsNone(scores.overall.at(0.3, "m"))
        self.assertIsNone(scores.overall.at(5, "%"))
        self.assertIsNotNone(scores.below(0.75))
        self.assertIsNone(scores.below(0.77))
        self.assertIn("median", self.read("depth_scores.log").lower())
        self.assertTrue(self.is_scored_again([0.3]))
        self.assertTrue(self.is_scored_again([], [5]))

    def test_tolerances_keep_all_their_digits(self):
        (command,) = self.step([0.1234567], [1 / 3]).commands()
        self.assertEqual(command[6:9:2], ["0.01,0.02,0.05,0.1,0.1234567,0.2,0.5,1,2,5",
                                          "0.3333333333333333,0.5,1,2"])

    def test_scored_again_for_other_maps_and_other_measurements(self):
        self.assertTrue(self.is_scored_again())
        write_map(self.path("gt/a.bin"), np.full((2, 3), 2.5))
        self.assertTrue(self.is_scored_again())
        write_map(self.maps, np.full((2, 3), 2.5))
        self.assertIsNone(depth_scores.load(self.folder))
        self.assertTrue(self.is_scored_again())
        os.remove(self.maps)  # For want of space.
        self.assertIsNotNone(depth_scores.load(self.folder))
        self.assertFalse(self.is_scored_again())


class WorkspacesTest(TestCase):
    def test_maps_of_all_names(self):
        for name in ("b.jpg", "a.jpg", "rig/c.jpg"):
            self.write("data/images/" + name)
        data = self.path("data")
        # As in make_workspace.sh.
        names = workspaces.photographs(data)
        self.assertEqual(names, ["a.jpg", "b.jpg", "rig/c.jpg"])
        self.assertEqual(workspaces.photographs(data, 2), ["a.jpg", "rig/c.jpg"])
        for maps, file in (("w", "w/stereo/depth_maps/a.jpg.geometric.bin"),
                           ("p", "p/a.jpg.photometric.bin"), ("q", "q/rig/c.jpg.bin")):
            self.write(file, maps)
            out = self.path("out_" + maps)
            workspaces.make_view_workspace(data, self.path(maps), out, names)
            (linked,) = files.names_below(os.path.join(out, "stereo"))
            self.assertTrue(linked.endswith(".jpg.geometric.bin"))
            self.assertEqual(self.read(out, "stereo", linked), maps)
            self.assertTrue(os.path.exists(os.path.join(out, "images/rig/c.jpg")))
        with self.assertRaisesRegex(Failure, "no depth map of a.jpg"):
            workspaces.make_view_workspace(data, data, self.path("x"), names)


class StepsTest(TestCase):
    def test_whatever_fails_does_not_stop_the_others(self):
        ran, noted = [], []

        class Example(steps.Step):
            def __init__(self, name):
                self.name = name

            def run(self):
                ran.append(self.name)
                if self.name == "bad":
                    raise ValueError("two\nlines")

        failures = steps.perform(
            steps.Job(job, list(map(Example, names)), lambda *note: noted.append(note))
            for job, names in (("a", ["bad", "never"]), ("b", ["good", "fine"])))
        self.assertEqual(failures, [("a", "ValueError: two lines")])
        self.assertEqual(ran, ["bad", "good", "fine"])
        self.assertEqual(noted, [("bad", "ValueError: two lines"), (None, None)])


class PackageTest(unittest.TestCase):
    def test_python_packages_that_are_missing_are_named_at_once(self):
        script = ("import importlib.util, sys\nfind = importlib.util.find_spec\n"
                  "importlib.util.find_spec = (\n"
                  "    lambda name: None if name == 'pydantic' else find(name))\n"
                  f"sys.path.insert(0, {ROOT!r})\nimport evaluation.tables\n")
        result = subprocess.run([sys.executable, "-B", "-c", script], text=True,
                                stderr=subprocess.PIPE, check=False)
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stderr, "ERROR: python3-pydantic is missing; run "
                                        "scripts/install_deps.sh\n")


class ExperimentTest(TestCase):
    def test_maps_that_another_tool_has_no_more(self):
        for name in "ab":
            self.write(f"data/images/{name}.jpg")
            self.write(f"maps/{name}.jpg.geometric.bin", "4&3&1&")
        step = experiment.LinkComparison(Experiment(name="data", data=self.path("data")),
                                         self.path("out/x-0"), "x", [self.path("maps")])
        for count in (2, 1):
            step.run()
            self.assertEqual(record.load(self.path("out/x-0")).views, count)
            os.remove(self.path("maps", "ab"[count - 1] + ".jpg.geometric.bin"))

    def test_bad_data_and_comparisons(self):
        data = self.path("data")
        compared = Experiment(name="data", data=data)
        for part, text in (("images/a.jpg", "no folder images"),
                           ("sparse/x", "no folder sparse"),
                           ("gt_depth/a.png", "neither gt_depth/ nor a MeshLab")):
            with self.assertRaisesRegex(Failure, text):
                experiment.check(compared)
            self.write("data/" + part)
        with self.assertRaisesRegex(Failure, "fewer than two photographs"):
            experiment.check(compared)
        self.write("data/images/c.jpg")
        experiment.check(compared)
        os.rename(self.path("data/gt_depth/a.png"), self.path("data/gt_depth/x.png"))
        with self.assertRaisesRegex(Failure, "no depth of any .* such as a.png"):
            experiment.check(compared)
        os.rename(self.path("data/gt_depth/x.png"), self.path("data/gt_depth/a.png"))
        compared.views = ["b.jpg"]
        with self.assertRaisesRegex(Failure, "no photograph b.jpg"):
            experiment.check(compared)
        for name, path, text in (("tapa", data, "under this name"),
                                 ("a/b", data, "under this name"),
                                 ("x", self.path("none"), "there is no"),
                                 ("x", self.write("f.txt"), "neither")):
            with self.assertRaisesRegex(Failure, text):
                experiment.check_comparison(name, path)

    def test_the_command_of_an_experiment(self):
        for settings, text in (
                ({"name": "x", "data": "/somewhere/fountain", "methods": ["plain"],
                  "seeds": [0, 2], "every": 4, "tolerances": [0.5], "options": ["--a", "1"]},
                 "scripts/evaluate DATA/fountain --out OUT/x --methods plain --seeds 0,2 "
                 "--every 4 --tolerances 0.5 -- --a 1"),
                ({"name": "x", "data": "/x", "tolerances": [0.1234567, 5.0, 1e-05],
                  "relative_tolerances": [1 / 3]},
                 "scripts/evaluate DATA/x --out OUT --tolerances 0.1234567,5,1e-05 "
                 "--relative_tolerances 0.3333333333333333"),
                ({"name": "y", "data": "/somewhere/y"}, "scripts/evaluate DATA/y --out OUT"),
                ({"name": "office", "data": "/o/scenes/office"},
                 "scripts/evaluate examples/office --out OUT")):
            self.assertEqual(experiment.command_text(Experiment(**settings)), text)


class MachineTest(unittest.TestCase):
    def test_this_machine(self):
        this = machine.describe()
        self.assertEqual(this.cores, len(os.sched_getaffinity(0)))
        self.assertGreater(this.memory_bytes, 1e8)
        self.assertIsNone(this.gpu)

    def test_gpus_that_colmap_names(self):
        for line, text in (
                ("Computing on GPU 0 (NVIDIA H100 80GB HBM3).", "NVIDIA H100 80GB HBM3"),
                ("Computing on GPU 0 (A (Laptop)), 0 (A (Laptop)), 2 (B).", "A (Laptop), B"),
                ("Computing on GPU 1 (A), 3 (A).", "2 x A"),
                ("Computing on the CPU, as there is no driver.", None)):
            self.assertEqual(machine.gpus_in(["Reading", line, "Elapsed"]), text)
