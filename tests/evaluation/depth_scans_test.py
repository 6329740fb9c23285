"""Laser scans from depth maps, against points computed by hand."""

import math
import os
import subprocess
import unittest

import cv2
import numpy as np

from helpers import ROOT, TestCase
from evaluation import colmap_model, depth_maps, depth_scans, meshlab_project, point_clouds
from evaluation.processes import Failure


def read_ply(path):
    return point_clouds.read_ply(path)[0]


def read_project(path):
    """File names and matrices of a MeshLab project."""
    return [(os.path.basename(scan), pose) for scan, pose in meshlab_project.read(path)]


class DepthScans(TestCase):

    def setUp(self):
        super().setUp()
        self.out = self.path("scans")
        self.write_model()

    def write_model(self, camera="PINHOLE 2 2 2 2 1 1"):
        # The second camera looks along the world's x axis from (5, 0, 0).
        half = math.sqrt(0.5)
        self.write("sparse/cameras.txt", f"0 {camera}\n")
        self.write("sparse/images.txt", "1 1 0 0 0 0 0 0 0 a.jpg\n\n"
                   f"2 {half} 0 {-half} 0 0 0 -5 0 sub/b.jpg\n\n")

    def write_depth(self, name, metres):
        path = self.write("gt_depth/" + name)
        if name.endswith(".bin"):
            depth_maps.write_bin(path, np.array(metres, np.float32))
        else:
            cv2.imwrite(path, np.rint(4000 * np.array(metres)).astype(np.uint16))

    def test_points_by_hand(self):
        self.write_depth("a.png", [[4, 0], [0, 8]])
        project = depth_scans.make_scans(self.folder, self.out, ["a"])
        # Rays are (-1/4, -1/4, 1) and (1/4, 1/4, 1); forward is x, left y, up z.
        np.testing.assert_allclose(read_ply(self.path("scans/scan1.ply")),
                                   [[4, 1, 1], [8, -2, -2]])
        (name, matrix), = read_project(project)
        self.assertEqual(name, "scan1.ply")
        world = np.array([[4, 1, 1, 1], [8, -2, -2, 1]]) @ matrix.T
        np.testing.assert_allclose(world[:, :3], [[-1, -1, 4], [2, 2, 8]], atol=1e-12)

    def test_pose(self):
        self.write_depth("b.bin", [[20, 0], [0, 0]])
        project = depth_scans.make_scans(self.folder, self.out, ["sub/b.jpg"])
        (_, matrix), = read_project(project)
        points = read_ply(self.path("scans/scan1.ply"))
        # Forward is +x from (5, 0, 0), right is -z; the ray goes 5 left and 5 up (-y).
        world = matrix[:3, :3] @ points[0] + matrix[:3, 3]
        np.testing.assert_allclose(world, [25, -5, 5], atol=1e-6)

    def test_depth_of_another_size(self):
        self.write_model("PINHOLE 4 4 4 4 2 2")
        self.write_depth("a.png", [[4, 0], [0, 8]])
        depth_scans.make_scans(self.folder, self.out, ["a.jpg"])
        np.testing.assert_allclose(read_ply(self.path("scans/scan1.ply")),
                                   [[4, 1, 1], [8, -2, -2]])

    def test_occlusion_leaves_no_points_in_the_air(self):
        # A square at 2 m before a wall at 6 m.
        self.write_model("PINHOLE 40 40 40 40 20 20")
        depth = np.full((40, 40), 6.0)
        depth[10:30, 10:30] = 2.0
        self.write_depth("a.png", depth)
        depth_scans.make_scans(self.folder, self.out, ["a"], voxel_size=0.3)
        points = read_ply(self.path("scans/scan1.ply"))
        self.assertEqual(set(np.round(points[:, 0], 5)), {2.0, 6.0})
        # Behind the square nothing was measured: its shadow on the wall is 3 m wide.
        wall = points[points[:, 0] > 4]
        self.assertGreater(np.abs(wall[:, 1:]).max(axis=1).min(), 1.5)
        # Thinned points are some of those that were there.
        depth_scans.make_scans(self.folder, self.out, ["a"])
        everything = {tuple(point) for point in read_ply(self.path("scans/scan1.ply"))}
        self.assertEqual(len(everything), 1600)
        self.assertTrue({tuple(point) for point in points} < everything)

    def test_thin(self):
        points = np.array([[0.1, 0.1, 0.1], [0.4, 0.5, 0.5], [0.9, 0.9, 0.9],
                           [-0.1, 0.5, 0.5], [1.0, 0.5, 0.5]])
        np.testing.assert_array_equal(depth_scans.thin(points, 1.0), points[[1, 3, 4]])

    def test_all_views_are_scanners(self):
        self.write_depth("a.png", [[4, 0], [0, 8]])
        self.write_depth("b.bin", [[3, 0], [0, 0]])
        project = depth_scans.make_scans(self.folder, self.out)
        self.assertEqual([name for name, _ in read_project(project)], ["scan1.ply", "scan2.ply"])

    def test_unknown_scanner(self):
        self.write_depth("a.png", [[4, 0], [0, 8]])
        with self.assertRaisesRegex(Failure, "no photograph c"):
            depth_scans.make_scans(self.folder, self.out, ["c"])
        with self.assertRaisesRegex(Failure, "no depth of sub/b.jpg"):
            depth_scans.make_scans(self.folder, self.out, ["a", "b"])
        self.assertFalse(os.path.exists(self.path("scans/scan_alignment.mlp")))

    def test_command(self):
        self.write_depth("a.png", [[4, 0], [0, 8]])
        program = os.path.join(ROOT, "evaluation", "depth_scans.py")
        result = subprocess.run([program, self.folder, self.out, "--scanners", "a"],
                                capture_output=True, text=True, check=False)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual(len(read_project(result.stdout.strip())), 1)
        self.write_depth("a.png", [[0, 0], [0, 0]])
        result = subprocess.run([program, self.folder, self.out], capture_output=True, text=True,
                                check=False)
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, "^ERROR: .*no depth to scan\n$")


class Frame(unittest.TestCase):

    def test_scanner_is_right_handed(self):
        self.assertAlmostEqual(np.linalg.det(depth_scans.SCANNER_FROM_CAMERA), 1)

    def test_beam(self):
        camera = colmap_model.Camera("PINHOLE", 720, 480, (525.0, 525.0, 360.0, 240.0))
        view = colmap_model.View(0, "a", camera, np.eye(3), np.zeros(3))
        self.assertAlmostEqual(depth_scans.beam_halfangle(view, np.ones((240, 360))),
                               math.degrees(math.atan(1 / 525)))
