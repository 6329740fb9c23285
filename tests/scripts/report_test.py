#!/usr/bin/python3
"""Tables, figures and pages from scores made by hand."""

import csv
import io
import os
import sys
import unittest

from helpers import ROOT, TestCase, made_with, make_record
from evaluation import (experiment, figures, files, pictures, plan, report, results, run_record,
                        tables)
from evaluation.eth3d import report as eth3d_report
from evaluation.eth3d import scenes as eth3d_scenes
from evaluation.eth3d import paper_tables
from evaluation.eth3d import published
from evaluation.methods import LABELS, METHODS, TAPA_ABLATION
from evaluation.processes import Failure


def depth_part(shares):
    """shares: completeness by (tolerance, unit); accuracy is twice that."""
    entries = []
    for (value, unit), share in shares.items():
        accuracy = min(1, 2 * share)
        entries.append({"tolerance": value, "unit": unit, "completeness": share,
                        "accuracy": accuracy,
                        "f1": 2 * share * accuracy / (share + accuracy)})
    return {"coverage": 0.5, "measurement_coverage": 0.625,
            "median_absolute_error": 0.0123, "median_relative_error": 0.004,
            "tolerances": entries}


def write_result(out, name, method, seed=0, depth=None, low=None, f1=None,
                 options=(), **record):
    """depth, low: as depth_part(); f1: of points at 2 cm, by cloud; record: as values."""
    folder = os.path.join(out, name, f"{method}-{seed}")
    run_record.save(folder, make_record(name, method, seed, options, **record))
    if depth:
        files.write_json(os.path.join(folder, "depth_scores.json"), {
            "overall": depth_part(depth), "images": [],
            "by_textureness": [{"max_textureness": bound,
                                "score": depth_part(part)}
                               for bound, part in (low or {}).items()]})
    if f1:
        files.write_json(os.path.join(folder, "cloud_scores.json"), {
            cloud: {"tolerances": [0.01, 0.02], "completeness": [0.1, value],
                    "accuracy": [0.1, value], "f1": [0.1, value]}
            for cloud, value in f1.items()})
    return folder


class ResultsTest(TestCase):
    def test_means_over_seeds(self):
        for seed, share in ((10, 0.5), (2, 0.25)):
            write_result(self.folder, "s", "plain", seed, {(0.02, "m"): share})
        found = results.load_set(self.folder, "s")
        self.assertEqual([run.record["seed"] for run in found["plain"]], [2, 10])
        score = results.depth_score(found["plain"], 0.02)
        self.assertAlmostEqual(score.completeness, 0.375)
        self.assertAlmostEqual(score.accuracy, 0.75)
        # Means of F1, not F1 of means: 1/3 and 2/3.
        self.assertAlmostEqual(score.f1, 0.5)
        self.assertAlmostEqual(score.least_f1, 1 / 3)
        self.assertAlmostEqual(score.most_f1, 2 / 3)
        self.assertEqual(tables.score_text(score),
                         "37.5 / 75.0 / 50.0 (33.3-66.7)")

    def test_what_is_missing_is_none(self):
        write_result(self.folder, "s", "plain")
        found = results.load_set(self.folder, "s")
        self.assertIsNone(results.depth_score(found["plain"], 0.02))
        self.assertIsNone(results.depth_score(None, 0.02))
        self.assertIsNone(results.cloud_score(found["plain"], 0.02))
        self.assertIsNone(results.depth_value(found["plain"], "coverage"))
        self.assertEqual(results.load_set(self.folder, "none"), {})
        self.assertEqual(tables.score_text(None), "-")

    def test_times(self):
        write_result(self.folder, "s", "plain", 0)
        write_result(self.folder, "s", "plain", 1, cpu_seconds={"stereo": 100.})
        write_result(self.folder, "s", "plain", 2, cpu_seconds={"stereo": None})
        write_result(self.folder, "s", "tapa", 0, cpu_seconds={"stereo": None})
        found = results.load_set(self.folder, "s")
        # 4 views of a quarter of a megapixel.
        self.assertAlmostEqual(results.cpu_per_megapixel(found["plain"]), 110)
        self.assertIsNone(results.cpu_per_megapixel(found["tapa"]))

    def test_a_time_so_far_is_not_shown(self):
        write_result(self.folder, "s", "plain", done=[])
        found = results.load_set(self.folder, "s")
        self.assertIsNone(results.step_value(found["plain"], "seconds"))

    def test_pooled_methods_have_all_sets(self):
        write_result(self.folder, "a", "plain", depth={(0.02, "m"): 0.25})
        write_result(self.folder, "b", "plain", depth={(0.02, "m"): 0.5})
        write_result(self.folder, "a", "tapa", depth={(0.02, "m"): 0.5})
        write_result(self.folder, "b", "tapa")  # Not scored.
        found = results.pool(results.load_set(self.folder, name) for name in "ab")
        self.assertEqual(list(found), ["plain"])
        self.assertAlmostEqual(
            results.depth_score(found["plain"], 0.02).completeness, 0.375)

    def test_mean_over_sets_needs_all(self):
        write_result(self.folder, "a", "tapa", f1={"fused": 0.5})
        write_result(self.folder, "b", "tapa", f1={"fused": 0.75})
        write_result(self.folder, "c", "plain", f1={"fused": 0.75})
        a, b, c = (results.load_set(self.folder, name) for name in "abc")
        self.assertAlmostEqual(
            results.mean_over_sets([a, b], "tapa", 0.02).f1, 0.625)
        self.assertIsNone(results.mean_over_sets([a, b, c], "tapa", 0.02))
        self.assertIsNone(results.mean_over_sets([], "tapa", 0.02))


class TablesTest(TestCase):
    def test_tolerances_as_text(self):
        for value, unit, text in ((0.07, "m", "7 cm"), (1.5, "m", "1.5 m"),
                                  (0.012345678, "m", "1.2345678 cm"),
                                  (0.5, "%", "0.5 %"), (2.0000001, "%", "2.0000001 %")):
            self.assertEqual(tables.tolerance_text(value, unit), text)

    def test_depth_table(self):
        write_result(self.folder, "s", "plain", depth={
            (0.02, "m"): 0.25, (1, "%"): 0.5},
            low={0.75: {(0.02, "m"): 0.125, (1, "%"): 0.125}})
        found = results.load_set(self.folder, "s")
        columns = [(0.02, "m"), (1, "%")]
        table = tables.depth_table(found, ["plain", "tapa"], columns)
        self.assertEqual(table.header, ["method", "2 cm", "1 %"])
        self.assertEqual(table.rows, [
            ["COLMAP", "25.0 / 50.0 / 33.3", "50.0 / 100.0 / 66.7"],
            ["TAPA", "-", "-"]])
        self.assertIn("| TAPA | - | - |\n", table.markdown())
        rows = list(csv.reader(io.StringIO(table.csv())))
        self.assertEqual(rows[0][:5], ["method", "tolerance", "unit",
                                       "completeness", "accuracy"])
        self.assertEqual(rows[1][:5], ["plain", "0.02", "m", "0.25", "0.5"])
        self.assertEqual(rows[3], ["tapa", "0.02", "m", "", "", "", "", "", "0"])
        low = tables.depth_table(found, ["plain"], columns, 0.75)
        self.assertEqual(low.rows[0][1], "12.5 / 25.0 / 16.7")
        self.assertIn("below 0.75", low.caption)

    def test_cost_table(self):
        write_result(self.folder, "s", "plain", depth={(0.02, "m"): 0.25})
        write_result(self.folder, "s", "tapa", seconds={"stereo": None},
                     cpu_seconds={"stereo": None},
                     peak_memory_bytes={"stereo": None})
        found = results.load_set(self.folder, "s")
        self.assertEqual(tables.cost_table(found, ["plain", "tapa", "x"]).rows, [
            ["COLMAP", "1", "4", "500x500", "50.0", "62.5", "-", "12.3", "0.40",
             "120", "70", "300"],
            ["TAPA", "1", "4", "500x500"] + ["-"] * 8,
            ["x", "0"] + ["-"] * 10])

    def test_published_figures_agree_with_each_other(self):
        # The overall mean is over 5 scenes of low and 13 or 12 of high resolution.
        for name, cells in published.TABLE1.items():
            for first, high in ((0, 13), (3, 12)):
                mean = (5 * cells[first + 1] + high * cells[first + 2]) / (5 + high)
                if (name, first) == ("CMPMVS", 0):
                    mean -= 0.3  # The paper has 47.48.
                self.assertAlmostEqual(cells[first], mean, delta=0.011)
        at_2_cm = published.TABLE2_TOLERANCES.index(0.02)
        for ours, theirs in (("paper", "TAPA-MVS"), ("plain", "COLMAP")):
            self.assertEqual(published.TABLE2[ours][at_2_cm][2],
                             published.TABLE1[theirs][2])
        for column in published.TABLE2.values():
            self.assertEqual(len(column), 6)
            self.assertEqual(list(column), sorted(column))
        self.assertEqual(set(METHODS), set(LABELS))
        self.assertLessEqual(set(TAPA_ABLATION), set(METHODS))

    def test_table1(self):
        scenes = [scene for scene in eth3d_scenes.all_scenes()
                  if scene.split == "training" and scene.resolution == "low"]
        for i, scene in enumerate(scenes):
            write_result(self.folder, scene.set_name, "tapa",
                         f1={"fused": 0.5 + 0.01 * i})
        table = paper_tables.table1(eth3d_report.groups_of(self.folder))
        self.assertEqual(table.rows[0], ["TAPA", "this program", "-", "52.00",
                                         "-", "-", "-", "-"])
        self.assertEqual(table.rows[1][2:], ["-"] * 6)
        self.assertIn(["COLMAP", "published", "62.73", "49.91", "67.66", "66.92",
                       "52.32", "73.01"], table.rows)
        own = [row for row in table.csv_rows if row[1] == "own"]
        self.assertEqual(own[0][2], None)
        self.assertAlmostEqual(own[0][3], 0.52)
        # One scene less, and there is no mean.
        os.remove(self.path(scenes[0].set_name, "tapa-0", "cloud_scores.json"))
        table = paper_tables.table1(eth3d_report.groups_of(self.folder))
        self.assertEqual(table.rows[0][2:], ["-"] * 6)

    def test_table2(self):
        write_result(self.folder, "s", "plain", f1={"fused": 0.25})
        write_result(self.folder, "s", "tapa", f1={"fused": 0.5})
        table = paper_tables.table2([results.load_set(self.folder, "s")],
                                    TAPA_ABLATION, with_published=True)
        self.assertEqual(len(table.rows), 12)
        self.assertEqual(table.header[1], "COLMAP")
        self.assertEqual(table.rows[1], [
            "2 cm", "25.00 / 25.00 / 25.00", "-", "-", "-", "-",
            "50.00 / 50.00 / 50.00"])
        self.assertEqual(table.rows[2], ["5 cm"] + ["-"] * 6)
        self.assertEqual(table.rows[7][0], "2 cm, published")
        self.assertEqual(table.rows[7][6], "71.45 / 85.88 / 77.69")
        self.assertEqual(len(table.csv_rows), 6 * 6 * 2)


class FiguresTest(TestCase):
    def setUp(self):
        super().setUp()
        write_result(self.folder, "s", "plain", depth={
            (error, "m"): i / 10 for i, error in enumerate(figures.ERRORS, 1)},
            low={bound: {(0.1, "m"): bound / 2, (0.2, "m"): bound,
                         (0.5, "m"): bound} for bound in (0.6, 1)})
        write_result(self.folder, "empty", "plain")
        self.found = results.load_set(self.folder, "s")
        self.empty = results.load_set(self.folder, "empty")

    def test_points(self):
        points = figures.error_points(self.found["plain"])
        self.assertEqual(points[0], (0.01, 0.1))
        self.assertEqual(points[-1], (5, 0.9))
        self.assertEqual(figures.error_points(None)[0], (0.01, None))
        self.assertEqual(figures.textureness_points(self.found["plain"], 0.1),
                         [(0.6, 0.3), (1, 0.5)])
        self.assertTrue(all(share is None for _, share in
                            figures.textureness_points(None, 0.1)))

    def test_which_methods_are_drawn(self):
        methods = ["plain", "tapa", "tapa-fine", "paper", "other-tool"]
        self.assertEqual(figures.chosen_methods(methods),
                         ["plain", "tapa", "paper", "other-tool"])
        self.assertEqual(pictures.chosen_methods(methods),
                         ["plain", "tapa", "other-tool"])
        self.assertEqual(figures.chosen_methods(["tapa-fine"]), ["tapa-fine"])
        self.assertEqual(pictures.chosen_methods(["paper"]), ["paper"])

    def test_files(self):
        for draw in (figures.draw_errors, figures.draw_textureness):
            path = self.path("f", draw.__name__ + ".png")
            caption = draw(path, self.found, ["plain", "tapa"], "s")
            self.assertIn("Higher is better" if draw is figures.draw_errors
                          else "0.5 is a flat wall", caption)
            with open(path, "rb") as file:
                self.assertEqual(file.read(8), b"\x89PNG\r\n\x1a\n")
            self.assertIsNone(draw(self.path("no.png"), self.empty, ["plain"],
                                   "empty"))
        self.assertFalse(os.path.exists(self.path("no.png")))


class ReportTest(TestCase):
    def report_of(self, one, **options):
        out = self.path("out")
        made = report.SetReport(one, out, out, os.path.join(out, "figures"),
                                os.path.join(out, "tables"))
        report.write_report(os.path.join(out, "report.md"), [made], "Title",
                            **options)
        return self.read("out", "report.md")

    def test_page(self):
        write_result(self.path("out"), "s", "plain", depth={(0.02, "m"): 0.25},
                     f1={"fused": 0.5, "fused_default": 0.25})
        write_result(self.path("out"), "s", "tapa",
                     failed={"step": "stereo", "message": "it broke"})
        one = experiment.Experiment("s", self.path("s"), tolerances=[0.02],
                                  methods=["plain", "tapa", "paper"])
        text = self.report_of(one, failures=[("x", "it broke"), ("y", "oh")])
        self.assertIn("| COLMAP | 25.0 / 50.0 / 33.3 | - |", text)
        self.assertIn("| paper's TAPA | - | - |", text)
        self.assertIn("- s: tapa, seed 0: stereo: it broke\n", text)
        self.assertIn("- s: paper, seed 0: not run\n", text)
        self.assertEqual(text.count("it broke"), 1)
        self.assertIn("- y: oh\n", text)
        self.assertIn("fused with COLMAP's own thresholds", text)
        self.assertIn("| COLMAP | 50.0 / 50.0 / 50.0 |", text)
        self.assertIn("COLMAP 3.8 on abacus, 2 cores, 8 GB.", text)
        self.assertIn("![How far the depth maps are off](figures/s_errors.png)",
                      text)
        self.assertTrue(os.path.exists(self.path("out/figures/s_errors.png")))
        self.assertIn("plain,0.02,m,0.25,0.5", self.read("out/tables/s_depth.csv"))

    def test_runs_in_parts(self):
        write_result(self.path("out"), "s", "plain", 3, made_with={
            "stereo": [made_with(gpu="NVIDIA X"), made_with("COLMAP 3.9")],
            "fused": [made_with("COLMAP 3.9")]})
        one = experiment.Experiment("s", self.path("s"), methods=["plain"], seeds=[3])
        self.assertIn(
            "Run with COLMAP 3.8; COLMAP 3.9 on abacus, 2 cores, 8 GB, stereo on "
            "NVIDIA X; the CPU. Not made in one piece, by one version on one "
            "machine: plain, seed 3.\n", self.report_of(one))
        # Fusion does not use the GPU.
        write_result(self.path("out"), "s", "plain", 3, made_with={
            "stereo": [made_with(gpu="NVIDIA X")], "fused": [made_with()]})
        self.assertIn("Run with COLMAP 3.8 on abacus, 2 cores, 8 GB, stereo on "
                      "NVIDIA X.\n", self.report_of(one))

    def test_names_with_spaces(self):
        write_result(self.path("out"), "a b", "plain", depth={(0.02, "m"): 0.25})
        text = self.report_of(experiment.Experiment("a b", self.path("s"),
                                                  methods=["plain"]))
        self.assertIn("](figures/a%20b_errors.png)", text)

    def test_another_tool_s_maps_of_some_photographs(self):
        write_result(self.path("out"), "s", "other", depth={(0.02, "m"): 0.25},
                     compare=["x"], views=3, photographs=4)
        text = self.report_of(experiment.Experiment(
            "s", self.path("s"), methods=[], compare=[("other", "x")]))
        self.assertIn("- s: other: maps of 3 of 4 photographs", text)

    def test_results_of_other_options_are_left_out(self):
        write_result(self.path("out"), "s", "plain", depth={(0.02, "m"): 0.25},
                     options=["--PatchMatchStereo.num_iterations", "1"])
        one = experiment.Experiment("s", self.path("s"), methods=["plain"])
        text = self.report_of(one)
        self.assertIn("plain, seed 0: the results in OUT were made with other "
                      "options", text)
        self.assertNotIn("25.0", text)
        one.options = None  # Any.
        self.assertIn("25.0", self.report_of(one))

    def test_eth3d(self):
        scene = eth3d_scenes.all_scenes()[0]
        runs = self.path("runs")
        os.makedirs(self.path("sets", scene.set_name, "images"))
        write_result(runs, scene.set_name, "plain", depth={(0.02, "m"): 0.25},
                     f1={"fused": 0.5}, options=["--any", "1"])
        path = eth3d_report.write(self.path("report"), runs, self.path("sets"),
                                  [scene], ["plain", "tapa"])
        text = self.read("report", "report.md")
        self.assertEqual(path, self.path("report", "report.md"))
        self.assertIn("| COLMAP, TAPA's thresholds | this program | - |", text)
        self.assertIn("| 2 cm | 50.00 / 50.00 / 50.00 | - |", text)
        self.assertIn(f"{scene.set_name}: tapa, seed 0: not run", text)
        self.assertIn("- `plain`: 10 source views --any 1\n", text)
        self.assertIn("figures/errors.png", text)
        self.assertIn("25.0 / 50.0", self.read("report", scene.set_name + ".md"))
        self.assertTrue(os.path.exists(self.path("report/tables/table1.csv")))

    def test_eth3d_scenes_with_other_options(self):
        scenes = eth3d_scenes.all_scenes()[:2]
        for scene, options in zip(scenes, (["--any", "1"], [])):
            os.makedirs(self.path("sets", scene.set_name, "images"))
            write_result(self.path("runs"), scene.set_name, "plain", options=options)
        eth3d_report.write(self.path("report"), self.path("runs"), self.path("sets"),
                           scenes, ["plain"])
        text = self.read("report", "report.md")
        for scene, words in zip(scenes, (" --any 1", "")):
            self.assertIn(f"- `plain`: 10 source views{words}; **other scenes with other "
                          f"options:** this is {scene.set_name}\n", text)


_PLAN = """
page = "results.md"
images = "images/x"
title = "Results"
text = "Words."
[sets.one]
data = "s"
methods = ["plain"]
tolerances = [0.02]
[sets.two]
data = "s"
options = ["--PatchMatchStereo.max_image_size", "9"]
[[section]]
title = "First"
set = "one"
show = ["depth", "errors"]
[[section]]
text = "In between."
[[section]]
title = "Second"
set = "two"
methods = ["plain"]
"""


class PlanTest(TestCase):
    def plan_of(self, text=_PLAN):
        files.write_text(self.path("docs", "plan.toml"), text)
        return plan.Plan(self.path("docs", "plan.toml"), self.folder, "/none")

    def test_page(self):
        os.makedirs(self.path("s", "images"))
        write_result(self.path("out"), "one", "plain", depth={(0.02, "m"): 0.25})
        made = self.plan_of()
        self.assertEqual(made.sets["one"].data, self.path("s"))
        # The plan's own page is not touched before every set has results.
        page, missing = made.write(self.path("out"))
        self.assertEqual(page, self.path("out", "results.md"))
        self.assertEqual(missing, ["- two: plain, seed 0: not run",
                                   "- two: tapa, seed 0: not run"])
        text = self.read("out", "results.md")
        self.assertIn("# Results\n\nWords.\n\n## First\n\n    scripts/evaluate "
                      "DATA/s --out OUT/one --methods plain", text)
        self.assertIn("| COLMAP | 25.0 / 50.0 / 33.3 |", text)
        self.assertIn("(images/x/one_errors.png)", text)
        self.assertIn("In between.\n\n## Second\n", text)
        self.assertIn("*`two` has not been run.*", text)
        write_result(self.path("out"), "two", "plain", depth={(0.02, "m"): 0.5},
                     options=["--PatchMatchStereo.max_image_size", "9"])
        page, missing = made.write(self.path("out"))
        self.assertEqual(page, self.path("docs", "results.md"))
        self.assertEqual(missing, ["- two: tapa, seed 0: not run"])
        self.assertTrue(os.path.exists(self.path("docs/images/x/one_errors.png")))

    def test_a_page_about_some_sets(self):
        os.makedirs(self.path("s", "images"))
        for name, options in (("one", []), (
                "two", ["--PatchMatchStereo.max_image_size", "9"])):
            write_result(self.path("out"), name, "plain", options=options,
                         depth={(0.02, "m"): 0.25})
        made = self.plan_of(_PLAN.replace(
            '"Words."', '"[a](tapa.md#b) [c](http://x/y.md) [d](z.md)"'))
        page, missing = made.write(self.path("out"), only=["one"])
        self.assertEqual(page, self.path("out", "results.md"))
        self.assertEqual(missing, [])
        text = self.read("out", "results.md")
        self.assertIn("[a](../docs/tapa.md#b) [c](http://x/y.md) "
                      "[d](../docs/z.md)", text)
        self.assertIn("(images/x/one_errors.png)", text)
        self.assertIn("## First", text)
        self.assertNotIn("In between", text)
        self.assertNotIn("## Second", text)

    def test_bad_plans(self):
        for old, new, text in (
                ("page =", "pages =", "has no page"),
                ("title = \"Results\"", "title = Results", "is not TOML"),
                ("data = \"s\"\nmethods", "methods", "sets.one has no data"),
                ("tolerances", "tolerance", "unknown key tolerance;"),
                ("set = \"two\"", "set = \"three\"", "set three, which is not"),
                ("\"errors\"]", "\"error\"]", "shows error; there are depth"),
                ("[sets.one]", "[sets.\"../one\"]", "its name of letters"),
                ("[sets.one]", "sets.x = 1\n[sets.one]", "sets.x must be a table"),
                ("[sets.one]", "every = 1\n[sets.one]", "the page has an unknown key"),
                ("[\"plain\"]\ntol", "\"plain\"\ntol", "methods of sets.one must be a list"),
                ("[\"plain\"]\ntol", "[\"plane\"]\ntol", "sets.one has an unknown method"),
                ("[0.02]", "[-0.02]", "tolerances of sets.one must be a list of pos"),
                ("data = \"s\"\nopt", "data = \"s\"\nevery = 0\nopt", "every of sets.two"),
                ("data = \"s\"\nopt", "data = \"s\"\nseeds = 0\nopt", "seeds of sets.two"),
                ("\"In between.\"", "3", "text of a section must be a text"),
                ("\"Second\"", "\"x\"\nlevel = true", "level of a section")):
            with self.assertRaisesRegex(Failure, text):
                self.plan_of(_PLAN.replace(old, new))
        files.write_bytes(self.path("latin.toml"), b'title = "\xe9"')
        with self.assertRaisesRegex(Failure, "latin.toml is not TOML"):
            plan.Plan(self.path("latin.toml"), self.folder, "/none")
        with self.assertRaisesRegex(Failure, "none.toml cannot be read"):
            plan.Plan(self.path("none.toml"), self.folder, "/none")

    def test_the_project_s_own(self):
        made = plan.Plan(os.path.join(ROOT, "docs", "results_plan.toml"), None,
                         ROOT)
        self.assertEqual(made.sets["room"].views, ["room_05.jpg"])
        for one in made.sets.values():
            self.assertLessEqual(set(one.methods), set(METHODS))


if __name__ == "__main__":
    unittest.main()
