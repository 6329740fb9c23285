"""ETH3D's scenes, the warp of their depth and the layout of submissions."""

import os
import subprocess
import unittest

import numpy as np

from helpers import TestCase, make_record
from evaluation import colmap_model, depth_maps, record
from evaluation.eth3d import download, prepare, scenes, submit
from evaluation.processes import Failure

UNDISTORTED = colmap_model.Camera("PINHOLE", 150, 100, (100.0, 100.0, 75.0, 50.0))
# Sees less than the undistorted photograph, and is not centred.
ORIGINAL = colmap_model.Camera("THIN_PRISM_FISHEYE", 160, 110, (
    115.0, 114.0, 81.0, 54.0, 0.21, 0.2, -1e-4, 5e-4, -0.16, 0.4, -1e-3, 2e-3))


def plane_depth(u, v, scale=1.0):
    """Depth of the plane z = scale (4 + x / 2 + y / 3) at rays."""
    return 4 * scale / (1 - u / 2 - v / 3)


class Scenes(unittest.TestCase):

    def test_table(self):
        def names(resolution, split):
            return [scene.name for scene in scenes.select(scenes.all_scenes(), resolution, split)]

        self.assertEqual(len(names("high", "training")), 13)
        self.assertEqual(len(names("high", "test")), 12)
        self.assertEqual(len(names("low", "training")), 5)
        self.assertEqual(len(names("low", "test")), 5)
        everything = scenes.select(scenes.all_scenes(), "both", "both")
        self.assertEqual(len({scene.set_name for scene in everything}), 35)

    def test_archives(self):
        chosen = scenes.select(scenes.all_scenes(), "both", "both", ["office", "tunnel"])
        self.assertEqual([scene.archives() for scene in chosen], [
            ["office_dslr_undistorted.7z", "office_dslr_scan_eval.7z", "office_dslr_jpg.7z",
             "office_dslr_depth.7z"], ["tunnel_rig_undistorted.7z"]])
        self.assertEqual(chosen[0].archives(with_depth=False),
                         ["office_dslr_undistorted.7z", "office_dslr_scan_eval.7z"])
        rig, = scenes.select(scenes.all_scenes(), "low", "both", ["electro"])
        self.assertEqual(rig.archives()[2:], ["electro_rig.7z", "electro_rig_depth.7z"])

    def test_fusion_of_the_paper(self):
        for name, error in (("high", "1"), ("low", "0.5")):
            words = scenes.TRACKS[name].fusion
            options = {key.removeprefix("--StereoFusion."): value
                       for key, value in zip(words[::2], words[1::2])}
            self.assertEqual(options, {"agreement": "0", "max_reproj_error": error,
                                       "max_normal_error": "20"})

    def test_unknown_scene(self):
        with self.assertRaisesRegex(Failure, "no scene ofice of high"):
            scenes.select(scenes.all_scenes(), names=["ofice"])
        with self.assertRaisesRegex(Failure, "no scene door"):  # Of the test split.
            scenes.select(scenes.all_scenes(), names=["door"])


class Warp(TestCase):

    def warped_plane(self, size, scale=1.0):
        camera = prepare._scaled(UNDISTORTED, size)
        u, v = colmap_model.unproject(ORIGINAL, *colmap_model.pixel_centres(ORIGINAL))
        depth = plane_depth(u, v, scale).astype(np.float32)
        warped = prepare.warp(depth, prepare.sampled_pixels(ORIGINAL, camera))
        self.assertEqual(warped.shape, (camera.height, camera.width))
        u, v = colmap_model.unproject(camera, *colmap_model.pixel_centres(camera))
        x, y = colmap_model.project(ORIGINAL, u, v)
        inside = (x >= 0) & (x < 160) & (y >= 0) & (y < 110)
        return warped, plane_depth(u, v, scale), inside

    def test_plane(self):
        for size in (0, 150, 40):
            warped, expected, inside = self.warped_plane(size)
            np.testing.assert_array_equal(warped > 0, inside)
            self.assertGreater(inside.mean(), 0.7)
            self.assertFalse(inside.all())  # The border was not photographed.
            # Inverse depth changes by (1/2 + 1/3) / 4 per unit of a ray, and a
            # sample is at most half a pixel, about 1/200, away on either axis.
            error = np.abs(1 / warped[inside] - 1 / expected[inside])
            self.assertLess(error.max(), (1 / 2 + 1 / 3) / 4 / 190)
            self.assertLess(abs((warped[inside] - expected[inside]).mean()), 0.002)

    def test_depth_beyond_what_a_png_can_hold(self):
        warped, expected, inside = self.warped_plane(0, scale=20)
        self.assertGreater(warped.max(), 65535 / 4000 * 4)
        np.testing.assert_allclose(warped[inside], expected[inside], rtol=0.03)
        depth_maps.write_bin(self.path("sub/map.bin"), warped)
        np.testing.assert_array_equal(depth_maps.read(self.path("sub/map.bin")), warped)

    def test_a_shift_of_one_pixel_is_noticed(self):
        # What the bounds above are worth.
        shifted = colmap_model.Camera(ORIGINAL.model, 160, 110, tuple(
            value + (1.5 if i == 2 else 0) for i, value in enumerate(ORIGINAL.params)))
        u, v = colmap_model.unproject(ORIGINAL, *colmap_model.pixel_centres(ORIGINAL))
        warped = prepare.warp(plane_depth(u, v).astype(np.float32),
                                    prepare.sampled_pixels(shifted, UNDISTORTED))
        u, v = colmap_model.unproject(UNDISTORTED, *colmap_model.pixel_centres(UNDISTORTED))
        known = warped > 0
        error = np.abs(1 / warped[known] - 1 / plane_depth(u, v)[known])
        self.assertGreater(error.max(), (1 / 2 + 1 / 3) / 4 / 190)

    def test_names_of_originals(self):
        self.assertEqual(prepare.original_name("dslr_images_undistorted/DSC_0101.JPG"),
                         "dslr_images/DSC_0101.JPG")
        self.assertEqual(prepare.original_name("images_rig_cam4_undistorted/1.png"),
                         "images_rig_cam4/1.png")


class Submission(TestCase):

    HEADER = ("ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n"
              "property float y\nproperty float z\nend_header\n")

    def setUp(self):
        super().setUp()
        self.track = self.path("high_res_multi_view")
        self.cloud = self.write("run/fused.ply", self.HEADER.format(1) + 12 * "\0")
        self.write_record({"stereo": 10.25, "fused": 2.25})

    def write_record(self, seconds):
        record.save(self.path("run"), make_record(seconds=seconds))

    def add(self):
        submit.AddScene(self.track, "office", self.path("run"), "fused").run()

    def test_layout(self):
        self.add()
        self.add()  # Again does no harm.
        submit.Pack(self.track).run()
        self.assertEqual(sorted(os.listdir(self.folder)),
                         ["high_res_multi_view", "high_res_multi_view.7z", "run"])
        subprocess.run([download.seven_zip(), "x", "-o" + self.path("unpacked"),
                        self.track + ".7z"], check=True, stdout=subprocess.DEVNULL)
        self.assertEqual(os.listdir(self.path("unpacked")), ["high_res_multi_view"])
        inside = "unpacked/high_res_multi_view"
        self.assertEqual(sorted(os.listdir(self.path(inside))), ["office.ply", "office.txt"])
        self.assertEqual(self.read(inside, "office.txt"), "runtime 12.500\n")
        self.assertEqual(self.read(inside, "office.ply"), self.HEADER.format(1) + 12 * "\0")

    def expect_failure(self, text):
        with self.assertRaisesRegex(Failure, text):
            self.add()
        self.assertFalse(os.path.exists(os.path.join(self.track, "office.txt")))

    def test_what_the_server_would_not_take(self):
        self.write("run/fused.ply", self.HEADER.format(0))
        self.expect_failure("holds no points")
        self.write("run/fused.ply", "ply\nformat ascii 1.0\nelement vertex 1\nend_header\n1 2 3\n")
        self.expect_failure("no binary little-endian PLY")
        os.remove(self.cloud)
        self.expect_failure("cannot be read")

    def test_time_that_is_not_known(self):
        self.write_record({"stereo": None, "fused": 2.0})
        self.expect_failure("not known how long")
        os.remove(self.path("run/record.json"))
        self.expect_failure("has no run")
