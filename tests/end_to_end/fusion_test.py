"""stereo_fusion with the rule that weighs agreement: what it writes, what it heeds, and
what it says of a workspace that is damaged."""

import os
import signal
import struct
import subprocess
import time
import unittest

import tiny_workspace as tiny


def read_visibility(path):
    with open(path, "rb") as file:
        data = file.read()
    (count,), at, views = struct.unpack_from("<Q", data), 8, []
    for _ in range(count):
        (length,) = struct.unpack_from("<I", data, at)
        views.append(struct.unpack_from("<%dI" % length, data, at + 4))
        at += 4 * (1 + length)
    assert at == len(data), path
    return views


class Fusion(tiny.TestCase):
    """Workspaces of three views with the true maps."""

    def setUp(self):
        super().setUp()
        self.names = tiny.make_workspace(self.folder, num_views=3)
        for index, name in enumerate(self.names):
            tiny.write_true_maps(self.folder, name, index, tiny.WIDTH, tiny.HEIGHT)

    def fuse(self, *arguments, output="fused.ply", **options):
        return tiny.run([tiny.COLMAP, "stereo_fusion", "--workspace_path", self.folder,
                         "--output_path", self.path(output), *arguments], **options)

    def points(self, *arguments):
        self.assert_success(self.fuse(*arguments))
        return tiny.read_cloud(self.path("fused.ply"))[1]

    def test_points_visibility_and_confidence(self):
        self.assert_success(self.fuse())
        names, points = tiny.read_cloud(self.path("fused.ply"))
        self.assertEqual(names, ["x", "y", "z", "nx", "ny", "nz", "red", "green", "blue",
                                 "confidence"])
        self.assertGreater(len(points), tiny.WIDTH * tiny.HEIGHT // 2)
        for x, _, z, nx, ny, nz, *_, confidence in points:
            self.assertAlmostEqual(z, 4 + x / 4, delta=2e-3)
            self.assertAlmostEqual(nx * nx + ny * ny + nz * nz, 1, delta=1e-4)
            self.assertLess(nz, 0)
            self.assertGreater(confidence, 0)
        visibility = read_visibility(self.path("fused.ply.vis"))
        self.assertEqual(len(visibility), len(points))
        self.assertGreater(sum(len(views) >= 2 for views in visibility), len(points) // 2)
        for views in visibility:
            self.assertEqual(len(set(views)), len(views))
            self.assertLess(max(views), 3)

    def test_the_same_for_any_number_of_threads_and_little_memory(self):
        def content(*arguments):
            self.assert_success(self.fuse(*arguments))
            parts = []
            for end in ("", ".vis"):
                with open(self.path("fused.ply" + end), "rb") as file:
                    parts.append(file.read())
            return parts
        one = content("--StereoFusion.num_threads", "1")
        self.assertEqual(one, content("--StereoFusion.num_threads", "4"))
        self.assertEqual(one, content("--StereoFusion.agreement_cache_size", "1e-6"))

    @unittest.skipIf("TSAN_OPTIONS" in os.environ, "ThreadSanitizer cannot follow OpenMP")
    def test_meshers_read_it(self):
        self.assert_success(self.fuse())
        for mesher in ("poisson", "delaunay"):
            is_delaunay = mesher == "delaunay"
            result = tiny.run([tiny.COLMAP, mesher + "_mesher", "--input_path",
                               self.folder if is_delaunay else self.path("fused.ply"),
                               "--output_path", self.path(mesher + ".ply"),
                               # The points are on a plane, for which COLMAP's quality
                               # is negative by rounding.
                               *(["--DelaunayMeshing.quality_regularization", "0"]
                                 if is_delaunay else ["--PoissonMeshing.depth", "6"])],
                              cwd=self.folder)  # For its temporary files.
            if is_delaunay and "requires CGAL" in result.stdout:
                continue
            self.assert_success(result)
            self.assertGreater(os.path.getsize(self.path(mesher + ".ply")), 200)

    def test_bounding_box(self):
        box = self.path("box.txt")
        with open(box, "w") as file:
            file.write("-0.5 -100 -100\n0.25 100 100\n")
        points = self.points("--bbox_path", box)
        self.assertGreater(len(points), 100)
        self.assertTrue(all(-0.5 <= point[0] <= 0.25 for point in points))

    def test_masks(self):
        everything = len(self.points())
        for name in self.names:
            tiny.write_mask(self.path("masks", name + ".png"))
        masked = len(self.points("--StereoFusion.mask_path", self.path("masks")))
        self.assertGreater(masked, 100)
        self.assertLess(masked, 0.7 * everything)

    def test_max_image_size(self):
        everything = len(self.points())
        points = self.points("--StereoFusion.max_image_size", str(tiny.WIDTH // 2))
        self.assertGreater(len(points), everything // 8)
        self.assertLess(len(points), everything // 3)
        for x, _, z, *_ in points:
            self.assertAlmostEqual(z, 4 + x / 4, delta=0.03)

    def test_input_type(self):
        for kind in ("depth_maps", "normal_maps"):
            for name in self.names:
                os.rename(tiny.map_path(self.folder, name, kind),
                          tiny.map_path(self.folder, name, kind, "photometric"))
        self.assert_one_error(self.fuse(), "no geometric maps")
        self.assertGreater(len(self.points("--input_type", "photometric")), 100)

    def test_output_as_a_model(self):
        os.mkdir(self.path("model"))
        self.assert_success(self.fuse("--output_type", "TXT", output="model"))
        with open(self.path("model", "points3D.txt")) as file:
            self.assertGreater(sum(1 for _ in file), 1000)

    def test_colmaps_rule(self):
        points = self.points("--StereoFusion.agreement", "0", "--StereoFusion.min_num_pixels",
                             "2")
        self.assertGreater(len(points), 100)
        self.assertEqual(len(points[0]), 9)
        self.assertEqual(len(read_visibility(self.path("fused.ply.vis"))), len(points))

    def test_a_view_without_maps_is_left_out(self):
        for kind in ("depth_maps", "normal_maps"):
            os.remove(tiny.map_path(self.folder, self.names[2], kind))
        result = self.fuse()
        self.assert_success(result)
        self.assertIn("There are no maps of " + self.names[2], result.stdout)
        for views in read_visibility(self.path("fused.ply.vis")):
            self.assertNotIn(2, views)

    def test_damaged_maps(self):
        depth = tiny.map_path(self.folder, self.names[1])
        normal = tiny.map_path(self.folder, self.names[1], "normal_maps")
        with open(depth, "rb") as file:
            whole = file.read()
        with open(depth, "wb") as file:
            file.write(whole[:-4])
        self.assert_one_error(self.fuse(), depth, "truncated")
        with open(depth, "wb") as file:
            file.write(b"nonsense")
        self.assert_one_error(self.fuse(), depth)
        os.remove(depth)
        self.assert_one_error(self.fuse(), depth)
        tiny.write_map(depth, 4, 40, [1.0] * 160)
        tiny.write_map(normal, 4, 40, [0.0] * 480)
        self.assert_one_error(self.fuse(), depth, "shape")
        self.assertFalse(os.path.exists(self.path("fused.ply")))

    def test_list_and_options(self):
        listing = self.path("stereo", "fusion.cfg")
        with open(listing, "a") as file:
            file.write("nobody.png\n")
        self.assert_one_error(self.fuse(), listing, "nobody.png")
        os.remove(listing)
        self.assert_one_error(self.fuse(), listing)
        self.assert_one_error(self.fuse("--StereoFusion.agreement_num_views", "65"),
                              "agreement_num_views")

    def test_a_stopped_fusion_writes_nothing(self):
        process = subprocess.Popen(
            [tiny.COLMAP, "stereo_fusion", "--workspace_path", self.folder, "--output_path",
             self.path("fused.ply")], stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        process.communicate()
        # It may have been done already.
        if process.returncode != 0:
            self.assertFalse(os.path.exists(self.path("fused.ply")))
        self.assert_success(self.fuse())


if __name__ == "__main__":
    unittest.main()
