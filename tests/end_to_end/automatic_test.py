"""The automatic reconstructor goes through dense stereo and stops when that
fails. The sparse model is given, as small images are not good for SIFT."""

import os
import shutil
import unittest

import tiny_workspace as tiny


class Automatic(tiny.TestCase):

    def setUp(self):
        super().setUp()
        self.names = ["view%d.png" % i for i in range(4)]
        tiny.make_images(self.path("photos"), self.names)
        tiny.make_model(self.path("out", "sparse", "0"), self.names)
        self.dense = self.path("out", "dense", "0")

    def reconstruct(self, quality, options=("--use_gpu", "0"), **arguments):
        return tiny.run([tiny.COLMAP, "automatic_reconstructor",
                         "--image_path", self.path("photos"),
                         "--workspace_path", self.path("out"),
                         "--quality", quality, *options], **arguments)

    def test_extreme_quality_fuses_geometric_maps(self):
        result = self.reconstruct("extreme")
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertNotIn("requires CUDA", result.stdout)
        tiny.read_map(tiny.map_path(self.dense, self.names[0]))
        num_points = self.num_points(os.path.join(self.dense, "fused.ply"))
        distance = {}
        for which in ("geometric", "photometric"):
            path = self.path(which + ".ply")
            tiny.run([tiny.COLMAP, "stereo_fusion", "--workspace_path",
                      self.dense, "--input_type", which, "--output_path",
                      path])
            distance[which] = abs(self.num_points(path) - num_points)
        self.assertLess(10 * distance["geometric"], distance["photometric"])

    def test_tapa(self):
        result = self.reconstruct("extreme", ("--use_gpu", "0", "--tapa", "1"))
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertIn("\ntapa: 1\n", result.stdout)
        self.assertIn("\nagreement: 1\n", result.stdout)
        with open(os.path.join(self.dense, "stereo",
                               "options.geometric.txt")) as file:
            self.assertIn("\ntapa = 1\n", file.read())
        tiny.read_map(tiny.map_path(self.dense, self.names[0]))
        self.assertGreater(
            self.num_points(os.path.join(self.dense, "fused.ply")), 0)

    def test_masks_without_distortion_are_for_stereo_and_fusion(self):
        with open(self.path("out", "sparse", "0", "cameras.txt"), "w") as file:
            file.write("1 SIMPLE_RADIAL 96 64 100 48 32 0.3\n")
        for name in self.names:
            tiny.write_mask(self.path("masks", name + ".png"))
        options = ("--use_gpu", "0", "--mask_path", self.path("masks"))
        self.assert_success(self.reconstruct("low", options))
        width, height, depths = tiny.read_map(tiny.map_path(
            self.dense, self.names[0], which="photometric"))
        # The photographs are smaller than those with distortion.
        self.assertLess(width, 96)
        for row in range(height):
            self.assertFalse(any(depths[row * width:row * width + width // 2 - 2]))
        self.assertTrue(any(depths))
        self.assertEqual(
            sorted(os.listdir(os.path.join(self.dense, "masks"))),
            [name + ".png" for name in self.names])
        self.assert_success(self.reconstruct("low", options))
        # Others, and what is left to do.
        for name in ("fused.ply", "meshed-poisson.ply"):
            os.remove(os.path.join(self.dense, name))
        tiny.write_mask(self.path("masks", self.names[0] + ".png"), border=0.25)
        result = self.reconstruct("low", options)
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn("other masks", result.stdout)
        shutil.rmtree(self.path("masks"))
        self.assert_one_error(self.reconstruct("low", options),
                              "no folder of masks")

    def test_other_options_than_before(self):
        result = self.reconstruct("low")
        self.assertEqual(result.returncode, 0, result.stdout)
        for name in os.listdir(self.dense):
            if name.startswith(("fused", "meshed")):
                os.remove(os.path.join(self.dense, name))
        result = self.reconstruct("low", ("--use_gpu", "0", "--tapa", "1"))
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn("tapa was 0, is 1", result.stdout)
        self.assertFalse(os.path.exists(os.path.join(self.dense,
                                                     "fused.ply")))

    def test_does_without_a_display(self):
        environment = {name: value for name, value in os.environ.items()
                       if name not in ("DISPLAY", "WAYLAND_DISPLAY",
                                       "QT_QPA_PLATFORM")}
        result = self.reconstruct("low", (), env=environment)
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertIn("There is no display", result.stdout)
        tiny.read_map(tiny.map_path(self.dense, self.names[0],
                                    which="photometric"))

    def test_displays_that_are_not_there(self):
        for display in ({"QT_QPA_PLATFORM": "offscreen"}, {"DISPLAY": ":99"},
                        {"QT_QPA_PLATFORM": "none"}):
            environment = {name: value for name, value in os.environ.items()
                           if name not in ("DISPLAY", "WAYLAND_DISPLAY",
                                           "QT_QPA_PLATFORM")}
            result = self.reconstruct("low", ("--dense", "0"),
                                      env={**environment, **display})
            self.assertEqual(result.returncode, 0, result.stdout)
            result = tiny.run([tiny.COLMAP, "feature_extractor",
                               "--database_path", self.path("database.db"),
                               "--image_path", self.path("photos")],
                              env={**environment, **display})
            self.assertEqual(result.returncode, 0, result.stdout)

    def test_goes_on_where_it_was_stopped(self):
        self.assert_success(self.reconstruct("low"))
        outputs = {name: os.path.join(self.dense, name)
                   for name in ("fused.ply", "meshed-poisson.ply",
                                "stereo/fusion.cfg")}
        sizes = {name: os.path.getsize(path) for name, path in outputs.items()}
        # While it meshed, fused (as versions before left it) and undistorted.
        for name in outputs:
            os.remove(outputs["meshed-poisson.ply"])
            if name == "fused.ply":
                os.truncate(outputs[name], sizes[name] // 2)
            elif os.path.exists(outputs[name]):
                os.remove(outputs[name])
            self.assert_success(self.reconstruct("low"))
            for output, path in outputs.items():
                self.assertGreater(os.path.getsize(path), sizes[output] // 2)
        self.assertEqual([], [name for name in os.listdir(self.dense)
                              if ".part" in name])

    def test_nothing_can_be_done(self):
        shutil.rmtree(self.path("out", "sparse"))
        self.assert_one_error(
            self.reconstruct("low", ("--use_gpu", "0", "--sparse", "0")),
            "no camera poses", "--sparse 0")
        for name in self.names:
            tiny.write_png(self.path("photos", name), 96, 64,
                           bytes([128] * 96 * 64))
        shutil.rmtree(self.path("out"))
        os.mkdir(self.path("out"))
        self.assert_one_error(self.reconstruct("low"), "overlap")
        for name in self.names:
            with open(self.path("photos", name), "w") as file:
                file.write("This is no image.\n")
        self.assert_one_error(self.reconstruct("low"), "photos")

    def test_other_photographs_and_files(self):
        with open(self.path("photos", ".DS_Store"), "wb") as file:
            file.write(bytes(range(256)))
        with open(self.path("photos", "._view0.png"), "wb") as file:
            file.write(bytes(range(256)))
        self.assert_success(self.reconstruct("low"))
        os.replace(self.path("photos", "view0.png"),
                   self.path("photos", "view1.png"))
        result = self.reconstruct("low")
        self.assert_success(result)
        self.assertRegex(result.stdout, "WARNING: 1 photographs .*view1.png.*"
                                        "--workspace_path")

    def test_workspace_among_the_photographs(self):
        os.rename(self.path("out"), self.path("photos", "out"))
        os.symlink(self.path("photos", "out"), self.path("out"))
        for _ in range(2):
            self.assert_success(self.reconstruct("low"))
        with open(self.path("out", "photographs.txt")) as file:
            self.assertEqual(sorted(line.split()[1] for line in file),
                             self.names)

    def num_points(self, path):
        with open(path, "rb") as file:
            for line in file:
                if line.startswith(b"element vertex "):
                    return int(line.split()[2])
        return 0

    def test_stops_when_stereo_fails(self):
        # The folder of maps is taken by a file.
        os.makedirs(os.path.join(self.dense, "stereo"))
        tiny.make_images(os.path.join(self.dense, "images"), self.names)
        tiny.make_model(os.path.join(self.dense, "sparse"), self.names)
        tiny.make_config(self.dense, self.names)
        maps = os.path.join(self.dense, "stereo", "depth_maps")
        os.rmdir(maps)
        with open(maps, "w") as file:
            file.write("in the way")
        result = self.reconstruct("low")
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn("ERROR: There is no folder " + maps, result.stdout)
        self.assertFalse(os.path.exists(os.path.join(self.dense,
                                                     "fused.ply")))


if __name__ == "__main__":
    unittest.main()
