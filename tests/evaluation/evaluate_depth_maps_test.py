"""What scripts/evaluate_depth_maps prints, writes, draws and refuses."""

import json
import os
import subprocess

import cv2
import numpy as np

from helpers import ROOT, ProgramTest, TestCase, write_map
from evaluation import depth_maps, evaluate_depth_maps, view_picture, workspaces
from evaluation.processes import Failure

MAPS = "w/stereo/depth_maps/"


class EvaluateDepthMapsTest(ProgramTest):
    """A workspace of two views of 6x4 pixels, of which a.jpg is exact but for one pixel and b.jpg
    is empty."""
    main = evaluate_depth_maps.main

    def setUp(self):
        super().setUp()
        for name in ("w/images/a.jpg", "w/images/b.jpg"):
            random = np.random.default_rng(1)
            self.write_image(name, random.integers(100, 200, (4, 6, 3), np.uint8))
        self.depth = np.full((4, 6), 2.0)
        self.depth[0, 0] = 2.25
        self.write_map("a.jpg.geometric.bin", self.depth)
        self.write_map("b.jpg.geometric.bin", np.zeros((4, 6)))
        for name in ("gt/a.png", "gt/b.png"):
            self.write_image(name, np.full((4, 6), 8000, np.uint16))
        self.both = ["--workspace_path", self.path("w"), "--ground_truth_path", self.path("gt")]

    def write_image(self, name, values):
        self.write(name)
        self.assertTrue(cv2.imwrite(self.path(name), values))

    def write_map(self, name, values):
        write_map(self.path(MAPS + name), values)

    def scores(self, *words):
        """What is printed, and the content of the file of scores."""
        out = self.run_well(*words, "--json", self.path("s.json"))
        return out, json.loads(self.read("s.json"))

    def test_table_and_json(self):
        out, content = self.scores(*self.both, "--tolerances", "0.1,0.25",
                                   "--relative_tolerances=1")
        self.assertEqual(out, """\
View   Pixels  Coverage %  of truth %  Median mm  Median %  F1 10 cm  F1 25 cm  F1 1 %
--------------------------------------------------------------------------------------
a.jpg      24       100.0       100.0       0.00     0.000      95.8     100.0    95.8
b.jpg      24         0.0         0.0          -         -       0.0       0.0     0.0
all        48        50.0        50.0       0.00     0.000      63.9      66.7    63.9

Tolerance  Completeness %  Accuracy %   F1 %
--------------------------------------------
10 cm               47.92       95.83  63.89
25 cm               50.00      100.00  66.67
1 %                 47.92       95.83  63.89
""")
        self.assertEqual((content["input_type"], content["by_textureness"]), ("geometric", []))
        self.assertEqual([image["name"] for image in content["images"]], ["a.jpg", "b.jpg"])
        first, second = content["images"]
        self.assertEqual(first["tolerances"][2], {"tolerance": 1, "unit": "%", **dict.fromkeys(
            ("completeness", "accuracy", "f1"), 23 / 24)})
        self.assertIsNone(second["tolerances"][0]["accuracy"])
        self.assertIsNone(second["median_absolute_error"])
        overall = content["overall"]
        self.assertEqual((overall["num_maps"], overall["num_pixels"], overall["coverage"]),
                         (2, 48, 0.5))
        # As a program.
        result = subprocess.run([os.path.join(ROOT, "scripts", "evaluate_depth_maps"), *self.both,
                                 "--tolerances", "0.1,0.25", "--relative_tolerances", "1"],
                                check=True, stdout=subprocess.PIPE, text=True)
        self.assertEqual(result.stdout, out)

    def test_photometric_maps_and_another_scale(self):
        self.write_map("a.jpg.photometric.bin", np.full((2, 3), 8))
        out, content = self.scores(*self.both, "--input_type", "photometric", "--depth_scale",
                                   "1000")
        self.assertEqual((content["overall"]["num_pixels"], content["overall"]["num_measurements"],
                          content["overall"]["tolerances"][0]["f1"]), (6, 24, 1))
        self.assertIn("1 ground truth map without depth map: not scored.\n", out)

    def test_what_is_not_scored_is_told(self):
        self.depth[0, 3:5] = -2, np.nan
        self.write_map("a.jpg.geometric.bin", self.depth)
        os.remove(self.path("gt/b.png"))
        out, content = self.scores(*self.both)
        self.assertTrue(out.endswith(
            "1 depth map without ground truth: not scored.\n2 pixels with a negative or not "
            "finite depth: counted as without estimate.\n"))
        self.assertEqual(content["overall"]["num_invalid"], 2)
        self.assertEqual(content["images"][0]["num_estimates"], 22)

    def test_bounds_of_textureness(self):
        # The left half of the photograph is flat; the patch reaches two pixels.
        row, col = np.indices((4, 40))
        self.write_image("w/images/a.png", np.where(col < 20, 100, (row + col) % 2 * 255))
        os.remove(self.path("gt/b.png"))
        self.write_map("a.png.geometric.bin", np.full((4, 40), 2))
        os.remove(self.path(MAPS + "a.jpg.geometric.bin"))
        self.write_image("gt/a.png", np.full((4, 40), 8000, np.uint16))
        out, content = self.scores(*self.both, "--max_textureness", "0.75,1")
        self.assertIn("\n\nTextureness below 0.75: coverage 100.0 % of 72 pixels, 100.0 % of "
                      "those with a measurement\nTolerance  Completeness %", out)
        low, every = content["by_textureness"]
        self.assertEqual((low["max_textureness"], low["score"]["num_maps"],
                          low["score"]["num_measurements"]), (0.75, 1, 4 * 18))
        # Textureness does not reach 1.
        self.assertEqual(every, {"max_textureness": 1, "score": content["overall"]})

    def test_pictures(self):
        write_map(self.path("w/stereo/normal_maps/a.jpg.geometric.bin"), np.full((3, 4, 6), -1))
        self.run_well(*self.both, "--pictures", self.path("p/q"))
        self.assertEqual(self.run_well("--workspace_path", self.path("w"), "--pictures",
                                       self.path("r")), "")
        sizes = {name: cv2.imread(self.path(name)).shape[:2]
                 for name in ("p/q/a.png", "p/q/b.png", "r/a.png", "r/b.png")}
        self.assertGreater(sizes["p/q/a.png"][1], sizes["r/a.png"][1])  # It has more panels.
        self.assertGreater(sizes["p/q/b.png"][0], sizes["r/b.png"][0])

    def test_pictures_of_any_size(self):
        for height, width in ((1, 1), (3000, 5), (5, 3000), (480, 720)):
            self.write_image("photograph.png", np.full((height, width, 3), 9, np.uint8))
            write_map(self.path("normals.bin"), np.full((3, height, width), -1))
            depth = np.full((height, width), 2, np.float32)
            for normals in ("normals.bin", "none.bin"):
                view = workspaces.View("$a^/very/" + "long/" * 30 + "\udcff.jpg",
                                       self.path("photograph.png"), "", self.path(normals))
                for truth in (None, np.full((2 * height, 2 * width), 2, np.float32)):
                    view_picture.draw(self.path("out.png"), view, depth, truth)
                    picture = cv2.imread(self.path("out.png"))
                    self.assertLessEqual(max(picture.shape[:2]), 2000)
                    self.assertGreater(picture.shape[1], 300)

    def test_bad_arguments(self):
        self.assertIn("--workspace_path", self.run_well("--help"))
        workspace = self.both[:2]
        for words, part in (
                ([], "required: --workspace_path"), (workspace[:1], "--workspace_path"),
                (workspace, "--ground_truth_path is required"),
                ([*workspace, "--pictures", "p", "--json", "s.json"], "need --ground_truth_path"),
                ([*self.both, "--frobnicate", "1"], "frobnicate"),
                ([*self.both, "--tol", "1"], "--tol"), ([*self.both, "stray"], "stray"),
                ([*self.both, "--input_type", "fused"], "--input_type"),
                ([*self.both, "--depth_scale", "0"], "a positive number, not 0"),
                ([*self.both, "--max_textureness", "0.5"], "above 0.5"),
                ([*self.both, "--max_textureness", "0.75,1.1"], "at most 1"),
                ([*self.both, "--pictures", self.path("gt/")], "would overwrite"),
                ([*self.both, "--pictures", self.path("w/./images")], "would overwrite"),
                *(([*self.both, option, values], "list of positive numbers") for values in
                  ("", "0.1,x") for option in ("--max_textureness", "--tolerances",
                                               "--relative_tolerances"))):
            self.expect_error(words, part)

    def test_missing_files(self):
        truth = self.both[2:]
        for words, part in (
                (["--workspace_path", self.path("none"), *truth], "no workspace at"),
                (["--workspace_path", self.path("gt"), *truth], "no folder of depth maps"),
                ([*self.both[:3], self.path("none")], "no folder of ground truth"),
                ([*self.both, "--input_type", "photometric"], "no photometric depth map")):
            self.expect_error(words, part)
        os.remove(self.path("w/images/a.jpg"))
        self.run_well(*self.both)
        for words in (["--pictures", self.path("p")], ["--max_textureness", "0.75"]):
            self.expect_error([*self.both, *words], "w/images/a.jpg cannot be read: No such file")
        for old, new in ("ax", "by"):
            os.rename(self.path(f"gt/{old}.png"), self.path(f"gt/{new}.png"))
        self.expect_error(self.both, "has the name of a depth map")

    def test_damaged_files(self):
        path = self.path(MAPS + "a.jpg.geometric.bin")
        self.write_map("a.jpg.geometric.bin", self.depth.T)
        self.expect_error(self.both, "a.jpg: a depth map of 4x6 pixels has another shape")
        os.truncate(path, 50)
        self.expect_error(self.both, f"{path} is truncated: ")
        self.setUp()
        self.write("w/stereo/normal_maps/a.jpg.geometric.bin", "6&4&3&abc")
        self.run_well(*self.both)
        self.expect_error([*self.both, "--pictures", self.path("p")], "is truncated: ")
        os.truncate(self.path("gt/a.png"), os.path.getsize(self.path("gt/a.png")) // 2)
        self.expect_error(self.both, "gt/a.png is not a readable image")

    def test_output_that_cannot_be_written(self):
        self.write("file")
        self.expect_error([*self.both, "--json", self.path("file/s.json")], "cannot be written: ")
        self.expect_error([*self.both, "--pictures", self.path("file")], "cannot be written: ")


class FilesTest(TestCase):
    def test_maps(self):
        path = self.path("a.bin")
        write_map(path, [[1, np.nan, 3], [4, np.inf, -6]])
        np.testing.assert_array_equal(depth_maps.read_map(path), [[1, np.nan, 3], [4, np.inf, -6]])
        np.testing.assert_array_equal(depth_maps.read(path), [[1, 0, 3], [4, 0, 0]])
        write_map(path, [[[1, 2]], [[3, 4]], [[5, 6]]])
        np.testing.assert_array_equal(depth_maps.read_map(path, 3), [[(1, 3, 5), (2, 4, 6)]])
        self.assertRaisesRegex(Failure, "3 channels, but 1", depth_maps.read_map, path)

    def test_damaged_maps(self):
        for content, part in (
                *((head, "is not a COLMAP") for head in (
                    "", "hello", "3&2", "0&2&1&", "-3&2&1&", "3&2&&", "9" * 20 + "&2&1&")),
                ("3&2&1&", "is truncated"), ("3&2&1&" + 23 * "x", "is truncated"),
                ("1000000&1000000&1&abcd", "is truncated"), ("3&2&1&" + 25 * "x", "is too long")):
            path = self.write("a.bin", content)
            self.assertRaisesRegex(Failure, f"^{path} {part}", depth_maps.read, path)
        for path in (self.folder, self.path("none.bin")):
            self.assertRaisesRegex(Failure, f"^{path} cannot be read: ", depth_maps.read_map, path)
        path = self.write("a.png")
        cv2.imwrite(path, np.uint16([[0, 4000], [1, 65535]]))
        np.testing.assert_array_equal(depth_maps.read(path, 1000),
                                      np.float32([[0, 4], [0.001, 65.535]]))
        cv2.imwrite(path, np.zeros((8, 8, 3), np.uint8))
        self.assertRaisesRegex(Failure, "is not a 16-bit grey", depth_maps.read, path)
        for content in ("", "no picture"):
            self.write("a.png", content)
            self.assertRaisesRegex(Failure, "is not a readable image", depth_maps.read, path)
        values = np.array([[1, np.nan], [np.inf, -2]], np.float32)
        values.tofile(path)
        np.testing.assert_array_equal(depth_maps.read_raw(path, 2, 2), [[1, 0], [0, 0]])
        with self.assertRaisesRegex(Failure, "16 bytes, but 3x2 depths need 24"):
            depth_maps.read_raw(path, 3, 2)

    def test_views_and_their_truth(self):
        for name in ("b.jpg.geometric.bin", "a.png.geometric.bin", "rig/c.jpg.geometric.bin",
                     "a.png.photometric.bin", ".geometric.bin"):
            self.write(MAPS + name)
        views = workspaces.list_views(self.path("w"), "geometric")
        self.assertEqual([view.name for view in views], ["a.png", "b.jpg", "rig/c.jpg"])
        self.assertEqual(views[2][1:], tuple(self.path("w", name) for name in (
            "images/rig/c.jpg", "stereo/depth_maps/rig/c.jpg.geometric.bin",
            "stereo/normal_maps/rig/c.jpg.geometric.bin")))
        for name in ("gt/a.png", "gt/rig/b.bin", "gt/b.png"):
            self.write(name)
        for name, found in (("a.jpg", "gt/a.png"), ("rig/a.jpg", "gt/a.png"),
                            ("rig/b.jpg", "gt/rig/b.bin"), ("b.jpg", "gt/b.png"), ("c.jpg", "")):
            self.assertEqual(depth_maps.find(self.path("gt"), name), found and self.path(found))

    def test_truth_that_could_be_that_of_two(self):
        self.write("gt/a.png")
        for names in (["a.jpg", "a.tif"], ["left/a.jpg", "right/a.jpg"]):
            with self.assertRaisesRegex(Failure, f"gt/a.png .*{names[0]} and {names[1]}"):
                depth_maps.find_all(self.path("gt"), names)
        self.write("gt/a.tif.bin")
        self.write("gt/right/a.jpg.png")
        names = ["a.jpg", "a.tif", "right/a.jpg"]
        self.assertEqual(depth_maps.find_all(self.path("gt"), names), {
            name: self.path("gt", file)
            for name, file in zip(names, ("a.png", "a.tif.bin", "right/a.jpg.png"))})
