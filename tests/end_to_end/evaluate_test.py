#!/usr/bin/env python3
"""Every switch of scripts/evaluate, on three small views of the example."""

import csv
import json
import os
import shutil
import signal
import subprocess
import sys
import time
import unittest

import tiny_workspace as tiny

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "../.."))
sys.path.insert(0, os.path.join(ROOT, "tests", "evaluation"))
from helpers import TestCase  # noqa: E402

SCRIPTS = os.path.join(ROOT, "scripts")
ROOM = os.path.join(ROOT, "examples", "room")
BIN_DIR = os.path.dirname(os.path.abspath(tiny.COLMAP))
FAST = ["--PatchMatchStereo.num_iterations", "2", "--PatchMatchStereo.window_radius", "3",
        "--PatchMatchStereo.num_samples", "5"]
SMALL = ["--every", "4", "--sources", "2", "--image_size", "144"]
SMALL_OPTIONS = ["--PatchMatchStereo.max_image_size", "144", *FAST]


class EvaluateTest(TestCase):

    def run_script(self, *arguments, bin_dir=BIN_DIR):
        return subprocess.run(
            [os.path.join(SCRIPTS, "evaluate"), *arguments], stdin=subprocess.DEVNULL,
            capture_output=True, text=True, timeout=600, check=False,
            env=dict(os.environ, TAPA_BIN_DIR=bin_dir))

    def room(self, *arguments, options=FAST, **more):
        return self.run_script(ROOM, "--out", self.path("out"), *SMALL,
                               *arguments, "--", *options, **more)

    def read_json(self, *parts):
        return json.loads(self.read(*parts))

    def read_csv(self, *parts):
        return list(csv.DictReader(self.read(*parts).splitlines()))

    def wrapper(self, when, then):
        """A folder in which colmap does something else at times."""
        return os.path.dirname(self.write(
            "bin/colmap", f"#!/bin/sh\ncase \"$*\" in {when}) {then} ;; esac\n"
            f"exec '{os.path.abspath(tiny.COLMAP)}' \"$@\"\n", executable=True))

    def evaluator(self):
        """Stands in for ETH3D's program: half of everything is right."""
        return self.write("evaluator", (
            "#!/bin/sh\n[ -s \"$4\" ] && [ -s \"$6\" ] || exit 1\n"
            f"echo \"$@\" >> {self.path('evaluated')}\n"
            "half=$(echo \"$2\" | tr ',' '\\n' | sed 's/.*/0.5/' | tr '\\n' ' ')\n"
            "echo \"Tolerances: $(echo $2 | tr ',' ' ')\"\n"
            "for name in Completenesses Accuracies F1-scores; do echo \"$name: $half\"; done\n"),
            executable=True)

    def test_report_of_methods_seeds_and_other_tools(self):
        first = self.room("--methods", "plain", "--no_clouds")
        self.assertEqual(first.returncode, 0, first.stderr)
        self.assertIn("Report: " + self.path("out/report.md"), first.stdout)
        record = self.read_json("out/room/plain-0/record.json")
        # Another tool's: the same maps under another name, and points.
        maps = self.path("out/room/plain-0/stereo/depth_maps")
        cloud = self.path("cloud.ply")
        shutil.copy(self.path("out/room/plain-0/fused.ply"), cloud)
        arguments = [
            "--methods", "plain,tapa", "--seeds", "0,1", "--compare",
            f"other={maps}", "--compare", f"other={cloud}", "--tolerances",
            "0.1,0.03", "--relative_tolerances", "2,7", "--views",
            "room_04.jpg", "--eth3d_evaluator", self.evaluator()]
        result = self.room(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("plain-0: stereo", result.stderr)
        self.assertEqual(self.read_json("out/room/plain-0/record.json"), record)
        self.assertEqual(record["views"], 3)
        self.assertEqual(record["image_size"], [144, 96])
        self.assertEqual(record["options"], ["--PatchMatchStereo.seed", "0", *SMALL_OPTIONS])
        self.check_tables()
        self.check_page()
        # Once more: nothing is left to do.
        again = self.room(*arguments)
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(again.stderr, "")

    def check_tables(self):
        rows = self.read_csv("out/tables/room_depth.csv")
        self.assertEqual([(row["method"], row["tolerance"], row["unit"])
                          for row in rows[:4]],
                         [("plain", "0.03", "m"), ("plain", "0.1", "m"),
                          ("plain", "2.0", "%"), ("plain", "7.0", "%")])
        by_method = {row["method"]: row for row in rows
                     if row["tolerance"] == "0.1"}
        self.assertEqual({name: row["runs"] for name, row in by_method.items()},
                         {"plain": "2", "tapa": "2", "other": "1"})
        plain = self.read_json("out/room/plain-0/depth_scores.json")
        at = next(entry for entry in plain["overall"]["tolerances"]
                  if (entry["tolerance"], entry["unit"]) == (0.1, "m"))
        self.assertEqual(float(by_method["other"]["f1"]), at["f1"])
        self.assertGreater(float(by_method["tapa"]["f1"]), 0.2)
        self.assertGreater(float(by_method["tapa"]["completeness"]),
                           float(by_method["plain"]["completeness"]))
        self.assertEqual({row["f1"] for row in self.read_csv("out/tables/room_points_fused.csv")},
                         {"0.5"})
        # Three clouds of each run, one of the other tool.
        self.assertEqual(len(self.read("evaluated").splitlines()), 4 * 3 + 1)

    def check_page(self):
        text = self.read("out/report.md")
        self.assertIn("| method | 3 cm | 10 cm | 2 % | 7 % |", text)
        self.assertIn("| other | 50.0 / 50.0 / 50.0 |", text)
        self.assertIn("one in 4, 2 source views", text)
        self.assertIn("Points were scored by `evaluator`.", text)
        self.assertNotIn("What is missing", text)
        for name in ("room_errors.png", "room_textureness.png", "room_room_04.jpg"):
            self.assertIn(f"(figures/{name})", text)
            self.assertGreater(os.path.getsize(self.path("out/figures", name)), 5000)

    def test_points(self):
        result = self.room("--methods", "plain")
        self.assertEqual(result.returncode, 0, result.stderr)
        scores = self.read_json("out/room/plain-0/cloud_scores.json")
        for name in ("fused", "fused_default"):
            at = scores[name]["tolerances"].index(0.5)
            self.assertGreater(scores[name]["accuracy"][at], 0.8)
            self.assertGreater(scores[name]["completeness"][at], 0.3)

    def test_a_method_that_fails_does_not_stop_the_others(self):
        broken = self.wrapper("*PatchMatchStereo.tapa*", "echo 'ERROR: no luck'; exit 1")
        result = self.room("--methods", "tapa,plain", "--no_clouds", bin_dir=broken)
        self.assertEqual(result.returncode, 1)
        self.assertIn("ERROR: 1 of 2 failed:\n  "
                      + self.path("out/room/tapa-0"), result.stderr)
        text = self.read("out/report.md")
        self.assertIn("- room: tapa, seed 0: stereo: patch_match_stereo: no luck", text)
        self.assertRegex(text, r"\| TAPA \| - \| - \|")
        self.assertRegex(text, r"\| plain \| \d+\.\d / ")
        # What failed is tried again.
        result = self.room("--methods", "tapa,plain", "--no_clouds")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("What is missing", self.read("out/report.md"))

    def test_a_stopped_run_goes_on(self):
        slow = self.wrapper("patch_match*", "touch " + self.path("started")
                            + "; exec sleep 60")
        with subprocess.Popen(
                [os.path.join(SCRIPTS, "evaluate"), ROOM, "--out",
                 self.path("out"), *SMALL, "--methods", "plain", "--no_clouds",
                 "--", *FAST], stderr=subprocess.PIPE, text=True,
                env=dict(os.environ, TAPA_BIN_DIR=slow)) as process:
            while not os.path.exists(self.path("started")):
                self.assertIsNone(process.poll())
                time.sleep(0.05)
            time.sleep(0.2)
            self.check_others_are_kept_out()
            process.send_signal(signal.SIGTERM)
            _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertIn("goes on from here", errors)
        before = self.read_json("out/room/plain-0/record.json")
        self.assertGreater(before["seconds"]["stereo"], 0)
        result = self.room("--methods", "plain", "--no_clouds")
        self.assertEqual(result.returncode, 0, result.stderr)
        after = self.read_json("out/room/plain-0/record.json")
        self.assertGreater(after["seconds"]["stereo"], before["seconds"]["stereo"])

    def check_others_are_kept_out(self):
        other = self.room("--methods", "tapa", "--no_clouds")
        self.assertEqual(other.returncode, 1)
        self.assertIn("ERROR: another evaluation is at work in "
                      + self.path("out") + ";", other.stderr)
        self.assertEqual(other.stderr.count("\n"), 1, other.stderr)
        self.assertFalse(os.path.exists(self.path("out/room/tapa-0")))
        look = self.room("--methods", "plain", "--no_clouds", "--report_only")
        self.assertEqual(look.returncode, 0, look.stderr)
        self.assertIn("not finished", self.read("out/report.md"))

    def test_dry_run_does_nothing(self):
        result = self.room("--dry_run", "--no_clouds", "--methods", "tapa")
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = result.stdout.splitlines()
        self.assertEqual(len(lines), 6, result.stdout)
        for line, word in zip(lines, ("make_workspace.sh", "patch_match_stereo",
                                      "stereo_fusion", "stereo_fusion", "stereo_fusion",
                                      "evaluate_depth_maps")):
            self.assertIn(word, line)
        self.assertFalse(os.path.exists(self.path("out")))
        # Without programs, too, and with no wish to build them.
        result = self.room("--dry_run", "--methods", "tapa", bin_dir=self.path("no"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(result.stdout.splitlines()), 10, result.stdout)

    def test_a_page_from_a_plan(self):
        path = self.write("plan.toml", f"""
page = "page.md"
images = "images"
title = "A page"
[sets.small]
data = "room"
every = 4
sources = 2
methods = ["plain"]
options = {json.dumps(SMALL_OPTIONS)}
[sets.absent]
data = "absent"
[[section]]
set = "small"
show = ["depth", "errors"]
[[section]]
set = "absent"
""")
        arguments = ["--plan", path, "--data", os.path.dirname(ROOM), "--out", self.path("out"),
                     "--no_clouds"]
        result = self.run_script(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("SKIPPED: absent: there is no", result.stderr)
        self.assertIn("- absent: plain, seed 0: not run", result.stdout)
        text = self.read("out/page.md")
        self.assertRegex(text, r"\| plain \| \d+\.\d / ")
        self.assertIn("*`absent` has not been run.*", text)
        self.assertTrue(os.path.exists(self.path("out/images/small_errors.png")))
        only = self.run_script(*arguments, "--only", "small", "--report_only")
        self.assertEqual(only.returncode, 0, only.stderr)
        self.assertEqual(only.stderr, "")
        none = self.run_script(*arguments, "--only", "nothing")
        self.assertEqual(none.returncode, 1)
        self.assertIn("has no set nothing; there are small, absent", none.stderr)

    def test_bad_input_is_one_line(self):
        out = ["--out", self.path("out")]
        for arguments, text in (
                ([], "--out is required"), (out, "either data sets or --plan"),
                ([ROOM, *out, "--plan", "x"], "either data sets or --plan"),
                ([ROOM], "--out is required"),
                ([ROOM, *out, "--methods", "none"], "there is no method none; there are plain"),
                ([ROOM, *out, "--tolerances", "nan"], "positive numbers"),
                ([ROOM, *out, "--frobnicate"], "--frobnicate"),
                ([ROOM, *out, "--compare", "x"], "'x' is not NAME=PATH"),
                ([ROOM, *out, "--compare", "x=none"], "there is no none"),
                ([ROOM, *out, "--views", "x.jpg"], "no photograph x.jpg"),
                ([ROOM, ROOM, *out], "two data sets are called room"),
                ([self.folder, *out], "has no folder images"),
                ([ROOM, *out, "--eth3d_evaluator", "none"], "none is no program"),
                ([ROOM, *out, "--eth3d_evaluator", "/tmp"], "/tmp is no program"),
                ([ROOM, "--out", __file__ + "/x", "--report_only"], "cannot be written: "),
                (["--plan", "none.toml", *out], "none.toml cannot be read")):
            result = self.run_script(*arguments)
            self.assertEqual(result.returncode, 1, arguments)
            self.assertTrue(result.stderr.startswith("ERROR: "), result.stderr)
            self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
            self.assertIn(text, result.stderr)
        self.assertFalse(os.path.exists(self.path("out")))
        help_text = self.run_script("--help")
        self.assertEqual(help_text.returncode, 0)
        self.assertIn("--compare", help_text.stdout)


if __name__ == "__main__":
    unittest.main()
