"""The automatic reconstructor goes through dense stereo and stops when that
fails. The sparse model is given, as small images are not good for SIFT."""

import os
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
