"""Every kind of workspace and every option on a small scene."""

import os
import shutil
import struct
import unittest

import tiny_workspace as tiny


def median_depth_error(workspace, name, index, **where):
    """Median of |depth / true depth - 1| and the share of pixels with depth."""
    errors, num_pixels = tiny.depth_errors(workspace, name, index, **where)
    return sorted(errors)[len(errors) // 2], len(errors) / num_pixels


# What is good enough for a small scene.
GOOD = {"num_iterations": 4, "window_radius": 5, "num_samples": 15}


class Colmap(tiny.TestCase):

    def assert_accurate(self, name, index, **where):
        error, share = median_depth_error(self.folder, name, index, **where)
        self.assertLess(error, 0.01)
        self.assertGreater(share, 0.6)

    def test_depths_are_right(self):
        names = tiny.make_workspace(self.folder)
        result = tiny.run_stereo(self.folder, **GOOD)
        self.assert_success(result)
        for index, name in enumerate(names):
            self.assert_accurate(name, index)
            width, height, normals = tiny.read_map(
                tiny.map_path(self.folder, name, "normal_maps"))
            self.assertEqual((width, height), (96, 64))
            self.assertEqual(len(normals), 3 * 96 * 64)
        # The log says how fast it was and what was used.
        self.assertIn("Seconds per megapixel and view: photometric",
                      result.stdout)
        self.assertIn("Computing on the CPU, as ", result.stdout)

    def test_fusion_reads_the_maps(self):
        tiny.make_workspace(self.folder)
        self.assert_success(tiny.run_stereo(self.folder, **GOOD))
        result = tiny.run([tiny.COLMAP, "stereo_fusion", "--workspace_path",
                           self.folder, "--output_path",
                           self.path("fused.ply")])
        self.assert_success(result)
        self.assertGreater(os.path.getsize(self.path("fused.ply")), 20000)

    def test_fused_points_are_where_the_photograph_sees_them(self):
        # True maps of one view, a third of its size: the points must lie on the
        # plane, and have the colours that are seen there.
        (name,) = tiny.make_workspace(self.folder, num_views=1)
        tiny.write_true_maps(self.folder, name, 0, 32, 21)
        self.assert_success(tiny.run([
            tiny.COLMAP, "stereo_fusion", "--workspace_path", self.folder,
            "--output_path", self.path("fused.ply"),
            "--StereoFusion.agreement", "0", "--StereoFusion.min_num_pixels",
            "1"]))
        _, points = tiny.read_cloud(self.path("fused.ply"))
        self.assertEqual(len(points), 32 * 21)
        photo = tiny.render(0, tiny.WIDTH, tiny.HEIGHT)
        for x, y, z, _, _, _, color, *_ in points:
            self.assertAlmostEqual(z, 4 + x / 4, delta=1e-4)
            u, v = (tiny.FOCAL * a / z + size / 2
                    for a, size in ((x, tiny.WIDTH), (y, tiny.HEIGHT)))
            # Between two rows either will do.
            self.assertIn(color, [photo[int(row) * tiny.WIDTH + int(u)]
                                  for row in (v - 0.01, v + 0.01)])

    def test_photometric_only(self):
        names = tiny.make_workspace(self.folder)
        self.assert_success(tiny.run_stereo(self.folder, geom_consistency=0,
                                            **GOOD))
        self.assert_accurate(names[1], 1, which="photometric")
        self.assertEqual(len(os.listdir(self.path("stereo", "depth_maps"))),
                         len(names))

    def test_auto_and_named_sources(self):
        names = tiny.make_workspace(self.folder, sources="__auto__, 2")
        with open(self.path("stereo", "patch-match.cfg"), "a") as file:
            # Twice the same, and the view itself, do no harm.
            file.write("\n# a comment\n%s\n%s, %s;%s,%s\n" % (
                names[0], names[2], names[1], names[2], names[0]))
        self.assert_success(tiny.run_stereo(self.folder))
        self.assertEqual(len(os.listdir(self.path("stereo", "depth_maps"))),
                         2 * len(names))

    def test_config_elsewhere(self):
        names = tiny.make_workspace(self.folder)
        os.rename(self.path("stereo", "patch-match.cfg"), self.path("list"))
        with open(self.path("list"), "w") as file:
            file.write("%s\n__all__\n" % names[0])
        self.assert_success(tiny.run_stereo(
            self.folder, ["--config_path", self.path("list")],
            geom_consistency=0))
        self.assertEqual(os.listdir(self.path("stereo", "depth_maps")),
                         [names[0] + ".photometric.bin"])

    def test_names_with_folders(self):
        names = ["left/a.png", "left/b.png", "right/a.png"]
        tiny.make_workspace(self.folder, names=names)
        self.assert_success(tiny.run_stereo(self.folder))
        for name in names:
            tiny.read_map(tiny.map_path(self.folder, name))

    def test_binary_model(self):
        tiny.make_workspace(self.folder)
        sparse = self.path("sparse")
        self.assert_success(tiny.run(
            [tiny.COLMAP, "model_converter", "--input_path", sparse,
             "--output_path", sparse, "--output_type", "BIN"]))
        for name in ("cameras", "images", "points3D"):
            os.remove(os.path.join(sparse, name + ".txt"))
        self.assert_success(tiny.run_stereo(self.folder))

    def test_max_image_size(self):
        names = tiny.make_workspace(self.folder)
        self.assert_success(tiny.run_stereo(self.folder, max_image_size=48,
                                            **GOOD))
        width, height, _ = tiny.read_map(tiny.map_path(self.folder, names[0]))
        self.assertEqual((width, height), (48, 32))
        error, _ = median_depth_error(self.folder, names[1], 1)
        self.assertLess(error, 0.02)

    def test_views_of_different_sizes(self):
        names = tiny.make_workspace(self.folder, separate_cameras=True)
        # The second camera has twice the resolution.
        tiny.make_images(self.path("big"), names, 192, 128)
        shutil.copy(self.path("big", names[1]), self.path("images", names[1]))
        with open(self.path("sparse", "cameras.txt")) as file:
            lines = file.read().splitlines()
        lines[1] = "2 PINHOLE 192 128 200 200 96 64"
        with open(self.path("sparse", "cameras.txt"), "w") as file:
            file.write("\n".join(lines) + "\n")
        self.assert_success(tiny.run_stereo(self.folder, **GOOD))
        for index, name in enumerate(names):
            self.assert_accurate(name, index)
        self.assertEqual(tiny.read_map(
            tiny.map_path(self.folder, names[1]))[:2], (192, 128))

    def test_range_of_depths(self):
        names = tiny.make_workspace(self.folder, num_points=0)
        self.assert_success(tiny.run_stereo(self.folder, depth_min=2,
                                            depth_max=10, **GOOD))
        self.assert_accurate(names[1], 1)

    def test_without_filter_every_pixel_has_a_depth(self):
        names = tiny.make_workspace(self.folder)
        self.assert_success(tiny.run_stereo(self.folder, filter=0))
        _, _, depths = tiny.read_map(tiny.map_path(self.folder, names[0]))
        self.assertGreater(min(depths), 0)

    def test_consistency_graph(self):
        names = tiny.make_workspace(self.folder)
        self.assert_success(tiny.run_stereo(
            self.folder, write_consistency_graph=1, **GOOD))
        path = tiny.map_path(self.folder, names[1], "consistency_graphs")
        with open(path, "rb") as file:
            width, height, channels, data = file.read().split(b"&", 3)
        self.assertEqual((width, height, channels), (b"96", b"64", b"1"))
        graph = struct.unpack("<%di" % (len(data) // 4), data)
        _, _, depths = tiny.read_map(tiny.map_path(self.folder, names[1]))
        position = 0
        pixels = set()
        while position < len(graph):
            col, row, count = graph[position:position + 3]
            views = graph[position + 3:position + 3 + count]
            self.assertGreaterEqual(count, 2)
            self.assertEqual(len(views), count)
            self.assertTrue(set(views) <= {0, 2, 3})
            pixels.add(row * 96 + col)
            position += 3 + count
        self.assertEqual(position, len(graph))
        self.assertEqual(pixels, {i for i, d in enumerate(depths) if d > 0})

    def test_other_windows(self):
        tiny.make_workspace(self.folder)
        for radius, step in ((1, 1), (5, 2), (32, 1)):
            with self.subTest(radius=radius, step=step):
                shutil.rmtree(self.path("stereo"))
                tiny.make_config(self.folder, ["view0.png"])
                self.assert_success(tiny.run_stereo(
                    self.folder, window_radius=radius, window_step=step,
                    geom_consistency=0))

    def test_missing_files_are_allowed_on_request(self):
        names = tiny.make_workspace(self.folder)
        os.remove(self.path("images", names[3]))
        result = tiny.run_stereo(self.folder, allow_missing_files=1)
        self.assert_success(result)
        self.assertIn("WARNING", result.stdout)
        maps = os.listdir(self.path("stereo", "depth_maps"))
        self.assertEqual(len(maps), 2 * 3)

    def test_views_without_sources_are_allowed_on_request(self):
        names = tiny.make_workspace(self.folder)
        with open(self.path("stereo", "patch-match.cfg"), "a") as file:
            file.write("%s\n%s\n" % (names[0], names[0]))
        with open(self.path("stereo", "patch-match.cfg")) as file:
            lines = file.readlines()
        lines = lines[2:]  # The first view has no other list of sources.
        with open(self.path("stereo", "patch-match.cfg"), "w") as file:
            file.writelines(lines)
        result = tiny.run_stereo(self.folder, allow_missing_files=1)
        self.assert_success(result)
        self.assertIn("WARNING: View " + names[0], result.stdout)
        self.assertFalse(os.path.exists(
            tiny.map_path(self.folder, names[0])))

    def test_project_file(self):
        tiny.make_workspace(self.folder)
        with open(self.path("project.ini"), "w") as file:
            file.write("workspace_path = %s\n[PatchMatchStereo]\n"
                       "num_iterations = 1\nseed = 17\nuse_gpu = false\n" %
                       self.folder)
        result = tiny.run([tiny.COLMAP, "patch_match_stereo",
                           "--project_path", self.path("project.ini")])
        self.assert_success(result)
        self.assertIn("seed: 17", result.stdout)
        self.assertNotIn("Computing on the CPU", result.stdout)


class Pmvs(tiny.TestCase):

    def test_bundle(self):
        names = ["%08d.jpg" % i for i in range(4)]
        tiny.make_images(self.path("visualize"), names)
        focal = tiny.FOCAL
        with open(self.path("bundle.rd.out"), "w") as file:
            points = [(x / 10, y / 10) for x in range(-10, 20, 3)
                      for y in range(-10, 10, 3)]
            file.write("# Bundle file v0.3\n4 %d\n" % len(points))
            for i in range(4):
                # Bundler's camera looks along -z, with y up.
                file.write("%r 0 0\n1 0 0\n0 -1 0\n0 0 -1\n%r 0 0\n" %
                           (focal, -i * tiny.BASELINE))
            for x, y in points:
                file.write("%r %r %r\n9 9 9\n4 " % (x, y, 4 + x / 4))
                file.write(" ".join("%d 0 0 0" % i for i in range(4)) + "\n")
        with open(self.path("option-some"), "w") as file:
            file.write("timages -1 0 4\noimages 0\n")

        result = tiny.run_stereo(
            self.folder, ["--workspace_format", "PMVS", "--pmvs_option_name",
                          "option-some"], **GOOD)
        self.assert_success(result)
        for index, name in enumerate(names):
            error, share = median_depth_error(self.folder, name, index,
                                              stereo="stereo-option-some")
            self.assertLess(error, 0.01)
            self.assertGreater(share, 0.6)

        shutil.rmtree(self.path("stereo-option-some"))
        tiny.write_mask(self.path("masks", names[1] + ".png"))
        self.assert_success(tiny.run_stereo(
            self.folder, ["--workspace_format", "PMVS", "--pmvs_option_name",
                          "option-some"], mask_path=self.path("masks")))
        width, height, depths = tiny.read_map(tiny.map_path(
            self.folder, names[1], stereo="stereo-option-some"))
        self.assertTrue(any(depths))
        for row in range(height):
            self.assertFalse(any(depths[row * width:row * width + width // 2]))

    def test_no_pmvs_workspace(self):
        os.makedirs(self.path("visualize"))
        arguments = ["--workspace_format", "PMVS"]
        self.assert_one_error(tiny.run_stereo(self.folder, arguments),
                              "bundle.rd.out")
        with open(self.path("bundle.rd.out"), "w") as file:
            file.write("# Bundle file v0.3\n0 0\n")
        self.assert_one_error(tiny.run_stereo(self.folder, arguments),
                              "option-all")


class Undistorter(tiny.TestCase):

    def test_max_image_size_scales_pinhole_cameras_too(self):
        names = tiny.make_workspace(self.path("in"))
        os.makedirs(self.path("out"))
        self.assert_success(tiny.run(
            [tiny.COLMAP, "image_undistorter", "--image_path",
             self.path("in", "images"), "--input_path",
             self.path("in", "sparse"), "--output_path", self.path("out"),
             "--max_image_size", "48"]))
        with open(self.path("out", "images", names[0]), "rb") as file:
            width, height = struct.unpack(">II", file.read(24)[16:])
        self.assertEqual((width, height), (48, 32))
        with open(self.path("out", "sparse", "cameras.bin"), "rb") as file:
            _, _, _, width, height, fx = struct.unpack("<QiiQQd",
                                                       file.read(40))
        self.assertEqual((width, height, fx), (48, 32, tiny.FOCAL / 2))
        self.assert_success(tiny.run_stereo(self.path("out")))


if __name__ == "__main__":
    unittest.main()
