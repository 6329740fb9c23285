"""Files as people have them: they work, or a line says what is wrong with them."""

import os
import re
import shutil
import struct
import unittest
import zlib

import tiny_workspace as tiny


def write_png16(path, width, height, grey, channels):
    """Grey values, 0 to 255, as 16 bits per channel; in colour blue is half of it."""
    factors = ([1], [1, 1, 0.5])[channels > 1]
    rows = b"".join(
        b"\0" + struct.pack(">%dH" % (width * channels), *(
            int(value * factor * 256) for value in grey[row * width:(row + 1) * width]
            for factor in factors))
        for row in range(height))

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data +
                struct.pack(">I", zlib.crc32(kind + data)))

    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" +
                   chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 16,
                                              0 if channels == 1 else 2, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


# Either rule of fusion.
RULES = {"agreement": 0, "min_num_pixels": 2}, {"agreement": 1}


class Workspace(tiny.TestCase):

    def make(self, **options):
        self.names = tiny.make_workspace(self.folder, **options)

    def edit(self, name, change):
        with open(self.path(name)) as file:
            text = file.read()
        with open(self.path(name), "w") as file:
            file.write(change(text))

    def stereo(self, **options):
        return tiny.run_stereo(self.folder, **options)

    def fuse(self, **options):
        command = [tiny.COLMAP, "stereo_fusion", "--workspace_path", self.folder,
                   "--output_path", self.path("fused.ply")]
        for name, value in options.items():
            prefix = "" if name in ("input_type", "bbox_path") else "StereoFusion."
            command += ["--" + prefix + name, str(value)]
        return tiny.run(command)

    def points(self):
        return tiny.read_cloud(self.path("fused.ply"))[1]

    def fused(self, **options):
        self.assert_success(self.fuse(**options))
        return self.points()

    def expect_points(self, at_least=500, **options):
        self.assert_success(self.stereo(**options))
        for rule in RULES:
            self.assertGreater(len(self.fused(**rule)), at_least)


class Names(Workspace):

    def test_any_character(self):
        names = ["#1.png", " 2.png", "hall, left; 3.png", "a/hall, left.png"]
        self.make(names=names)
        with open(self.path("stereo", "patch-match.cfg"), "w") as file:
            for name in names:
                file.write("%s\n%s\n" % (name, ", ".join(
                    other for other in names if other != name)))
        self.expect_points()
        for name in names:
            self.assertTrue(os.path.exists(tiny.map_path(self.folder, name)), name)

    def test_same_names_in_two_folders_and_formats(self):
        self.make(names=["a/x.png", "b/x.png", "b/x.jpg", "x.png"])
        self.expect_points()

    def test_long_names(self):
        # What is added to it has 16 characters; a file's name may have 255.
        self.make(names=["%d%s.png" % (i, "x" * 234) for i in range(4)])
        self.expect_points()

    def test_windows_editor(self):
        self.make()
        for name in ("stereo/patch-match.cfg", "stereo/fusion.cfg", "sparse/cameras.txt",
                     "sparse/images.txt", "sparse/points3D.txt"):
            self.edit(name, lambda text: "\ufeff" + text.replace("\n", "\r\n"))
        self.expect_points()


class SixteenBits(Workspace):

    def check(self, channels):
        self.make()
        for i, name in enumerate(self.names):
            write_png16(self.path("images", name), tiny.WIDTH, tiny.HEIGHT,
                        tiny.render(i * tiny.BASELINE, tiny.WIDTH, tiny.HEIGHT), channels)
        self.expect_points()
        reds, _, blues = zip(*(point[6:9] for point in self.points()))
        self.assertGreater(sum(reds) / len(reds), 64)
        self.assertAlmostEqual(sum(blues) / sum(reds), 1 if channels == 1 else 0.5, delta=0.02)

    def test_grey(self):
        self.check(1)

    def test_color(self):
        self.check(3)


class KnownPoses(Workspace):
    """Poses without points."""

    def test_neighbours_are_chosen_by_the_cameras(self):
        self.make(num_points=0, sources="__auto__, 3")
        self.expect_points(depth_min=1, depth_max=9)

    def test_no_lower_end(self):
        self.make(num_points=0)
        self.expect_points(depth_min=0, depth_max=9)

    def test_depth_max_bounds_the_result(self):
        self.make()
        self.assert_success(self.stereo(depth_min=1, depth_max=4.2))
        _, _, depths = tiny.read_map(tiny.map_path(self.folder, self.names[1]))
        self.assertGreater(max(depths), 3.5)
        self.assertLessEqual(max(depths), 4.2)


class Model(Workspace):

    def expect_error(self, *texts):
        self.assert_one_error(self.stereo(), *texts)

    def test_pose_is_not_a_number(self):
        self.make()
        self.edit("sparse/images.txt", lambda text: text.replace(" -0.6 0 0 1", " nan 0 0 1", 1))
        self.expect_error("images.txt, line 5", "view2.png")

    def test_point_at_infinity(self):
        self.make()
        self.edit("sparse/points3D.txt", lambda text: re.sub(
            r"(?m)^(\d+) \S+", lambda match: match.group(1) + " inf"
            if int(match.group(1)) % 9 == 0 else match.group(0), text))
        self.expect_points()

    def test_distortion(self):
        self.make()
        self.edit("sparse/cameras.txt", lambda text: "1 SIMPLE_RADIAL 96 64 100 48 32 -0.1\n")
        self.expect_error("distortion", "image_undistorter")

    def test_other_commands(self):
        self.make()
        self.edit("sparse/images.txt", lambda text: text.replace("view1.png\n", "\n"))
        for command in (["stereo_fusion", "--workspace_path", self.folder, "--output_path",
                         self.path("fused.ply")],
                        ["image_undistorter", "--image_path", self.path("images"),
                         "--input_path", self.path("sparse"), "--output_path", self.path("u")],
                        ["model_analyzer", "--path", self.path("sparse")]):
            self.assert_one_error(tiny.run([tiny.COLMAP] + command), "images.txt, line 3")


class FarAway(Workspace):

    def test_utm(self):
        shift = (500000.25, 5200000.5, 200)
        with open(self.path("box.txt"), "w") as file:
            file.write("500000 5200000 200\n501000 5201000 204.2\n")
        self.make()
        self.expect_points()
        near = [self.fused(**rule) for rule in RULES]
        maps = [tiny.read_map(tiny.map_path(self.folder, name))[2] for name in self.names]
        shutil.rmtree(self.path("stereo"))
        tiny.make_config(self.folder, self.names)

        def move(text, first, sign):
            lines = []
            for line in text.splitlines():
                fields = line.split(" ")
                # Poses have no rotation; observations have another number of fields.
                if sign > 0 or len(fields) == 10:
                    fields[first:first + 3] = [repr(float(value) + sign * by) for value, by
                                               in zip(fields[first:first + 3], shift)]
                lines.append(" ".join(fields))
            return "\n".join(lines) + "\n"

        self.edit("sparse/images.txt", lambda text: move(text, 5, -1))
        self.edit("sparse/points3D.txt", lambda text: move(text, 1, 1))
        self.expect_points()
        for name, depths in zip(self.names, maps):
            errors = [abs(a - b) > 1e-3 for a, b in zip(
                tiny.read_map(tiny.map_path(self.folder, name))[2], depths)]
            self.assertLess(sum(errors), 0.05 * len(errors))
        for rule, before in zip(RULES, near):
            far = self.fused(**rule)
            self.assertAlmostEqual(len(far), len(before), delta=0.05 * len(before))
            for axis in range(3):
                middles = [sorted(point[axis] for point in points)[len(points) // 2]
                           for points in (before, far)]
                self.assertAlmostEqual(middles[1] - middles[0], shift[axis], delta=0.02)
            boxed = self.fused(bbox_path=self.path("box.txt"), **rule)
            self.assertLess(len(boxed), len(far))
            self.assertLess(max(point[2] for point in boxed), 204.21)


class Stale(Workspace):
    """The model or the photographs changed since the maps were made."""

    def setUp(self):
        super().setUp()
        self.make()
        self.assert_success(self.stereo())

    def expect_error(self, what):
        before = tiny.snapshot(self.folder)
        self.assert_one_error(self.stereo(), what)
        self.assertEqual(before, tiny.snapshot(self.folder))

    def test_poses(self):
        self.edit("sparse/images.txt", lambda text: text.replace(" -0.6 0 0 1", " -0.7 0 0 1", 1))
        self.expect_error("other poses or cameras")
        result = self.fuse()
        self.assert_one_error(result, "view2.png", "pose")

    def test_photographs(self):
        shutil.copy(self.path("images/view0.png"), self.path("images/view1.png"))
        self.expect_error("other photographs")

    def test_sources(self):
        tiny.make_config(self.folder, self.names[:3],
                         ", ".join(self.names[:3]))
        self.expect_error("other source images")

    def test_ways_out(self):
        shutil.copy(self.path("images/view0.png"), self.path("images/view1.png"))
        for which in ("photometric", "geometric"):
            os.remove(self.path("stereo", "views.%s.txt" % which))
        result = self.stereo()
        self.assert_success(result)
        self.assertIn("not known which poses and photographs", result.stdout)
        self.assertIn("there is nothing to do", result.stdout)
        shutil.rmtree(self.path("stereo"))
        tiny.make_config(self.folder, self.names)
        self.assert_success(self.stereo())
        result = self.stereo()
        self.assertNotIn("not known", result.stdout)


class Views(Workspace):

    def test_some_views_with_all_as_sources(self):
        self.make()
        with open(self.path("stereo", "patch-match.cfg"), "w") as file:
            file.write("view1.png\n__all__\n")
        result = self.stereo()
        self.assert_success(result)
        self.assertIn("Configuration has 1 views. 3 further ones", result.stdout)
        errors, _ = tiny.depth_errors(self.folder, "view1.png", 1)
        self.assertLess(sorted(errors)[len(errors) // 2], 0.02)
        self.assertFalse(os.path.exists(tiny.map_path(self.folder, "view0.png")))
        self.assertIn("there is nothing to do", self.stereo().stdout)

    def test_views_with_one_source(self):
        self.make(num_views=2)
        self.assertIn("filter_min_num_consistent", self.stereo().stdout)
        self.expect_points(at_least=400)


class Fusion(Workspace):

    def setUp(self):
        super().setUp()
        self.make()
        self.assert_success(self.stereo())
        with open(self.path("fused.ply"), "w") as file:
            file.write("of another run")

    def expect_error(self, *texts, **options):
        for rule in RULES:
            self.assert_one_error(self.fuse(**{**rule, **options}), *texts)
            with open(self.path("fused.ply")) as file:
                self.assertEqual(file.read(), "of another run")

    def test_damaged_maps(self):
        for kind in ("depth_maps", "normal_maps"):
            path = tiny.map_path(self.folder, "view1.png", kind)
            with open(path, "rb") as file:
                content = file.read()
            for size in (0, 5, 1000):
                os.truncate(path, size)
                self.expect_error(path, "patch_match_stereo again")
            with open(path, "wb") as file:
                file.write(content)
        self.assert_success(self.fuse())

    def test_missing_maps(self):
        for name in self.names:
            os.remove(tiny.map_path(self.folder, name))
        self.expect_error("--input_type photometric")

    def test_photographs(self):
        with open(self.path("images/view1.png"), "w") as file:
            file.write("This is no image.\n")
        self.expect_error("view1.png")
        tiny.write_png(self.path("images/view1.png"), 48, 32, bytes(48 * 32))
        self.expect_error("view1.png", "48x32", "96x64")

    def test_masks(self):
        self.expect_error("no folder of masks", "view0.png.png",
                          mask_path=self.path("masks"))
        os.mkdir(self.path("masks"))
        tiny.write_png(self.path("masks/view0.png.png"), 96, 64, bytes(96 * 64))
        for rule in RULES:
            result = self.fuse(mask_path=self.path("masks"), **rule)
            self.assert_success(result)
            self.assertIn("3 of 4 images have no mask", result.stdout)

    def test_bounding_box(self):
        self.expect_error("box.txt", bbox_path=self.path("box.txt"))
        with open(self.path("box.txt"), "w") as file:
            file.write("0 0 0 1 1\n")
        self.expect_error("box.txt", "six numbers", bbox_path=self.path("box.txt"))

    def test_no_points(self):
        self.expect_error("No points", "min_num_pixels", agreement=0, min_num_pixels=50)
        self.expect_error("No points", "agreement_threshold", agreement=1,
                          agreement_threshold=50)

    def test_unknown_image(self):
        self.edit("stereo/fusion.cfg", lambda text: text + "ghost.png\n")
        self.expect_error("ghost.png")


class Matching(tiny.TestCase):
    """Nothing to match is said, with a way out."""

    def test_database_without_photographs(self):
        database = self.path("database.db")
        self.assert_success(tiny.run(
            [tiny.COLMAP, "database_creator", "--database_path", database]))
        for matcher in "exhaustive_matcher", "sequential_matcher":
            self.assert_one_error(
                tiny.run([tiny.COLMAP, matcher, "--database_path", database,
                          "--SiftMatching.use_gpu", "0"]), "feature_extractor")


class Meshing(tiny.TestCase):

    def test_no_points(self):
        result = tiny.run([tiny.COLMAP, "poisson_mesher", "--input_path", self.path("none.ply"),
                           "--output_path", self.path("mesh.ply")])
        self.assert_one_error(result, self.path("none.ply"))


class Undistorter(tiny.TestCase):

    def setUp(self):
        super().setUp()
        self.names = ["a.png", "b.png", "c.png"]
        tiny.make_images(self.path("images"), self.names)
        tiny.make_model(self.path("sparse"), self.names)

    def undistort(self, output="u", **options):
        command = [tiny.COLMAP, "image_undistorter", "--image_path", self.path("images"),
                   "--input_path", self.path("sparse"), "--output_path", self.path(output)]
        for name, value in options.items():
            command += ["--" + name, str(value)]
        return tiny.run(command)

    def test_another_size(self):
        tiny.write_png(self.path("images/b.png"), 48, 32, bytes(48 * 32))
        for options in ({}, {"max_image_size": 64}):
            result = self.undistort(**options)
            self.assert_success(result)
            self.assertIn("1 of 3 photographs", result.stdout)
            self.assertIn("48x32", result.stdout)
            with open(self.path("u/stereo/fusion.cfg")) as file:
                self.assertEqual(file.read(), "a.png\nc.png\n")

    def test_no_photograph(self):
        for name in self.names:
            os.remove(self.path("images", name))
        self.assert_one_error(self.undistort(), "--image_path")
        self.assertFalse(os.path.exists(self.path("u/sparse/cameras.bin")))

    def test_no_photograph_of_other_formats(self):
        for name in self.names:
            tiny.write_png(self.path("images", name), 48, 32, bytes(48 * 32))
        for kind in ("PMVS", "CMP-MVS"):
            self.assert_one_error(self.undistort(output_type=kind), "--image_path")

    def test_never_writes_over_its_input(self):
        before = tiny.snapshot(self.folder, ".")
        self.assert_one_error(self.undistort("."), "images", "--output_path")
        self.assertEqual(before, tiny.snapshot(self.folder, "."))
        self.assert_success(self.undistort(copy_policy="soft-link"))
        self.assertTrue(os.path.islink(self.path("u/images/a.png")))
        self.assert_success(self.undistort(max_image_size=48))
        after = tiny.snapshot(self.folder, "images")
        self.assertEqual({name[len("images/"):]: content for name, content in before.items()
                          if name.startswith("images/")}, after)

    def test_strong_distortion(self):
        with open(self.path("sparse/cameras.txt"), "w") as file:
            file.write("1 SIMPLE_RADIAL 96 64 70 48 32 -1.2\n")
        result = self.undistort()
        self.assert_success(result)
        self.assertIn("WARNING: Without the distortion of camera 1", result.stdout)


if __name__ == "__main__":
    unittest.main()
