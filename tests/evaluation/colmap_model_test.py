"""Text models and camera models, against equations written out for one point."""

import math
import unittest

import numpy as np

from helpers import TestCase
from evaluation import colmap_model
from evaluation.processes import Failure

# Of the size and strength of the benchmark's photographs.
LENS = colmap_model.Camera("THIN_PRISM_FISHEYE", 6048, 4032, (
    3410.0, 3409.0, 3040.0, 2015.0, 0.21, 0.21, -1e-4, 5e-4, -0.16, 0.41, -8e-4, 9e-4))


def project_one(params, x, y, z):
    """A point through THIN_PRISM_FISHEYE, term by term."""
    fx, fy, cx, cy, k1, k2, p1, p2, k3, k4, sx1, sy1 = params
    u, v = x / z, y / z
    r = math.hypot(u, v)
    theta = math.atan2(r, 1)
    u, v = theta * u / r, theta * v / r
    t2 = theta ** 2
    radial = k1 * t2 + k2 * t2 ** 2 + k3 * t2 ** 3 + k4 * t2 ** 4
    du = u * radial + 2 * p1 * u * v + p2 * (t2 + 2 * u * u) + sx1 * t2
    dv = v * radial + 2 * p2 * u * v + p1 * (t2 + 2 * v * v) + sy1 * t2
    return fx * (u + du) + cx, fy * (v + dv) + cy


class ThinPrismFisheye(unittest.TestCase):

    def test_projects_as_the_equations_say(self):
        for x, y, z in ((0.3, -0.2, 1.0), (-2.0, 1.0, 4.0), (1e-3, 2e-3, 1.0), (0.9, 0.6, 1.2)):
            actual = colmap_model.project(LENS, np.array([x / z]), np.array([y / z]))
            expected = project_one(LENS.params, x, y, z)
            self.assertAlmostEqual(actual[0][0], expected[0], places=8)
            self.assertAlmostEqual(actual[1][0], expected[1], places=8)

    def test_centre(self):
        x, y = colmap_model.project(LENS, np.zeros(1), np.zeros(1))
        self.assertEqual((x[0], y[0]), (3040, 2015))

    def test_round_trip_over_the_photograph(self):
        x, y = (values[::97, ::101] for values in colmap_model.pixel_centres(LENS))
        u, v = colmap_model.unproject(LENS, x, y)
        self.assertFalse(np.isnan(u).any())
        again = colmap_model.project(LENS, u, v)
        self.assertLess(np.abs(again[0] - x).max(), 1e-5)
        self.assertLess(np.abs(again[1] - y).max(), 1e-5)
        # It is no pinhole: the corners are several pixels off.
        self.assertGreater(np.abs(u - (x - 3040) / 3410).max() * 3410, 5)

    def test_rays_beyond_the_lens(self):
        # With this k1 the image folds back at theta = 1 / sqrt(0.9).
        params = (100.0, 100.0, 50.0, 50.0, -0.3, 0, 0, 0, 0, 0, 0, 0)
        camera = colmap_model.Camera("THIN_PRISM_FISHEYE", 100, 100, params)
        fold = math.tan(1 / math.sqrt(0.9))
        x, _ = colmap_model.project(camera, np.array([0.98 * fold, 1.02 * fold]), np.zeros(2))
        self.assertTrue(np.isfinite(x[0]))
        self.assertTrue(np.isnan(x[1]))
        u, _ = colmap_model.unproject(camera, np.array([500.0]), np.array([50.0]))
        self.assertTrue(np.isnan(u[0]))

    def test_pinhole(self):
        camera = colmap_model.Camera("PINHOLE", 8, 6, (10.0, 20.0, 4.0, 3.0))
        u, v = colmap_model.unproject(camera, np.array([0.5]), np.array([5.5]))
        self.assertEqual((u[0], v[0]), (-0.35, 0.125))
        x, y = colmap_model.project(camera, u, v)
        self.assertEqual((x[0], y[0]), (0.5, 5.5))


class TextModel(TestCase):

    def write_model(self, cameras, images):
        self.write("cameras.txt", cameras)
        self.write("images.txt", images)

    def test_views(self):
        half = math.sqrt(0.5)
        self.write_model("# a comment\n0 PINHOLE 8 6 10 20 4 3\n",
                   f"# a comment\n7 {half} 0 {half} 0 1 2 3 0 b/two words.png\n"
                   "1.5 2.5 -1\n2 1 0 0 0 0 0 0 0 a.png\n\n")
        views = colmap_model.read_views(self.folder)
        self.assertEqual([view.name for view in views], ["a.png", "b/two words.png"])
        # 90 degrees about y: the camera's x is the world's z.
        np.testing.assert_allclose(views[1].rotation,
                                   [[0, 0, 1], [0, 1, 0], [-1, 0, 0]], atol=1e-12)
        # Its centre is -R^T t.
        np.testing.assert_allclose(views[1].camera_to_world()[:3, 3], [3, -2, -1], atol=1e-12)

    def test_bad_models(self):
        camera = "0 PINHOLE 8 6 10 20 4 3\n"
        for cameras, images, text in (
                ("", "", "holds no camera"), ("0 FOV 8 6 1 2 3 4 5\n", "", "camera model FOV"),
                ("0 PINHOLE 8 6 1 2 3\n", "", "4 parameters, not 3"),
                ("0 PINHOLE 8\n", "", "no camera in the line"),
                (camera, "", "holds no photograph"),
                (camera, "1 1 0 0 0 0 0 0 5 a.png\n\n", "known camera"),
                (camera, "1 1 0 0 0 0 0 x 0 a.png\n\n", "known camera")):
            self.write_model(cameras, images)
            with self.assertRaisesRegex(Failure, f"^[^\n]*{text}[^\n]*$"):
                colmap_model.read_views(self.folder)
