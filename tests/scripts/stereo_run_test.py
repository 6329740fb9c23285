#!/usr/bin/python3
"""Runs and their records, with programs that only pretend."""

import glob
import os
import signal
import stat
import subprocess
import sys
import threading
import time
import unittest

from helpers import ROOT, TestCase
from evaluation import (cloud_scores, depth_scores, experiment, files, links, machine, processes,
                        run_record, stereo_run)
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


def write(path, text="", executable=False):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    if executable:
        os.chmod(path, os.stat(path).st_mode | stat.S_IXUSR)
    return path


class StereoRunTest(TestCase):
    def setUp(self):
        super().setUp()
        write(self.path("bin", "colmap"), _COLMAP, True)
        for name in "abcd":
            write(self.path("data", "images", name + ".jpg"))
        write(self.path("data", "sparse", "cameras.txt"))

    def run_of(self, **values):
        return stereo_run.Run(**{
            "data": self.path("data"), "folder": self.path("out", "tapa-3"),
            "set": "data", "method": "tapa", "seed": 3,
            "options": ["--PatchMatchStereo.num_iterations", "1"],
            "bin_dir": self.path("bin"), **values})

    def calls(self, command):
        with open(self.path("bin", "calls"), encoding="utf-8") as file:
            return [line for line in file if line.startswith(command)]

    def test_everything_is_done_once_and_recorded(self):
        run = self.run_of()
        self.assertFalse(stereo_run.is_complete(run))
        commands = stereo_run.missing_commands(run)
        self.assertEqual(len(commands), 4)
        self.assertFalse(os.path.exists(run.folder))
        record = stereo_run.complete(run)
        self.assertEqual(record, run_record.load(run.folder))
        self.assertTrue(stereo_run.is_complete(run))
        self.assertEqual(record["done"], ["stereo", "fused", "fused_default"])
        self.assertEqual(record["options"],
                         ["--PatchMatchStereo.seed", "3",
                          "--PatchMatchStereo.tapa", "1",
                          "--PatchMatchStereo.num_iterations", "1"])
        self.assertEqual(record["fusion_options"], stereo_run.FUSIONS)
        self.assertEqual((record["views"], record["image_size"]), (4, [4, 3]))
        self.assertEqual(list(record["made_with"]), record["done"])
        self.assertFalse(run_record.is_mixed(record))
        for step in record["done"]:
            (part,) = record["made_with"][step]
            self.assertTrue(part["version"].startswith(
                "COLMAP 3.8 (Commit 1234 without CUDA)"), part["version"])
            self.assertEqual(part["machine"], machine.describe())
            self.assertGreater(record["seconds"][step], 0)
            self.assertGreater(record["peak_memory_bytes"][step], 1e5)
        self.assertAlmostEqual(
            run_record.total_seconds(record),
            record["seconds"]["stereo"] + record["seconds"]["fused"])
        self.assertTrue(os.path.exists(run.path("fused.ply.vis")))
        self.assertEqual(glob.glob(run.path("*.new*")), [])
        self.assertIn("--StereoFusion.max_reproj_error 1 "
                      "--StereoFusion.max_normal_error 20",
                      self.calls("stereo_fusion")[0])
        self.assertNotIn("max_reproj_error", self.calls("stereo_fusion")[1])
        # Again: nothing is left to do.
        self.assertEqual(stereo_run.missing_commands(run), [])
        stereo_run.complete(run)
        self.assertEqual(len(self.calls("patch_match_stereo")), 1)
        self.assertEqual(len(self.calls("stereo_fusion")), 2)
        # A cloud that is gone is made anew.
        os.remove(run.path("fused.ply"))
        self.assertEqual(stereo_run.complete(run)["done"], record["done"])
        self.assertEqual(len(self.calls("stereo_fusion")), 3)

    def test_a_failure_is_recorded_and_forgotten_when_it_is_over(self):
        write(self.path("bin", "fail"))
        run = self.run_of()
        with self.assertRaisesRegex(Failure, "patch_match_stereo: no source"):
            stereo_run.complete(run)
        record = run_record.load(run.folder)
        self.assertEqual(record["failed"]["step"], "stereo")
        self.assertIn("no source images", record["failed"]["message"])
        before = record["seconds"]["stereo"]
        self.assertGreater(before, 0)
        os.remove(self.path("bin", "fail"))
        record = stereo_run.complete(run)
        self.assertIsNone(record["failed"])
        self.assertGreater(record["seconds"]["stereo"], before)

    def test_other_settings_are_refused(self):
        stereo_run.complete(self.run_of())
        for values, part in (({"options": []}, "options"), ({"every": 2}, "every"),
                             ({"sources": 3}, "sources")):
            with self.assertRaisesRegex(Failure, f"made with {part}"):
                stereo_run.complete(self.run_of(**values))

    def test_points_of_other_thresholds_are_refused_until_they_are_removed(self):
        stereo_run.complete(self.run_of())
        other = self.run_of(fusions={"fused": ["--StereoFusion.max_reproj_error", "3"]})
        with self.assertRaisesRegex(
                Failure, "fused.ply was made with the fusion options "
                ".*max_reproj_error 1 .*, not .*max_reproj_error 3; remove it"):
            stereo_run.complete(other)
        self.assertEqual(len(self.calls("stereo_fusion")), 2)
        os.remove(other.path("fused.ply"))
        record = stereo_run.complete(other)
        self.assertEqual(record["fusion_options"],
                         {**other.fusions, "fused_default": []})

    def test_times_of_a_finished_workspace_are_unknown(self):
        run = self.run_of()
        stereo_run.complete(run)
        os.remove(run.path("record.json"))
        os.remove(run.path("fused_default.ply"))
        record = stereo_run.complete(run)
        self.assertIsNone(record["seconds"]["stereo"])
        self.assertIsNone(record["cpu_seconds"]["fused"])
        self.assertIsNone(record["peak_memory_bytes"]["stereo"])
        self.assertEqual(record["fusion_options"],
                         {"fused": None, "fused_default": []})
        self.assertEqual(record["made_with"]["fused"], [None])
        # This program looked whether all maps were there.
        self.assertIsNone(record["made_with"]["stereo"][0])
        self.assertTrue(run_record.is_mixed(record))
        self.assertGreater(record["seconds"]["fused_default"], 0)
        self.assertIsNone(run_record.total_seconds(record))
        self.assertEqual(record["views"], 4)

    def test_a_cloud_of_maps_that_are_no_more_is_made_anew(self):
        run = self.run_of()
        stereo_run.complete(run)
        os.remove(run.path("record.json"))
        os.remove(run.path("stereo", "depth_maps", "a.jpg.geometric.bin"))
        write(run.path("fused.ply"), "of other maps")
        stereo_run.complete(run)
        with open(run.path("fused.ply"), encoding="utf-8") as file:
            self.assertEqual(file.read(), "ply\n")

    def test_maps_of_other_photographs_are_refused(self):
        run = self.run_of()
        stereo_run.complete(run)
        os.remove(run.path("record.json"))
        config = run.path("stereo", "patch-match.cfg")
        with open(config, encoding="utf-8") as file:
            before = file.read()
        with self.assertRaisesRegex(Failure, "maps of other photographs"):
            stereo_run.complete(self.run_of(every=2))
        with open(config, encoding="utf-8") as file:
            self.assertEqual(file.read(), before)

    def test_a_stop_is_handed_on_and_its_time_counts(self):
        write(self.path("bin", "slow"))
        run = self.run_of()

        def stop():
            while not os.path.exists(self.path("bin", "started")):
                time.sleep(0.02)
            os.kill(os.getpid(), signal.SIGINT)

        thread = threading.Thread(target=stop)
        thread.start()
        with self.assertRaises(processes.Interrupted) as caught:
            stereo_run.complete(run)
        thread.join()
        self.assertEqual(caught.exception.number, signal.SIGINT)
        before = run_record.load(run.folder)["seconds"]["stereo"]
        self.assertGreater(before, 0)
        os.remove(self.path("bin", "slow"))
        record = stereo_run.complete(run)
        self.assertGreater(record["seconds"]["stereo"], before)

    def test_time_of_a_part_that_was_killed_is_unknown(self):
        run = self.run_of()
        stereo_run.complete(run)
        record = run_record.load(run.folder)
        # As it stands while a program runs.
        record["done"] = []
        record["seconds"] = {"stereo": None}
        files.write_json(run.path("record.json"), record)
        self.assertIsNone(stereo_run.complete(run)["seconds"]["stereo"])

    def test_gpus_are_recorded_where_they_were_used(self):
        says = write(self.path("bin", "says"), "Computing on GPU 0 (A), 1 (B).\n")
        run = self.run_of()
        made_with = stereo_run.complete(run)["made_with"]
        self.assertEqual(made_with["stereo"][0]["machine"]["gpu"], "A, B")
        self.assertIsNone(made_with["fused"][0]["machine"]["gpu"])
        # A run that was killed there, and went on upon the CPU.
        record = run_record.load(run.folder)
        record["done"] = []
        record["made_with"]["stereo"][0]["machine"]["gpu"] = None
        run_record.save(run.folder, record)
        os.remove(says)
        record = stereo_run.complete(run)
        self.assertEqual([part["machine"]["gpu"]
                          for part in record["made_with"]["stereo"]], ["A, B", None])
        self.assertEqual(run_record.stereo_gpus(record), {"A, B", None})
        self.assertTrue(run_record.is_mixed(record))

    def test_a_run_that_goes_on_with_another_version_says_so(self):
        write(self.path("bin", "fail"))
        for _ in range(2):  # The same twice is one part.
            with self.assertRaises(Failure):
                stereo_run.complete(self.run_of())
        os.remove(self.path("bin", "fail"))
        write(self.path("bin", "colmap"), _COLMAP.replace("1234", "5678"), True)
        record = stereo_run.complete(self.run_of())
        self.assertEqual([part["version"][19:23]
                          for part in record["made_with"]["stereo"]],
                         ["1234", "5678"])
        self.assertEqual(len(record["made_with"]["fused"]), 1)
        self.assertTrue(run_record.is_mixed(record))

    def test_a_record_of_one_version_for_all_is_read(self):
        run = self.run_of()
        record = stereo_run.complete(run)
        (part,) = record["made_with"]["stereo"]
        old = {**record, **part}
        for key in ("made_with", "fusion_options"):
            del old[key]
        run_record.save(run.folder, old)
        self.assertEqual(run_record.load(run.folder), {**record, "fusion_options": {}})
        stereo_run.complete(run)  # They are taken for these.

    def test_missing_programs_and_broken_records(self):
        with self.assertRaisesRegex(Failure, "has no colmap; run scripts/build"):
            stereo_run.complete(self.run_of(bin_dir=self.path("none")))
        write(self.path("out", "tapa-3", "record.json"), "{")
        with self.assertRaisesRegex(Failure, "record.json cannot be read"):
            stereo_run.complete(self.run_of())
        os.remove(self.path("out", "tapa-3", "record.json"))
        with self.assertRaisesRegex(Failure, "make_workspace.sh: .*no folder images"):
            stereo_run.complete(self.run_of(data=self.path("bin")))


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
            with self.assertRaises(processes.ProgramFailed) as caught:
                processes.run(["sh", "-c", script], self.path("log"))
            self.assertIn(text, str(caught.exception))
            self.assertNotIn("\n", str(caught.exception))
            self.assertGreater(caught.exception.usage.seconds, 0)
        with self.assertRaisesRegex(Failure, "cannot be started"):
            processes.run([self.path("none")], self.path("log"))

    def test_names_that_are_no_text(self):
        name = os.fsdecode(b"\xff \xc3\xa9")
        processes.run(["test", "-n", name], self.path("log"))
        with open(self.path("log"), "rb") as file:
            self.assertIn(b"\xff", file.read())


class FilesTest(TestCase):
    def test_a_full_disk_leaves_what_was_there(self):
        path = write(self.path("page.md"), "before")
        # A device that is always full stands in for the disk.
        os.symlink("/dev/full", path + ".new")
        with self.assertRaisesRegex(Failure, "page.md cannot be written: No space"):
            files.write_text(path, "after")
        with open(path, encoding="utf-8") as file:
            self.assertEqual(file.read(), "before")
        self.assertEqual(os.listdir(self.folder), ["page.md"])
        with self.assertRaisesRegex(Failure, "x cannot be written: "):
            files.write_text(os.path.join(path, "x"), "text")

    def test_a_lock_keeps_others_out(self):
        folder = self.path("new")
        script = ("import sys\n"
                  f"sys.path.insert(0, {ROOT!r})\n"
                  "from evaluation import files\n"
                  f"files.lock({folder!r}, sys.argv[1])\n")

        def other(name):
            return subprocess.run([sys.executable, "-B", "-c", script, name], text=True,
                                  stderr=subprocess.PIPE, check=False).stderr

        with files.lock(folder, "run"):
            self.assertIn(f"Failure: another run is at work in {folder}; ", other("run"))
            self.assertEqual(other("report"), "")
        self.assertEqual(other("run"), "")
        with self.assertRaisesRegex(Failure, "x cannot be written: Not a dir"):
            files.lock(os.path.join(write(self.path("file")), "x"), "run")

    def test_fingerprints(self):
        write(self.path("a", "b.bin"), "x" * 100000)
        before = files.fingerprint(self.path("a"))
        self.assertEqual(files.fingerprint(self.path("a")), before)
        self.assertEqual(files.fingerprint(self.path("none")), "")
        for name, text in (("b.bin", "x" * 99999), ("b.bin", "x" * 99999 + "y"),
                           ("c.bin", "")):
            write(self.path("a", name), text)
            self.assertNotEqual(files.fingerprint(self.path("a")), before)
            before = files.fingerprint(self.path("a"))


class CloudScoresTest(TestCase):
    OUTPUT = ("Loading reconstruction: x\nTolerances: 0.01 0.02\n"
              "Completenesses: 0.25 0.5\nAccuracies: 0.5 1\n"
              "F1-scores: 0.333333 0.666667\n")

    def evaluator(self, output, code=0):
        write(self.path("output"), output)
        return write(self.path("evaluator"), "#!/bin/sh\n"
                     f"echo \"$@\" >> '{self.path('calls')}'\n"
                     f"cat '{self.path('output')}'\nexit {code}\n", True)

    def test_scores_are_kept(self):
        evaluator = self.evaluator(self.OUTPUT)
        for _ in range(2):
            scores = cloud_scores.score(
                self.folder, ["fused"], "scans.mlp", evaluator, [0.01, 0.02],
                ["--voxel_size", "0.1"])
            self.assertEqual(scores["fused"]["f1"], [0.333333, 0.666667])
        self.assertEqual(cloud_scores.load(self.folder), scores)
        self.assertEqual(cloud_scores.at(scores["fused"], 0.02), {
            "completeness": 0.5, "accuracy": 1, "f1": 0.666667})
        self.assertIsNone(cloud_scores.at(scores["fused"], 0.5))
        with open(self.path("calls"), encoding="utf-8") as file:
            calls = file.read().splitlines()
        self.assertEqual(calls, [
            "--tolerances 0.01,0.02 --reconstruction_ply_path "
            f"{self.path('fused.ply')} --ground_truth_mlp_path scans.mlp "
            "--voxel_size 0.1"])
        # Another tolerance needs another run.
        with self.assertRaisesRegex(Failure, "other tolerances than asked"):
            cloud_scores.score(self.folder, ["fused"], "scans.mlp", evaluator,
                               [0.01, 0.05])
        with open(self.path("calls"), encoding="utf-8") as file:
            self.assertEqual(len(file.read().splitlines()), 2)

    def test_tolerances_keep_all_their_digits(self):
        exact = [0.012345678901234, 1 / 3]
        evaluator = self.evaluator(self.OUTPUT.replace(
            "Tolerances: 0.01 0.02", "Tolerances: 0.0123457 0.333333"))
        for _ in range(2):  # The second time there is nothing to do.
            scores = cloud_scores.score(self.folder, ["fused"], "scans.mlp",
                                        evaluator, exact)
        self.assertEqual(scores["fused"]["tolerances"], exact)
        with open(self.path("calls"), encoding="utf-8") as file:
            (call,) = file.read().splitlines()
        self.assertEqual([float(word) for word in call.split()[1].split(",")], exact)

    def test_scores_are_not_taken_for_those_of_something_else(self):
        evaluator = self.evaluator(self.OUTPUT)
        scans = write(self.path("scans", "scan_alignment.mlp"), "poses")
        write(self.path("fused.ply"), "points")

        def calls(program=evaluator, options=()):
            cloud_scores.score(self.folder, ["fused"], scans, program,
                               [0.01, 0.02], options)
            with open(self.path("calls"), encoding="utf-8") as file:
                return len(file.read().splitlines())

        self.assertEqual((calls(), calls()), (1, 1))
        write(self.path("scans", "scan1.ply"), "a scan")
        self.assertEqual((calls(), calls()), (2, 2))
        other = write(self.path("theirs"), f"#!/bin/sh\nexec '{evaluator}' \"$@\"", True)
        self.assertEqual((calls(other), calls(other)), (3, 3))
        self.assertEqual((calls(other, ["--a", "1"]), calls(other, ["--a", "1"])), (4, 4))
        # What is shown without scoring is not that of another cloud, either.
        write(self.path("fused.ply"), "Points")
        self.assertEqual(cloud_scores.load(self.folder), {})
        self.assertEqual(calls(other, ["--a", "1"]), 5)
        os.remove(self.path("fused.ply"))  # For want of space.
        self.assertIn("fused", cloud_scores.load(self.folder))

    def test_output_that_is_no_score(self):
        for output, code, text in (
                ("Tolerances: 0.01\n", 0, "no line Completenesses"),
                (self.OUTPUT.replace("0.5 1", "0.5"), 0, "different length"),
                (self.OUTPUT.replace("0.5 1", "x y"), 0, "no numbers behind Acc"),
                ("ERROR: no vertices in fused.ply\n", 1, "no vertices")):
            with self.assertRaisesRegex(Failure, text):
                cloud_scores.score(self.folder, ["fused"], "scans.mlp",
                                   self.evaluator(output, code))
        self.assertEqual(cloud_scores.load(self.folder), {})


class DepthScoresTest(TestCase):
    def evaluator(self):
        script = ("#!/bin/sh\necho call >> " + self.path("calls") + "\n"
                  "while [ $# -gt 0 ]; do [ $1 = --json ] && out=$2; shift; done\n"
                  "cp " + self.path("result") + " $out\n")
        return write(self.path("bin", "evaluate_depth_maps"), script, True)

    def scores(self, tolerances, bounds):
        part = {"coverage": 1, "measurement_coverage": 1,
                "median_absolute_error": None, "median_relative_error": None,
                "tolerances": [
            {"tolerance": value, "unit": unit, "completeness": 0.5,
             "accuracy": 0.5, "f1": 0.5} for value, unit in tolerances]}
        return {"overall": part, "images": [], "by_textureness": [
            {"max_textureness": bound, "score": part} for bound in bounds]}

    def test_scored_again_only_for_other_tolerances(self):
        self.evaluator()
        files.write_json(self.path("result"), self.scores(
            [(0.01, "m"), (1, "%")], [0.75]))
        options = {"tolerances": [0.01], "relative_tolerances": [1],
                   "textureness": [0.75], "bin_dir": self.path("bin")}
        for _ in range(2):
            scores = depth_scores.score(self.folder, "gt", **options)
        with open(self.path("calls"), encoding="utf-8") as file:
            self.assertEqual(file.read(), "call\n")
        self.assertEqual(depth_scores.at(scores["overall"], 1, "%")["f1"], 0.5)
        self.assertIsNone(depth_scores.at(scores["overall"], 1, "m"))
        self.assertIsNotNone(depth_scores.below(scores, 0.75))
        self.assertIsNone(depth_scores.below(scores, 0.8))
        depth_scores.score(self.folder, "gt", **{**options, "tolerances": [1]})
        with open(self.path("calls"), encoding="utf-8") as file:
            self.assertEqual(file.read(), "call\ncall\n")

    def test_tolerances_keep_all_their_digits(self):
        command = depth_scores.command("w", "gt", "out", [0.1234567], [1 / 3, 2.0], [1])
        self.assertEqual(command[6:11:2], ["0.1234567", "0.3333333333333333,2", "1"])

    def test_scored_again_for_other_maps_and_other_measurements(self):
        self.evaluator()
        files.write_json(self.path("result"), self.scores(
            [(0.01, "m"), (1, "%")], [0.75]))
        maps = self.path("stereo", "depth_maps", "a.jpg.geometric.bin")
        write(maps, "a map")
        write(self.path("gt", "a.png"), "depth")

        def calls():
            depth_scores.score(self.folder, self.path("gt"), tolerances=[0.01],
                               relative_tolerances=[1], textureness=[0.75],
                               bin_dir=self.path("bin"))
            with open(self.path("calls"), encoding="utf-8") as file:
                return len(file.read().splitlines())

        self.assertEqual((calls(), calls()), (1, 1))
        write(self.path("gt", "a.png"), "other")
        self.assertEqual((calls(), calls()), (2, 2))
        write(maps, "A map")
        self.assertIsNone(depth_scores.load(self.folder))
        self.assertEqual((calls(), calls()), (3, 3))
        os.remove(maps)  # For want of space.
        self.assertIsNotNone(depth_scores.load(self.folder))
        self.assertEqual(calls(), 3)


class LinksTest(TestCase):
    def setUp(self):
        super().setUp()
        for name in ("b.jpg", "a.jpg", "rig/c.jpg"):
            write(self.path("data", "images", name))

    def test_photographs_are_those_of_make_workspace(self):
        data = self.path("data")
        self.assertEqual(links.photographs(data), ["a.jpg", "b.jpg", "rig/c.jpg"])
        self.assertEqual(links.photographs(data, 2), ["a.jpg", "rig/c.jpg"])

    def test_maps_of_all_names(self):
        data, names = self.path("data"), links.photographs(self.path("data"))
        for maps, file in (("w", "w/stereo/depth_maps/a.jpg.geometric.bin"),
                           ("p", "p/a.jpg.photometric.bin"),
                           ("q", "q/rig/c.jpg.bin")):
            write(self.path(file), maps)
            out = self.path("out_" + maps)
            self.assertEqual(links.make_view_workspace(
                data, self.path(maps), out, names), 1)
            found = [path for path in (os.path.join(
                out, "stereo/depth_maps", name + ".geometric.bin")
                for name in names) if os.path.exists(path)]
            self.assertEqual(len(found), 1)
            with open(found[0], encoding="utf-8") as content:
                self.assertEqual(content.read(), maps)
            self.assertTrue(os.path.exists(os.path.join(out, "images/rig/c.jpg")))
        with self.assertRaisesRegex(Failure, "no depth map of a.jpg"):
            links.make_view_workspace(data, self.path("data"), self.path("x"),
                                      names)


class BenchmarkRunTest(TestCase):
    def test_whatever_fails_does_not_stop_the_others(self):
        one = experiment.Experiment("s", self.path("data"), methods=["plain", "tapa"])
        done = []

        def complete(run):
            if run.method == "plain":
                raise ValueError("two\nlines")
            done.append(run.method)

        self.addCleanup(setattr, stereo_run, "complete", stereo_run.complete)
        stereo_run.complete = complete
        failures = experiment.run(one, self.path("out"), self.path("bin"))
        self.assertEqual(failures, [
            (self.path("out", "s", "plain-0"), "ValueError: two lines")])
        self.assertEqual(done, ["tapa"])


class PackageTest(unittest.TestCase):
    def test_python_packages_that_are_missing_are_named_at_once(self):
        script = ("import importlib.util, sys\n"
                  "find = importlib.util.find_spec\n"
                  "importlib.util.find_spec = (\n"
                  "    lambda name: None if name == 'matplotlib' else find(name))\n"
                  f"sys.path.insert(0, {ROOT!r})\n"
                  "import evaluation.tables\n")
        result = subprocess.run([sys.executable, "-B", "-c", script], text=True,
                                stderr=subprocess.PIPE, check=False)
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stderr, "ERROR: python3-matplotlib is missing; run "
                                        "scripts/install_deps.sh\n")


class BenchmarkCheckTest(TestCase):
    def test_maps_that_another_tool_has_no_more(self):
        for name in "ab":
            write(self.path("data", "images", name + ".jpg"))
            write(self.path("maps", name + ".jpg.geometric.bin"), "4&3&1&")
        one = experiment.Experiment("data", self.path("data"))
        folder = self.path("out", "x-0")
        for count in (2, 1):
            experiment.take_comparison(one, folder, "x", [self.path("maps")])
            self.assertEqual(run_record.load(folder)["views"], count)
            os.remove(self.path("maps", "ab"[count - 1] + ".jpg.geometric.bin"))

    def test_bad_data_and_comparisons(self):
        data = self.path("data")
        one = experiment.Experiment("data", data)
        for part, text in (("images/a.jpg", "no folder images"),
                           ("sparse/x", "no folder sparse"),
                           ("gt_depth/a.png", "neither gt_depth/ nor a MeshLab")):
            with self.assertRaisesRegex(Failure, text):
                experiment.check(one)
            write(os.path.join(data, part))
        with self.assertRaisesRegex(Failure, "fewer than two photographs"):
            experiment.check(one)
        write(os.path.join(data, "images", "c.jpg"))
        experiment.check(one)
        os.rename(os.path.join(data, "gt_depth/a.png"),
                  os.path.join(data, "gt_depth/x.png"))
        with self.assertRaisesRegex(Failure, "no depth of any .* such as a.png"):
            experiment.check(one)
        os.rename(os.path.join(data, "gt_depth/x.png"),
                  os.path.join(data, "gt_depth/a.png"))
        one.views = ["b.jpg"]
        with self.assertRaisesRegex(Failure, "no photograph b.jpg"):
            experiment.check(one)
        for name, path, text in (("tapa", data, "under this name"),
                                 ("a/b", data, "under this name"),
                                 ("x", self.path("none"), "there is no"),
                                 ("x", write(self.path("f.txt")), "neither")):
            with self.assertRaisesRegex(Failure, text):
                experiment.check_comparison(name, path)

    def test_the_command_of_a_benchmark(self):
        self.assertEqual(
            experiment.command_text(experiment.Experiment(
                "x", "/somewhere/fountain", methods=["plain"], seeds=[0, 2],
                every=4, tolerances=[0.5], options=["--a", "1"])),
            "scripts/evaluate DATA/fountain --out OUT/x --methods plain --seeds 0,2 "
            "--every 4 --tolerances 0.5 -- --a 1")
        self.assertIn(
            "--tolerances 0.1234567,5,1e-05 --relative_tolerances 0.3333333333333333",
            experiment.command_text(experiment.Experiment(
                "x", "/x", tolerances=[0.1234567, 5.0, 1e-05],
                relative_tolerances=[1 / 3])))
        self.assertEqual(
            experiment.command_text(experiment.Experiment("y", "/somewhere/y")),
            "scripts/evaluate DATA/y --out OUT")


class MachineTest(unittest.TestCase):
    def test_this_machine(self):
        found = machine.describe()
        self.assertEqual(found["cores"], len(os.sched_getaffinity(0)))
        self.assertGreater(found["memory_bytes"], 1e8)
        self.assertIsNone(found["gpu"])

    def test_gpus_that_colmap_names(self):
        for line, text in (
                ("Computing on GPU 0 (NVIDIA H100 80GB HBM3).", "NVIDIA H100 80GB HBM3"),
                ("Computing on GPU 0 (A (Laptop)), 0 (A (Laptop)), 2 (B).",
                 "A (Laptop), B"),
                ("Computing on GPU 1 (A), 3 (A).", "2 x A"),
                ("Computing on the CPU, as there is no driver.", None)):
            self.assertEqual(machine.gpus_in(["Reading", line, "Elapsed"]), text)


if __name__ == "__main__":
    unittest.main()
