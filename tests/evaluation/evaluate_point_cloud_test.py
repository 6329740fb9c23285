"""What scripts/evaluate_point_cloud prints, writes and refuses."""

import json
import os
import subprocess

import numpy as np

from helpers import ROOT, ProgramTest
from evaluation import evaluate_point_cloud, meshlab_project, point_clouds

GREEN, RED, BLUE = (0, 255, 0), (255, 0, 0), (0, 0, 255)


class EvaluatePointCloudTest(ProgramTest):
    """A scan of two points 4 m away in cubes of their own, one of which is reconstructed exactly,
    with another point in the empty space before it."""
    main = evaluate_point_cloud.main

    def setUp(self):
        super().setUp()
        self.cloud, self.scan = self.path("r.ply"), self.path("gt/s.ply")
        self.project = self.path("gt/p.mlp")
        self.write_points(self.cloud, (4, 0, 0.25), (3, 0, 0.1875))
        self.write_points(self.scan, (4, 0, 0.25), (4, 2, 0.25))
        meshlab_project.write(self.project, [("s.ply", np.eye(4))])
        self.inputs = ["--reconstruction_ply_path", self.cloud, "--ground_truth_mlp_path",
                       self.project]
        self.all = [*self.inputs, "--tolerances", "0.125,1.5"]

    def write_points(self, path, *points):
        point_clouds.write_ply(path, np.reshape(points, (-1, 3)).astype(np.float32))

    def expect_warnings(self, *parts):
        """The scores are given. Returns what is printed on standard output."""
        status, out, errors = self.run_main(*self.all)
        self.assertEqual((status, errors.count("\n")), (0, len(parts)), errors)
        for line, part in zip(errors.splitlines(), parts):
            self.assertTrue(line.startswith("WARNING: "), line)
            self.assertIn(part, line)
        return out

    def test_output(self):
        out = ("Loading reconstruction: {}\nLoading scan: {}\nComputing completeness\n"
               "Computing accuracy\nTolerances: 0.125 1.5\nCompletenesses: 0.5 0.5\n"
               "Accuracies: 0.5 1\nF1-scores: 0.5 0.666667\n")
        self.assertEqual(self.run_well(*self.all), out.format(self.cloud, self.scan))
        # As a program, started in another folder, whose options are in another order.
        result = subprocess.run(
            [os.path.join(os.path.abspath(ROOT), "scripts", "evaluate_point_cloud"),
             "--tolerances=1.5,0.125", "--reconstruction_ply_path", "r.ply",
             "--ground_truth_mlp_path", "gt/p.mlp"], cwd=self.folder, check=True, text=True,
            stdout=subprocess.PIPE)
        self.assertEqual(result.stdout, out.format("r.ply", "gt/s.ply"))

    def test_json(self):
        path = self.write("out/s.json", "old")
        self.run_well(*self.inputs, "--tolerances", "0.1,0.2,0.2,1.5", "--json", path)
        self.assertEqual(json.loads(self.read(path)), {
            "tolerances": [0.1, 0.2, 0.2, 1.5], "completeness": [0.5] * 4,
            "accuracy": [0.5, 0.5, 0.5, 1], "f1": [0.5, 0.5, 0.5, 2 / 3]})
        self.assertEqual(os.listdir(self.path("out")), ["s.json"])

    def test_options_of_the_beam_and_the_voxels(self):
        # The point in empty space is a decimetre beside the beam.
        self.write_points(self.cloud, (4, 0, 0.25), (3, 0.1, 0.1875))
        for options, accuracies in (
                ([], "1 1"), (["--beam_start_radius_meters", "0.09"], "1 1"),
                (["--beam_start_radius_meters", "0.11"], "0.5 1"),
                (["--beam_start_radius_meters=0", "--beam_divergence_halfangle_deg=1.8"], "1 1"),
                (["--beam_start_radius_meters=0", "--beam_divergence_halfangle_deg=2"], "0.5 1")):
            self.assertIn(f"Accuracies: {accuracies}\n", self.run_well(*self.all, *options))
        self.write_points(self.scan, (4, 0, 0.25), *[(4, 2, 0.25)] * 3)
        for options, completenesses in (([], "0.5 0.5"), (["--num_threads", "3"], "0.5 0.5"),
                                        (["--voxel_size", "100"], "0.25 0.25")):
            self.assertIn(f"Completenesses: {completenesses}\n",
                          self.run_well(*self.all, *options))

    def test_coloured_clouds(self):
        self.write_points(self.cloud, (4, 0, 0.25), (3, 0, 0.1875), (-3, 0, 0))
        raised = np.eye(4)
        raised[2, 3] = 0.5
        meshlab_project.write(self.project, [("s.ply", raised), ("s.ply", np.eye(4))])
        self.run_well(*self.all, "--completeness_cloud_output_path", self.path("out/deep/c"),
                      "--accuracy_cloud_output_path", self.path("out/a"))
        for name, colors in (("deep/c.tolerance_0.125", (RED, RED, GREEN, RED)),
                             ("deep/c.tolerance_1.5", (GREEN, RED, GREEN, RED)),
                             ("a.tolerance_0.125", (GREEN, RED, BLUE)),
                             ("a.tolerance_1.5", (GREEN, GREEN, BLUE))):
            with open(self.path("out", name + ".ply"), "rb") as file:
                rows = np.frombuffer(file.read().partition(b"end_header\n")[2], "3<f4, 3u1")
            np.testing.assert_array_equal(rows["f1"], colors)
            # The scans in the world, one after the other.
            self.assertEqual(rows["f0"][1, 2], 0.75 if name[0] == "d" else 0.1875)
        self.assertEqual(sorted(os.listdir(self.path("out")) + os.listdir(self.path("out/deep"))),
                         ["a.tolerance_0.125.ply", "a.tolerance_1.5.ply",
                          "c.tolerance_0.125.ply", "c.tolerance_1.5.ply", "deep"])

    def test_bad_arguments(self):
        self.assertIn("--reconstruction_ply_path", self.run_well("--help"))
        self.expect_error([], "required: --reconstruction_ply_path, --ground_truth_mlp_path, "
                              "--tolerances")
        for values in ("", "0.1,", "0.1,x", "-1", "0", "nan"):
            self.expect_error([*self.inputs, "--tolerances", values], "list of positive numbers")
        self.expect_error([*self.inputs, "--tolerances", "1" + 250 * ",1"], "at most 250")
        for words, part in (
                (["--voxel_size", "0"], "a positive number, not 0"),
                (["--voxel_size", "nan"], "a positive number, not nan"),
                (["--beam_start_radius_meters", "-1"], "at least 0, not -1"),
                (["--beam_divergence_halfangle_deg", "-1"], "below 90, not -1"),
                (["--beam_divergence_halfangle_deg", "90"], "below 90, not 90"),
                (["--frobnicate", "1"], "frobnicate"), (["--voxel", "1"], "--voxel"),
                (["--num_threads", "x"], "num_threads"), (["stray"], "stray"),
                (["--json", self.folder + "/./r.ply"], "--json would overwrite " + self.cloud),
                (["--json", self.project], "--json would overwrite " + self.project)):
            self.expect_error([*self.all, *words], part)

    def test_bad_clouds_and_projects(self):
        for content, part in ((None, "cannot be read: No such file"), ("x", "is not a PLY file"),
                              ("ply\nformat ascii 1.0\nelement vertex 1\n", "is truncated")):
            os.remove(self.cloud)
            if content is not None:
                self.write("r.ply", content)
            self.expect_error([*self.all, "--json", self.path("s.json")], f"{self.cloud} {part}",
                              status=2)
            self.write("r.ply")
        self.assertFalse(os.path.exists(self.path("s.json")))
        self.setUp()
        meshlab_project.write(self.project, [("s.ply", np.eye(4)), ("none.ply", np.eye(4))])
        self.expect_error(self.all, "gt/none.ply cannot be read: No such file")
        meshlab_project.write(self.project, [("s.ply", np.diag((2, 2, 2, 1)))])
        self.expect_error(self.all, "gt/p.mlp: scan s.ply has a pose that is not a rotation")
        self.write("gt/p.mlp", "nonsense")
        self.expect_error(self.all, "gt/p.mlp is not a MeshLab project")

    def test_clouds_without_points(self):
        self.write_points(self.cloud)
        self.assertTrue(self.expect_warnings("r.ply has no points; all scores are 0").endswith(
            "Completenesses: 0 0\nAccuracies: 0 0\nF1-scores: 0 0\n"))
        self.write_points(self.cloud, (4, 0, 0.25))
        self.write_points(self.scan)
        self.expect_error(self.all, "gt/s.ply has no points")

    def test_points_that_are_not_finite(self):
        nan = float("nan")
        self.write_points(self.cloud, (4, 0, 0.25), (nan, 0, 0), (3, 0, 0.1875))
        self.write_points(self.scan, (4, 0, 0.25), (float("inf"), 0, 0), (4, 2, 0.25))
        out = self.expect_warnings("r.ply has 1 points with a coordinate that is infinite or not",
                                   "gt/s.ply has 1 points")
        self.assertIn("Completenesses: 0.5 0.5\nAccuracies: 0.5 1\n", out)

    def test_other_units_and_frames(self):
        metres = [(0.3, 0.01 * i, 0) for i in range(100)]
        self.write_points(self.cloud, *metres)
        self.write_points(self.scan, *(1000 * np.array(metres)))
        self.expect_warnings("s.ply is 1e+03 times larger than the reconstruction",
                             "no point of the scans is within 1.5 m")
        self.setUp()
        self.write_points(self.cloud, (4, 50, 0.25), (4, 52, 0.1875))
        self.assertIn("F1-scores: 0 0\n", self.expect_warnings(
            "no point of the scans is within 1.5 m",
            "no point of the reconstruction can be judged"))
        self.write_points(self.cloud, (4e5, 50, 0.25), (4, 0, 0.25))
        self.expect_warnings("r.ply has coordinates of up to 4e+05", "s.ply is 2e+05 times")

    def test_output_that_cannot_be_written(self):
        self.write("file")
        for option, path in (("--json", "file/s.json"),
                             ("--completeness_cloud_output_path", "file/c"),
                             ("--accuracy_cloud_output_path", "file/a")):
            self.expect_error([*self.all, option, self.path(path)], "cannot be written: ")
