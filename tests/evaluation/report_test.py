"""Tables, figures and pages from scores made by hand."""

import csv
import io
import os

from helpers import ROOT, TestCase, made_with, make_record
from evaluation import (depth_scores, figures, files, pictures, plan, record, report, results,
                        tables)
from evaluation.eth3d import paper_tables, published, scenes
from evaluation.eth3d.report import Eth3dReport, groups_of
from evaluation.experiment import Experiment
from evaluation.methods import METHODS, TAPA_ABLATION
from evaluation.processes import Failure

COLMAP_OPTIONS = " ".join(METHODS["colmap"])


def depth_part(shares):
    """shares: completeness by (tolerance, unit); accuracy is twice that."""
    entries = []
    for (value, unit), share in shares.items():
        accuracy = min(1, 2 * share)
        entries.append({"tolerance": value, "unit": unit, "completeness": share,
                        "accuracy": accuracy, "f1": 2 * share * accuracy / (share + accuracy)})
    return {"coverage": 0.5, "measurement_coverage": 0.625, "median_absolute_error": 0.0123,
            "median_relative_error": 0.004, "tolerances": entries}


class ResultsCase(TestCase):
    """Results that nobody has run stand in a folder "out"."""

    def setUp(self):
        super().setUp()
        self.out = self.path("out")

    def write_result(self, name, method, seed=0, depth=None, low=None, f1=None, options=(),
                     **values):
        """depth, low: as depth_part(), f1: of points at 2 cm, by cloud; values: of the record."""
        folder = self.path("out", name, f"{method}-{seed}")
        record.save(folder, make_record(name, method, seed, options, **values))
        if depth:
            files.write_json(os.path.join(folder, "depth_scores.json"), {
                "overall": depth_part(depth), "images": [],
                "by_textureness": [{"max_textureness": bound, "score": depth_part(part)}
                                   for bound, part in (low or {}).items()],
                "made_from": {"maps": "", "truth": ""}})
        if f1:
            source = {"cloud": "", "scans": "", "evaluator": "evaluate_point_cloud", "options": []}
            files.write_json(os.path.join(folder, "cloud_scores.json"), {
                cloud: {"tolerances": [0.01, 0.02], "completeness": [0.1, value],
                        "accuracy": [0.1, value], "f1": [0.1, value], "made_from": source}
                for cloud, value in f1.items()})

    def load(self, name="s"):
        return results.load_set(self.out, name)


class ResultsTest(ResultsCase):
    def test_means_over_seeds(self):
        for seed, share in ((10, 0.5), (2, 0.25)):
            self.write_result("s", "plain", seed, {(0.02, "m"): share})
        runs = self.load()["plain"]
        self.assertEqual([run.record.seed for run in runs], [2, 10])
        score = results.depth_score(runs, 0.02)
        # Means of F1, not F1 of means: 1/3 and 2/3.
        for value, expected in ((score.completeness, 0.375), (score.accuracy, 0.75),
                                (score.f1, 0.5), (score.least_f1, 1 / 3),
                                (score.most_f1, 2 / 3)):
            self.assertAlmostEqual(value, expected)
        self.assertEqual(tables.score_text(score), "37.5 / 75.0 / 50.0 (33.3-66.7)")

    def test_what_is_missing_is_none(self):
        self.write_result("s", "plain")
        runs = self.load()["plain"]
        for value in (results.depth_score(runs, 0.02), results.depth_score(None, 0.02),
                      results.cloud_score(runs, 0.02), results.depth_value(runs, "coverage")):
            self.assertIsNone(value)
        self.assertEqual(self.load("none"), {})
        self.assertEqual(tables.score_text(None), "-")

    def test_times(self):
        self.write_result("s", "plain", 0)
        self.write_result("s", "plain", 1, cpu_seconds={"stereo": 100.})
        self.write_result("s", "plain", 2, cpu_seconds={"stereo": None})
        self.write_result("s", "tapa", 0, cpu_seconds={"stereo": None})
        by_method = self.load()
        # 4 views of a quarter of a megapixel.
        self.assertAlmostEqual(results.cpu_per_megapixel(by_method["plain"]), 110)
        self.assertIsNone(results.cpu_per_megapixel(by_method["tapa"]))

    def test_a_time_so_far_is_not_shown(self):
        self.write_result("s", "plain", done=[])
        self.assertIsNone(results.step_value(self.load()["plain"], "seconds"))

    def test_pooled_methods_have_all_sets(self):
        self.write_result("a", "plain", depth={(0.02, "m"): 0.25})
        self.write_result("b", "plain", depth={(0.02, "m"): 0.5})
        self.write_result("a", "tapa", depth={(0.02, "m"): 0.5})
        self.write_result("b", "tapa")  # Not scored.
        pooled = results.pool(map(self.load, "ab"))
        self.assertEqual(list(pooled), ["plain"])
        self.assertAlmostEqual(results.depth_score(pooled["plain"], 0.02).completeness, 0.375)

    def test_mean_over_sets_needs_all(self):
        self.write_result("a", "tapa", f1={"fused": 0.5})
        self.write_result("b", "tapa", f1={"fused": 0.75})
        self.write_result("c", "plain", f1={"fused": 0.75})
        a, b, c = map(self.load, "abc")
        self.assertAlmostEqual(results.mean_over_sets([a, b], "tapa", 0.02).f1, 0.625)
        self.assertIsNone(results.mean_over_sets([a, b, c], "tapa", 0.02))
        self.assertIsNone(results.mean_over_sets([], "tapa", 0.02))


class TablesTest(ResultsCase):
    def test_tolerances_as_text(self):
        for value, unit, text in ((0.07, "m", "7 cm"), (1.5, "m", "1.5 m"),
                                  (0.012345678, "m", "1.2345678 cm"),
                                  (0.5, "%", "0.5 %"), (2.0000001, "%", "2.0000001 %")):
            self.assertEqual(tables.tolerance_text(value, unit), text)

    def test_depth_table(self):
        self.write_result("s", "plain", depth={(0.02, "m"): 0.25, (1, "%"): 0.5},
                          low={0.75: {(0.02, "m"): 0.125, (1, "%"): 0.125}})
        columns = [(0.02, "m"), (1, "%")]
        table = tables.depth_table(self.load(), ["plain", "tapa"], columns)
        self.assertEqual(table.header, ["method", "2 cm", "1 %"])
        self.assertEqual(table.rows, [["plain", "25.0 / 50.0 / 33.3", "50.0 / 100.0 / 66.7"],
                                      ["TAPA", "-", "-"]])
        self.assertIn("| TAPA | - | - |\n", table.markdown())
        rows = list(csv.reader(io.StringIO(table.csv())))
        self.assertEqual(rows[0], ["method", "tolerance", "unit", "completeness", "accuracy",
                                   "f1", "least_f1", "most_f1", "runs"])
        self.assertEqual(rows[1][:5], ["plain", "0.02", "m", "0.25", "0.5"])
        self.assertEqual(rows[3], ["tapa", "0.02", "m", "", "", "", "", "", "0"])
        low = tables.depth_table(self.load(), ["plain"], columns, 0.75)
        self.assertEqual(low.rows[0][1], "12.5 / 25.0 / 16.7")
        self.assertIn("below 0.75", low.caption)

    def test_cost_table(self):
        self.write_result("s", "plain", depth={(0.02, "m"): 0.25})
        unknown = {"stereo": None}
        self.write_result("s", "tapa", seconds=unknown, cpu_seconds=unknown,
                          peak_memory_bytes=unknown)
        table = tables.cost_table(self.load(), ["plain", "tapa", "x"])
        self.assertEqual(table.rows, [
            ["plain", "1", "4", "500x500", "50.0", "62.5", "-", "12.3", "0.40", "120", "70",
             "300"],
            ["TAPA", "1", "4", "500x500"] + ["-"] * 8,
            ["x", "0"] + ["-"] * 10])
        self.assertEqual(table.csv().splitlines()[::3], [
            "method,runs,views,size,coverage,measurement_coverage,low_texture_coverage,"
            "median_absolute_error,median_relative_error,cpu_seconds_per_megapixel,"
            "stereo_seconds,peak_memory_bytes", "x,0" + "," * 10])

    def test_trade_table(self):
        self.write_result("s", "colmap", depth={(0.02, "m"): 0.25}, low={0.75: {(0.02, "m"): 0.5}})
        self.write_result("s", "plain", depth={(0.02, "m"): 0.5, (0.05, "m"): 0.5},
                          cpu_seconds={"stereo": 30.})
        table = tables.trade_table(self.load(), ["colmap", "plain", "x"], [(0.02, "m")])
        self.assertEqual(table.header[3:], ["2 cm", "mean", "low texture"])
        self.assertEqual(table.rows, [
            ["COLMAP", "120", "1.00", "33.3", "33.3", "66.7"],
            ["plain", "30", "0.25", "66.7", "66.7", "-"],
            ["x"] + ["-"] * 5])
        # A mean over fewer tolerances would be another thing.
        table = tables.trade_table(self.load(), ["colmap", "plain"], [(0.02, "m"), (0.05, "m")])
        self.assertEqual([row[5] for row in table.rows], ["-", "66.7"])

    def test_published_figures_agree_with_each_other(self):
        # The overall mean is over 5 scenes of low and 13 or 12 of high resolution.
        for name, cells in published.TABLE1.items():
            for first, high in ((0, 13), (3, 12)):
                mean = (5 * cells[first + 1] + high * cells[first + 2]) / (5 + high)
                if (name, first) == ("CMPMVS", 0):
                    mean -= 0.3  # The paper has 47.48.
                self.assertAlmostEqual(cells[first], mean, delta=0.011)
        at_2_cm = published.TABLE2_TOLERANCES.index(0.02)
        for ours, theirs in (("paper", "TAPA-MVS"), ("colmap", "COLMAP")):
            self.assertEqual(published.TABLE2[ours][at_2_cm][2], published.TABLE1[theirs][2])
        for column in published.TABLE2.values():
            self.assertEqual(len(column), 6)
            self.assertEqual(list(column), sorted(column))
        self.assertLessEqual(set(TAPA_ABLATION), set(METHODS))

    def test_table1(self):
        low = scenes.select(scenes.all_scenes(), "low")
        for i, scene in enumerate(low):
            self.write_result(scene.set_name, "tapa", f1={"fused": 0.5 + 0.01 * i})
        table = paper_tables.table1(groups_of(self.out))
        self.assertEqual(table.rows[0], ["TAPA", "this program", "-", "52.00", "-", "-", "-", "-"])
        self.assertEqual(table.rows[1][2:], ["-"] * 6)
        self.assertIn(["COLMAP", "published", "62.73", "49.91", "67.66", "66.92", "52.32",
                       "73.01"], table.rows)
        own = [row for row in table.csv_rows if row[1] == "own"]
        self.assertIsNone(own[0][2])
        self.assertAlmostEqual(own[0][3], 0.52)
        # One scene less, and there is no mean.
        os.remove(self.path("out", low[0].set_name, "tapa-0", "cloud_scores.json"))
        self.assertEqual(paper_tables.table1(groups_of(self.out)).rows[0][2:], ["-"] * 6)

    def test_table2(self):
        self.write_result("s", "plain", f1={"fused": 0.25})
        self.write_result("s", "tapa", f1={"fused": 0.5})
        table = paper_tables.table2([self.load()], TAPA_ABLATION, with_published=True)
        self.assertEqual(len(table.rows), 12)
        self.assertEqual(table.header[1], "plain")
        self.assertEqual(table.rows[1], ["2 cm", "25.00 / 25.00 / 25.00", "-", "-", "-", "-",
                                         "50.00 / 50.00 / 50.00"])
        self.assertEqual(table.rows[2], ["5 cm"] + ["-"] * 6)
        self.assertEqual(table.rows[7][0], "2 cm, published")
        self.assertEqual(table.rows[7][6], "71.45 / 85.88 / 77.69")
        self.assertEqual(len(table.csv_rows), 6 * 6 * 2)


class FiguresTest(ResultsCase):
    def test_points(self):
        self.write_scores()
        runs = self.load()["plain"]
        points = figures.error_points(runs)
        self.assertEqual((points[0], points[-1]), ((0.01, 0.1), (5, 0.9)))
        self.assertEqual(figures.error_points(None)[0], (0.01, None))
        self.assertEqual(figures.textureness_points(runs, 0.1), [(0.6, 0.3), (1, 0.5)])
        self.assertTrue(all(share is None for _, share in
                            figures.textureness_points(None, 0.1)))

    def write_scores(self):
        self.write_result("s", "plain", depth={
            (error, "m"): i / 10 for i, error in enumerate(depth_scores.TOLERANCES, 1)},
            low={bound: {(0.1, "m"): bound / 2, (0.2, "m"): bound, (0.5, "m"): bound}
                 for bound in (0.6, 1)})

    def test_which_methods_are_drawn(self):
        methods = ["plain", "tapa", "tapa-fine", "paper", "other-tool"]
        self.assertEqual(figures.chosen_methods(methods), ["plain", "tapa", "paper", "other-tool"])
        self.assertEqual(pictures.chosen_methods(methods), ["plain", "tapa", "other-tool"])
        self.assertEqual(figures.chosen_methods(["tapa-fine"]), ["tapa-fine"])
        self.assertEqual(pictures.chosen_methods(["paper"]), ["paper"])

    def test_files(self):
        self.write_scores()
        for draw, text in ((figures.draw_errors, "Higher is better"),
                           (figures.draw_textureness, "0.5 is a flat wall")):
            path = self.path("f", draw.__name__ + ".png")
            self.assertIn(text, draw(path, self.load(), ["plain", "tapa"], "s"))
            with open(path, "rb") as file:
                self.assertEqual(file.read(8), b"\x89PNG\r\n\x1a\n")
            self.assertIsNone(draw(self.path("no.png"), self.load("none"), ["plain"], "none"))
        self.assertFalse(os.path.exists(self.path("no.png")))


class ReportTest(ResultsCase):
    def report_of(self, name="s", failures=(), **settings):
        experiment = Experiment(name=name, data=self.path("s"),
                                **{"methods": ["plain"], **settings})
        part = report.SetReport(experiment, self.out, self.out, self.path("out/figures"),
                                self.path("out/tables"))
        report.write_report(self.path("out/report.md"), [part], failures)
        return self.read("out/report.md")

    def test_page(self):
        self.write_result("s", "plain", depth={(0.02, "m"): 0.25},
                          f1={"fused": 0.5, "fused_default": 0.25})
        self.write_result("s", "tapa", failed={"step": "stereo", "message": "it broke"})
        text = self.report_of(tolerances=[0.02], methods=["plain", "tapa", "paper"],
                              failures=[("x", "it broke"), ("y", "oh")])
        for part in ("| plain | 25.0 / 50.0 / 33.3 | - |", "| paper's TAPA | - | - |",
                     "- s: tapa, seed 0: stereo: it broke\n", "- s: paper, seed 0: not run\n",
                     "- y: oh\n", "fused with COLMAP's own thresholds",
                     "| plain | 50.0 / 50.0 / 50.0 |", "COLMAP 3.8 on abacus, 2 cores, 8 GB.",
                     "![How far the depth maps are off](figures/s_errors.png)"):
            self.assertIn(part, text)
        self.assertEqual(text.count("it broke"), 1)
        self.assertTrue(os.path.exists(self.path("out/figures/s_errors.png")))
        self.assertIn("plain,0.02,m,0.25,0.5", self.read("out/tables/s_depth.csv"))

    def test_runs_in_parts(self):
        gpu = made_with(gpu="NVIDIA X")
        for parts, text in (
                ({"stereo": [gpu, made_with("COLMAP 3.9")], "fused": [made_with("COLMAP 3.9")]},
                 "Run with COLMAP 3.8; COLMAP 3.9 on abacus, 2 cores, 8 GB, stereo on "
                 "NVIDIA X; the CPU. Not made in one piece, by one version on one machine: "
                 "plain, seed 3.\n"),
                # Fusion does not use the GPU.
                ({"stereo": [gpu], "fused": [made_with()]},
                 "Run with COLMAP 3.8 on abacus, 2 cores, 8 GB, stereo on NVIDIA X.\n")):
            self.write_result("s", "plain", 3, made_with=parts)
            self.assertIn(text, self.report_of(seeds=[3]))

    def test_names_with_spaces(self):
        self.write_result("a b", "plain", depth={(0.02, "m"): 0.25})
        self.assertIn("](figures/a%20b_errors.png)", self.report_of("a b"))

    def test_another_tool_s_maps_of_some_photographs(self):
        self.write_result("s", "other", depth={(0.02, "m"): 0.25}, compare=["x"], views=3,
                          photographs=4)
        self.assertIn("- s: other: maps of 3 of 4 photographs",
                      self.report_of(methods=[], compare=[("other", "x")]))

    def test_results_of_other_options_are_left_out(self):
        self.write_result("s", "plain", depth={(0.02, "m"): 0.25},
                          options=["--PatchMatchStereo.num_iterations", "1"])
        text = self.report_of()
        self.assertIn("plain, seed 0: the results in OUT were made with other options", text)
        self.assertNotIn("25.0", text)
        self.assertIn("25.0", self.report_of(options=None))  # Any.

    def eth3d_report_of(self, chosen, methods):
        for scene in chosen:
            os.makedirs(self.path("sets", scene.set_name, "images"))
        path = Eth3dReport(self.path("report"), self.out, self.path("sets"), chosen,
                           methods).write()
        self.assertEqual(path, self.path("report/report.md"))
        return self.read("report/report.md")

    def test_eth3d(self):
        scene = scenes.all_scenes()[0]
        self.write_result(scene.set_name, "colmap", depth={(0.02, "m"): 0.25}, f1={"fused": 0.5},
                          options=["--any", "1"])
        text = self.eth3d_report_of([scene], ["colmap", "tapa"])
        for part in ("| COLMAP, TAPA's thresholds | this program | - |",
                     "| 2 cm | 50.00 / 50.00 / 50.00 | - |",
                     f"{scene.set_name}: tapa, seed 0: not run",
                     f"- `colmap`: 10 source views {COLMAP_OPTIONS} --any 1\n", "figures/errors.png"):
            self.assertIn(part, text)
        self.assertIn("25.0 / 50.0", self.read("report", scene.set_name + ".md"))
        self.assertTrue(os.path.exists(self.path("report/tables/table1.csv")))

    def test_eth3d_scenes_with_other_options(self):
        two = scenes.all_scenes()[:2]
        for scene, options in zip(two, (["--any", "1"], [])):
            self.write_result(scene.set_name, "colmap", options=options)
        text = self.eth3d_report_of(two, ["colmap"])
        for scene, words in zip(two, (" --any 1", "")):
            self.assertIn(f"- `colmap`: 10 source views {COLMAP_OPTIONS}{words}; **other scenes with other "
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
_SMALL = ["--PatchMatchStereo.max_image_size", "9"]


class PlanTest(ResultsCase):
    def plan_of(self, text=_PLAN):
        return plan.Plan(self.write("docs/plan.toml", text), self.folder, "/none")

    def test_page(self):
        os.makedirs(self.path("s", "images"))
        self.write_result("one", "plain", depth={(0.02, "m"): 0.25})
        page = self.plan_of()
        self.assertEqual(page.sets["one"].data, self.path("s"))
        # The plan's own page is not touched before every set has results.
        path, missing = page.write(self.out)
        self.assertEqual(path, self.path("out", "results.md"))
        self.assertEqual(missing, ["- two: plain, seed 0: not run",
                                   "- two: tapa, seed 0: not run"])
        text = self.read("out", "results.md")
        for part in ("# Results\n\nWords.\n\n## First\n\n    scripts/evaluate DATA/s --out "
                     "OUT/one --methods plain", "| plain | 25.0 / 50.0 / 33.3 |",
                     "(images/x/one_errors.png)", "In between.\n\n## Second\n",
                     "*`two` has not been run.*"):
            self.assertIn(part, text)
        self.write_result("two", "plain", depth={(0.02, "m"): 0.5}, options=_SMALL)
        path, missing = page.write(self.out)
        self.assertEqual(path, self.path("docs", "results.md"))
        self.assertEqual(missing, ["- two: tapa, seed 0: not run"])
        self.assertTrue(os.path.exists(self.path("docs/images/x/one_errors.png")))

    def test_a_page_about_some_sets(self):
        os.makedirs(self.path("s", "images"))
        for name, options in (("one", []), ("two", _SMALL)):
            self.write_result(name, "plain", options=options, depth={(0.02, "m"): 0.25})
        page = self.plan_of(_PLAN.replace(
            '"Words."', '"[a](tapa.md#b) [c](http://x/y.md) [d](z.md)"'))
        path, missing = page.write(self.out, only=["one"])
        self.assertEqual((path, missing), (self.path("out", "results.md"), []))
        text = self.read("out", "results.md")
        for part in ("[a](../docs/tapa.md#b) [c](http://x/y.md) [d](../docs/z.md)",
                     "(images/x/one_errors.png)", "## First"):
            self.assertIn(part, text)
        for part in ("In between", "## Second"):
            self.assertNotIn(part, text)

    def test_bad_plans(self):
        for old, new, text in (
                ("page =", "pages =", "has no key page"),
                ("title = \"Results\"", "title = Results", "is not TOML"),
                ("data = \"s\"\nmethods", "methods", "sets.one has no key data"),
                ("tolerances", "tolerance", "sets.one has an unknown key tolerance"),
                ("set = \"two\"", "set = \"three\"", "section.2: .* set three, which is not"),
                ("\"errors\"]", "\"error\"]", "show.1: there is no error; there are depth"),
                ("[sets.one]", "[sets.\"../one\"]", "sets: the name ../one must be of letters"),
                ("[sets.one]", "sets.x = 1\n[sets.one]", "sets.x: value is not a valid dict"),
                ("[sets.one]", "every = 1\n[sets.one]", "it has an unknown key every"),
                ("[\"plain\"]\ntol", "\"plain\"\ntol", "sets.one.methods: .* not a valid list"),
                ("[\"plain\"]\ntol", "[\"plane\"]\ntol",
                 "sets.one.methods.0: there is no method plane; there are plain"),
                ("[0.02]", "[-0.02]", "sets.one.tolerances.0: value is not positive"),
                ("[0.02]", "[]", "sets.one.tolerances: ensure .* at least 1 item"),
                ("data = \"s\"\nopt", "data = \"s\"\nevery = 0\nopt", "sets.two.every: ensure"),
                ("data = \"s\"\nopt", "data = \"s\"\nseeds = 0\nopt",
                 "sets.two.seeds: value is not a valid list"),
                ("\"In between.\"", "3", "section.1.text: str type expected"),
                ("\"Second\"", "\"x\"\nlevel = true", "section.2.level: .* integer")):
            with self.assertRaisesRegex(Failure, f"^{self.path('docs/plan.toml')} .*{text}"):
                self.plan_of(_PLAN.replace(old, new))
        files.write_bytes(self.path("latin.toml"), b'title = "\xe9"')
        with self.assertRaisesRegex(Failure, "latin.toml is not TOML"):
            plan.Plan(self.path("latin.toml"), self.folder, "/none")
        with self.assertRaisesRegex(Failure, "none.toml cannot be read"):
            plan.Plan(self.path("none.toml"), self.folder, "/none")

    def test_the_project_s_own(self):
        page = plan.Plan(os.path.join(ROOT, "docs", "results_plan.toml"), None, ROOT)
        self.assertEqual(page.sets["room"].views, ["room_05.jpg"])
        for planned in page.sets.values():
            self.assertLessEqual(set(planned.methods), set(METHODS))
