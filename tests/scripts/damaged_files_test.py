#!/usr/bin/python3
"""Files of results that lack something: one line says what, and nothing is lost."""

import copy
import json
import os
import sys
import unittest

from helpers import TestCase, make_record
from evaluation import (cloud_scores, depth_scans, depth_scores, experiment, files, run_record,
                        shapes, stereo_run)
from evaluation.eth3d import scenes as eth3d_scenes
from evaluation.processes import Failure

PART = {"coverage": 0.5, "measurement_coverage": 0.5, "median_absolute_error": 1,
        "median_relative_error": None, "tolerances": [
            {"tolerance": 1, "unit": "m", "completeness": 1, "accuracy": None,
             "f1": None}]}
CLOUD = {"tolerances": [0.1], "completeness": [1], "accuracy": [1], "f1": [1]}


class ShapesTest(unittest.TestCase):
    SHAPE = {"a": str, "b?": [float], "c": {str: (None, [int])}}

    def test_what_has_the_shape(self):
        for value in ({"a": "", "c": {}}, {"a": "", "c": {}, "more": 1},
                      {"a": "x", "b": [1, 0.5], "c": {"d": None, "e": [1, 2]}}):
            shapes.check("x.json", value, self.SHAPE)

    def test_what_has_not(self):
        for value, text in (([], "it is not an object"), ({"a": ""}, "it has no key c"),
                            ({"a": 1, "c": {}}, "a is not a text"),
                            ({"a": "", "c": {"d": 1}}, "d is not a list"),
                            ({"a": "", "c": {"d": [1.5]}}, r"d\[0\] is not a whole number"),
                            ({"a": "", "b": [1, True], "c": {}},
                             r"b\[1\] is not a number")):
            with self.assertRaisesRegex(
                    Failure, f"^x.json is damaged: {text}; remove it to make it anew$"):
                shapes.check("x.json", value, self.SHAPE)


class DamagedFilesTest(TestCase):
    def write(self, text, *parts):
        path = self.path(*parts)
        files.write_text(path, text)
        return path

    def check_damaged(self, name, content, keys, read):
        """read() refuses the file without one of the keys, and half of the file."""
        whole = json.dumps(content)
        path = self.write(whole, *name.split("/"))
        read()
        for key in keys:
            without = copy.deepcopy(content)
            inner = without
            *above, last = key.split(".")
            for one in above:
                inner = inner[int(one) if one.isdigit() else one]
            del inner[last]
            self.expect(path, json.dumps(without), f"has no key {last};", read)
        for text in (whole[:len(whole) // 2], "", "\0", "[]", "null", '"text"'):
            self.expect(path, text, "", read)

    def expect(self, path, text, words, read):
        self.write(text, path)
        with self.assertRaises(Failure) as caught:
            read()
        message = str(caught.exception)
        self.assertTrue(message.startswith(path), message)
        self.assertIn(words, message)
        self.assertNotIn("\n", message)
        self.assertEqual(self.read(path), text)

    def test_records(self):
        keys = [*make_record(), "made_with.stereo.0.machine.cpu",
                "made_with.stereo.0.version"]
        self.check_damaged("record.json", make_record(), keys,
                           lambda: run_record.load(self.folder))
        other = make_record(compare=["x"], photographs=4)
        del other["sources"], other["every"]
        self.check_damaged("record.json", other, ["photographs"],
                           lambda: run_record.load(self.folder))

    def test_scores(self):
        self.check_damaged("cloud_scores.json", {"fused": CLOUD},
                           ["fused." + key for key in CLOUD],
                           lambda: cloud_scores.load(self.folder))
        scores = {"overall": PART, "by_textureness": [
            {"max_textureness": 0.6, "score": PART}]}
        self.check_damaged(
            "depth_scores.json", scores,
            ["overall", "overall.coverage", "overall.tolerances.0.unit",
             "by_textureness.0.score", "by_textureness.0.score.tolerances"],
            lambda: depth_scores.load(self.folder))

    def test_scans_and_sets(self):
        about = {"beam_divergence_halfangle_deg": 1}
        self.check_damaged("scans.json", about, about,
                           lambda: depth_scans.read_about(self.folder))
        scene = {"scene": "office", "resolution": "high", "split": "training"}
        self.check_damaged("office_dslr/set.json", scene, scene,
                           lambda: eth3d_scenes.prepared_scenes(self.folder))

    def test_nothing_is_done_where_the_record_is_damaged(self):
        self.write("#!/bin/sh\ntouch \"$0\".called\n", "bin", "colmap")
        os.chmod(self.path("bin", "colmap"), 0o755)
        run = stereo_run.Run(
            data="data", folder=self.path("run"), set="s",
            method="plain", bin_dir=self.path("bin"))
        record = make_record()
        del record["done"]
        run_record.save(run.folder, record)
        with self.assertRaisesRegex(Failure, "record.json is damaged: it has no key done"):
            stereo_run.complete(run)
        self.assertEqual(os.listdir(run.folder), ["record.json"])
        self.assertEqual(os.listdir(run.bin_dir), ["colmap"])

    def test_links_to_another_tool_s_results_do_not_replace_damaged_ones(self):
        self.write("x", "data", "images", "a.jpg")
        one = experiment.Experiment("s", self.path("data"), methods=[])
        one.compare = [("other", self.write("x", "cloud.ply"))]
        for record, text in ((make_record(), "has results of this program"),
                             ({}, "is damaged: it has no key"),
                             ("half", "is damaged: it is not")):
            kept = self.write("maps", "out", "s", "other-0", "stereo", "map")
            run_record.save(self.path("out/s/other-0"), record)
            ((folder, message),) = experiment.run(one, self.path("out"), "bin")
            self.assertIn(text, message)
            self.assertIn(folder, message)
            self.assertTrue(os.path.exists(kept))


if __name__ == "__main__":
    unittest.main()
