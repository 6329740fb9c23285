"""Files of results that lack something: one line says what, and nothing is lost."""

import copy
import json
import os
import unittest
from typing import Dict, List, Optional

from helpers import TestCase, make_record
from evaluation import (cloud_scores, depth_scans, depth_scores, experiment, record, schemas,
                        steps, stereo_run)
from evaluation.eth3d import scenes
from evaluation.processes import Failure

PART = {"coverage": 0.5, "measurement_coverage": 0.5, "median_absolute_error": 1,
        "median_relative_error": None, "tolerances": [
            {"tolerance": 1, "unit": "m", "completeness": 1, "accuracy": None, "f1": None}]}
CLOUD = {"tolerances": [0.1], "completeness": [1], "accuracy": [1], "f1": [1],
         "made_from": {"cloud": "", "scans": "", "evaluator": "", "options": []}}


class Example(schemas.Model):
    a: schemas.Text
    b: List[schemas.Number] = []
    c: Dict[str, Optional[List[schemas.Integer]]]


class SchemasTest(unittest.TestCase):
    def test_what_is_of_a_model(self):
        for value in ({"a": "", "c": {}}, {"a": "", "c": {}, "more": 1},
                      {"a": "x", "b": [1, 0.5], "c": {"d": None, "e": [1, 2]}}):
            # Nothing is lost, nothing converted.
            self.assertEqual(schemas.check(value, Example, "x.json").dict(), {"b": [], **value})

    def test_what_is_not(self):
        for value, text in (([], "it is not an object"), ({"a": ""}, "it has no key c"),
                            ({"a": 1, "c": {}}, "a: str type expected"),
                            ({"a": "", "c": {"d": 1}}, "c.d: value is not a valid list"),
                            ({"a": "", "c": {"d": [1.5]}}, "c.d.0: value is not a valid int"),
                            ({"a": "", "b": [1, True], "c": {}}, "b.1: value is not a number"),
                            ({"a": "", "b": ["1"], "c": {}}, "b.0: value is not a number")):
            with self.assertRaisesRegex(
                    Failure, f"^x.json is damaged: {text}.*; remove it to make it anew$"):
                schemas.check(value, Example, "x.json")


class DamagedFilesTest(TestCase):
    def check_damaged(self, name, content, keys, read):
        """read() refuses the file without one of the keys, and half of the file."""
        whole = json.dumps(content)
        path = self.write(name, whole)
        read()
        for key in keys:
            without = copy.deepcopy(content)
            inner = without
            *above, last = key.split(".")
            for part in above:
                inner = inner[int(part) if part.isdigit() else part]
            del inner[last]
            self.expect(path, json.dumps(without), f"has no key {last};", read)
        for text in (whole[:len(whole) // 2], "", "\0", "[]", "null", '"text"'):
            self.expect(path, text, "", read)

    def expect(self, path, text, words, read):
        self.write(path, text)
        with self.assertRaises(Failure) as caught:
            read()
        message = str(caught.exception)
        self.assertTrue(message.startswith(path), message)
        self.assertIn(words, message)
        self.assertNotIn("\n", message)
        self.assertEqual(self.read(path), text)

    def test_records(self):
        for content, keys in (
                (make_record(), ["made_with.stereo.0.machine.cpu", "made_with.stereo.0.version"]),
                (make_record(compare=["x"], photographs=4), [])):
            content = content.dict()
            self.check_damaged("record.json", content,
                               [*(key for key in content if key != "compare"), *keys],
                               lambda: record.load(self.folder))

    def test_scores(self):
        self.check_damaged("cloud_scores.json", {"fused": CLOUD},
                           ["fused." + key for key in CLOUD],
                           lambda: cloud_scores.load(self.folder))
        scores = {"overall": PART, "by_textureness": [{"max_textureness": 0.6, "score": PART}],
                  "made_from": {"maps": "", "truth": ""}}
        self.check_damaged(
            "depth_scores.json", scores,
            ["overall", "made_from", "overall.coverage", "overall.tolerances.0.unit",
             "by_textureness.0.score", "by_textureness.0.score.tolerances"],
            lambda: depth_scores.load(self.folder))

    def test_scans_and_sets(self):
        about = {"beam_divergence_halfangle_deg": 1}
        self.check_damaged("scans.json", about, about, lambda: depth_scans.read_about(self.folder))
        scene = {"scene": "office", "resolution": "high", "split": "training"}
        self.check_damaged("office_dslr/set.json", scene, scene,
                           lambda: scenes.prepared_scenes(self.folder))

    def test_nothing_is_done_where_the_record_is_damaged(self):
        self.write("bin/colmap", "#!/bin/sh\ntouch \"$0\".called\n", True)
        run = stereo_run.Run(data="data", folder=self.path("run"), set="s", method="plain",
                             bin_dir=self.path("bin"))
        self.write("run/record.json", make_record().json(exclude={"done"}))
        ((_, message),) = steps.perform([steps.Job("run", run.steps())])
        self.assertIn("record.json is damaged: it has no key done", message)
        self.assertEqual(os.listdir(run.folder), ["record.json"])
        self.assertEqual(os.listdir(run.bin_dir), ["colmap"])

    def test_links_to_another_tool_s_results_do_not_replace_damaged_ones(self):
        self.write("data/images/a.jpg")
        compared = experiment.Experiment(
            name="s", data=self.path("data"), methods=[],
            compare=[("other", self.write("cloud.ply"))])
        for text, words in ((make_record().json(), "has results of this program"),
                            ("{}", "is damaged: it has no key"), ("half", "cannot be read")):
            kept = self.write("out/s/other-0/stereo/map", "maps")
            self.write("out/s/other-0/record.json", text)
            ((folder, message),) = steps.perform(
                experiment.jobs(compared, self.path("out"), "bin"))
            self.assertIn(words, message)
            self.assertIn(folder, message)
            self.assertTrue(os.path.exists(kept))
