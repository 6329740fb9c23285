"""ETH3D's scenes, the warp of their depth and the layout of submissions."""

import os
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy as np

from helpers import make_record
from evaluation import colmap_model, depth_maps, run_record
from evaluation.eth3d import prepare as eth3d_prepare
from evaluation.eth3d import scenes as eth3d_scenes
from evaluation.eth3d import submit as eth3d_submit
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
            return [scene.name for scene in eth3d_scenes.select(
                eth3d_scenes.all_scenes(), resolution, split)]

        self.assertEqual(len(names("high", "training")), 13)
        self.assertEqual(len(names("high", "test")), 12)
        self.assertEqual(len(names("low", "training")), 5)
        self.assertEqual(len(names("low", "test")), 5)
        everything = eth3d_scenes.select(eth3d_scenes.all_scenes(), "both", "both")
        self.assertEqual(len({scene.set_name for scene in everything}), 35)

    def test_archives(self):
        scenes = eth3d_scenes.select(eth3d_scenes.all_scenes(), "both", "both",
                                     ["office", "tunnel"])
        self.assertEqual([scene.archives() for scene in scenes], [
            ["office_dslr_undistorted.7z", "office_dslr_scan_eval.7z", "office_dslr_jpg.7z",
             "office_dslr_depth.7z"], ["tunnel_rig_undistorted.7z"]])
        self.assertEqual(scenes[0].archives(with_depth=False),
                         ["office_dslr_undistorted.7z", "office_dslr_scan_eval.7z"])
        rig, = eth3d_scenes.select(eth3d_scenes.all_scenes(), "low", "both", ["electro"])
        self.assertEqual(rig.archives()[2:], ["electro_rig.7z", "electro_rig_depth.7z"])

    def test_fusion_of_the_paper(self):
        errors = {name: track.fusion[1] for name, track in eth3d_scenes.TRACKS.items()}
        self.assertEqual(errors, {"high": "1", "low": "0.5"})
        for track in eth3d_scenes.TRACKS.values():
            self.assertEqual(track.fusion[3], "20")

    def test_unknown_scene(self):
        with self.assertRaisesRegex(Failure, "no scene ofice of high"):
            eth3d_scenes.select(eth3d_scenes.all_scenes(), names=["ofice"])
        with self.assertRaisesRegex(Failure, "no scene door"):  # Of the test split.
            eth3d_scenes.select(eth3d_scenes.all_scenes(), names=["door"])


class Warp(unittest.TestCase):

    def warped_plane(self, size, scale=1.0):
        camera = eth3d_prepare._scaled(UNDISTORTED, size)
        u, v = colmap_model.unproject(ORIGINAL, *colmap_model.pixel_centres(ORIGINAL))
        depth = plane_depth(u, v, scale).astype(np.float32)
        warped = eth3d_prepare.warp(depth, eth3d_prepare.sampled_pixels(ORIGINAL, camera))
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

    def test_a_shift_of_one_pixel_is_noticed(self):
        # What the bounds above are worth.
        shifted = colmap_model.Camera(ORIGINAL.model, 160, 110, tuple(
            value + (1.5 if i == 2 else 0) for i, value in enumerate(ORIGINAL.params)))
        u, v = colmap_model.unproject(ORIGINAL, *colmap_model.pixel_centres(ORIGINAL))
        warped = eth3d_prepare.warp(plane_depth(u, v).astype(np.float32),
                                    eth3d_prepare.sampled_pixels(shifted, UNDISTORTED))
        u, v = colmap_model.unproject(UNDISTORTED, *colmap_model.pixel_centres(UNDISTORTED))
        known = warped > 0
        error = np.abs(1 / warped[known] - 1 / plane_depth(u, v)[known])
        self.assertGreater(error.max(), (1 / 2 + 1 / 3) / 4 / 190)

    def test_names_of_originals(self):
        self.assertEqual(eth3d_prepare.original_name("dslr_images_undistorted/DSC_0101.JPG"),
                         "dslr_images/DSC_0101.JPG")
        self.assertEqual(eth3d_prepare.original_name("images_rig_cam4_undistorted/1.png"),
                         "images_rig_cam4/1.png")

    def test_map_in_a_file(self):
        with tempfile.TemporaryDirectory(prefix="tapa-") as folder:
            path = os.path.join(folder, "sub", "map.bin")
            warped, _, _ = self.warped_plane(0, scale=20)
            depth_maps.write_bin(path, warped)
            np.testing.assert_array_equal(depth_maps.read(path), warped)


class Submission(unittest.TestCase):

    HEADER = ("ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n"
              "property float y\nproperty float z\nend_header\n")

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="tapa-")
        self.addCleanup(shutil.rmtree, self.folder)
        self.run_folder = os.path.join(self.folder, "run")
        self.track = os.path.join(self.folder, "high_res_multi_view")
        self.write_cloud(self.HEADER.format(1).encode() + bytes(12))
        self.write_record({"stereo": 10.25, "fused": 2.25})

    def write_cloud(self, data):
        os.makedirs(self.run_folder, exist_ok=True)
        with open(os.path.join(self.run_folder, "fused.ply"), "wb") as file:
            file.write(data)

    def write_record(self, seconds):
        run_record.save(self.run_folder, make_record(seconds=seconds))

    def add(self):
        eth3d_submit.add_scene(self.track, "office", self.run_folder, "fused")

    def test_layout(self):
        self.add()
        self.add()  # Again does no harm.
        path = eth3d_submit.pack(self.track)
        self.assertEqual(path, self.track + ".7z")
        self.assertEqual(sorted(os.listdir(self.folder)),
                         ["high_res_multi_view", "high_res_multi_view.7z", "run"])
        out = os.path.join(self.folder, "unpacked")
        subprocess.run([eth3d_submit.seven_zip(), "x", "-o" + out, path], check=True,
                       stdout=subprocess.DEVNULL)
        self.assertEqual(os.listdir(out), ["high_res_multi_view"])
        inside = os.path.join(out, "high_res_multi_view")
        self.assertEqual(sorted(os.listdir(inside)), ["office.ply", "office.txt"])
        with open(os.path.join(inside, "office.txt"), encoding="ascii") as file:
            self.assertEqual(file.read(), "runtime 12.500\n")
        with open(os.path.join(inside, "office.ply"), "rb") as file:
            self.assertEqual(file.read(), self.HEADER.format(1).encode() + bytes(12))

    def expect_failure(self, text):
        with self.assertRaisesRegex(Failure, text):
            self.add()
        self.assertFalse(os.path.exists(os.path.join(self.track, "office.txt")))

    def test_what_the_server_would_not_take(self):
        self.write_cloud(self.HEADER.format(0).encode())
        self.expect_failure("holds no points")
        self.write_cloud(b"ply\nformat ascii 1.0\nelement vertex 1\nend_header\n1 2 3\n")
        self.expect_failure("no binary little-endian PLY")
        os.remove(os.path.join(self.run_folder, "fused.ply"))
        self.expect_failure("cannot be read")

    def test_time_that_is_not_known(self):
        self.write_record({"stereo": None, "fused": 2.0})
        self.expect_failure("not known how long")
        os.remove(os.path.join(self.run_folder, "record.json"))
        self.expect_failure("has no run")


if __name__ == "__main__":
    unittest.main()
