"""Whatever is wrong with the input: one line, an exit status, maps kept."""

import os
import resource
import shutil
import signal
import subprocess
import unittest

import tiny_workspace as tiny


class Incomplete(tiny.TestCase):
    """Parts of the workspace are missing or make no sense."""

    def setUp(self):
        super().setUp()
        self.names = tiny.make_workspace(self.folder)

    def write_config(self, text):
        with open(self.path("stereo", "patch-match.cfg"), "w") as file:
            file.write(text)

    def expect_error(self, *texts, **options):
        before = tiny.snapshot(self.folder)
        result = tiny.run_stereo(self.folder, **options)
        self.assert_one_error(result, *texts)
        self.assertEqual(before, tiny.snapshot(self.folder))

    def test_no_workspace(self):
        result = tiny.run_stereo(self.path("nowhere"))
        self.assert_one_error(result, "nowhere")
        self.assertFalse(os.path.exists(self.path("nowhere")))

    def test_workspace_is_a_file(self):
        result = tiny.run_stereo(self.path("images", self.names[0]))
        self.assert_one_error(result, self.names[0])

    def test_no_config(self):
        os.remove(self.path("stereo", "patch-match.cfg"))
        self.expect_error("patch-match.cfg")

    def test_config_path_is_wrong(self):
        result = tiny.run_stereo(self.folder,
                                 ["--config_path", self.path("none.cfg")])
        self.assert_one_error(result, "none.cfg")

    def test_no_sparse_model(self):
        os.remove(self.path("sparse", "points3D.txt"))
        self.expect_error("sparse")

    def test_damaged_sparse_model(self):
        with open(self.path("sparse", "cameras.txt"), "w") as file:
            file.write("1 NO_SUCH_MODEL 96 64 1 2 3 4\n")
        self.expect_error(self.folder)

    def test_no_images_folder(self):
        shutil.rmtree(self.path("images"))
        self.expect_error("images")

    def test_unknown_reference_image(self):
        self.write_config("ghost.jpg\n__all__\n")
        self.expect_error("ghost.jpg", "reference")

    def test_unknown_source_image(self):
        self.write_config("view0.png\nview1.png, ghost.jpg\n")
        self.expect_error("ghost.jpg", "source")

    def test_reference_without_source_line(self):
        self.write_config("view0.png\n__all__\nview1.png\n")
        self.expect_error("view1.png")

    def test_empty_config(self):
        self.write_config("# nothing\n")
        self.expect_error("patch-match.cfg")

    def test_garbage_after_auto(self):
        self.write_config("view0.png\n__auto__, x\n")
        self.expect_error("__auto__", "view0.png")

    def test_only_source_is_the_view_itself(self):
        self.write_config("view0.png\nview0.png\n")
        self.expect_error("view0.png", "source")

    def test_no_range_of_depths(self):
        tiny.make_model(self.path("sparse"), self.names, num_points=0)
        self.expect_error("depth_min")

    def test_missing_image(self):
        os.remove(self.path("images", "view1.png"))
        self.expect_error("view1.png", "missing")

    def test_unreadable_image(self):
        with open(self.path("images", "view1.png"), "w") as file:
            file.write("This is no image.\n")
        self.expect_error("view1.png", "read")

    def test_truncated_image(self):
        os.truncate(self.path("images", "view1.png"), 1000)
        self.expect_error("view1.png")

    def test_truncated_jpeg(self):
        photo = os.path.join(os.environ.get("TAPA_DATA", ""),
                             "fountain/images/0000.jpg")
        if not os.path.exists(photo):
            self.skipTest("TAPA_DATA does not name the real image sets")
        image = self.path("images", "view1.png")
        shutil.copy(photo, image)
        os.truncate(image, os.path.getsize(photo) // 2)
        tiny.make_model(self.path("sparse"), self.names, separate_cameras=True)
        cameras = self.path("sparse", "cameras.txt")
        with open(cameras) as file:
            lines = file.read().splitlines()
        lines[1] = lines[1].replace(" 96 64 ", " 1536 1024 ")
        with open(cameras, "w") as file:
            file.write("\n".join(lines) + "\n")
        self.expect_error("view1.png", "read")

    def test_image_size_is_not_the_cameras(self):
        tiny.write_png(self.path("images", "view1.png"), 48, 32,
                       bytes(48 * 32))
        self.expect_error("view1.png", "48x32", "96x64")
        self.expect_error("view1.png", "48x32", "96x64", max_image_size=48)


class DamagedMaps(tiny.TestCase):
    """Maps that are there already cannot be used."""

    def setUp(self):
        super().setUp()
        self.names = tiny.make_workspace(self.folder)
        self.assert_success(tiny.run_stereo(self.folder))
        for name in self.names[:2]:
            os.remove(tiny.map_path(self.folder, name))

    def expect_error(self, *texts, **options):
        before = tiny.snapshot(self.folder)
        self.assert_one_error(tiny.run_stereo(self.folder, **options), *texts)
        self.assertEqual(before, tiny.snapshot(self.folder))

    def test_truncated_depth_map(self):
        path = tiny.map_path(self.folder, "view1.png", which="photometric")
        os.truncate(path, 1000)
        self.expect_error(path, "truncated")

    def test_truncated_normal_map(self):
        path = tiny.map_path(self.folder, "view1.png", "normal_maps",
                             "photometric")
        os.truncate(path, 1000)
        self.expect_error(path, "truncated")

    def test_empty_map(self):
        path = tiny.map_path(self.folder, "view1.png", which="photometric")
        os.truncate(path, 0)
        self.expect_error(path)

    def test_truncated_final_map(self):
        path = tiny.map_path(self.folder, "view3.png")
        os.truncate(path, 1000)
        self.expect_error(path, "truncated")

    def test_map_of_another_size(self):
        path = tiny.map_path(self.folder, "view1.png", which="photometric")
        with open(path, "wb") as file:
            file.write(b"48&32&1&" + bytes(4 * 48 * 32))
        self.expect_error(path, "48x32", "96x64")

    def test_maps_of_another_max_image_size(self):
        self.expect_error("max_image_size was -1, is 48", max_image_size=48)
        # Where it is not known what made the maps, their size says it.
        for which in ("photometric", "geometric"):
            os.remove(self.path("stereo", "options.%s.txt" % which))
        self.expect_error("96x64", "48x32", max_image_size=48)

    def test_map_of_a_source_that_is_not_computed(self):
        path = tiny.map_path(self.folder, "view3.png", which="photometric")
        os.truncate(path, 1000)
        with open(self.path("stereo", "patch-match.cfg"), "w") as file:
            file.write("view0.png\n__all__\n")
        self.expect_error(path, "truncated")


class BadOptions(tiny.TestCase):

    def setUp(self):
        super().setUp()
        tiny.make_workspace(self.folder)

    def test_out_of_range(self):
        for name, value in (("window_radius", 33), ("window_radius", 0),
                            ("window_step", 3), ("num_samples", 0),
                            ("num_iterations", 0), ("num_threads", 0),
                            ("num_threads", -2), ("seed", -1),
                            ("ncc_sigma", 0), ("sigma_color", -1),
                            ("filter_min_ncc", 2), ("filter_min_ncc", "nan"),
                            ("min_triangulation_angle", 180),
                            ("geom_consistency_max_cost", -1),
                            ("cache_size", 0), ("max_image_size", 0),
                            ("gpu_index", "x"), ("gpu_index", "0,,1")):
            with self.subTest(name=name, value=value):
                result = tiny.run_stereo(self.folder, **{name: value})
                self.assert_one_error(result, "PatchMatchStereo." + name)

    def test_empty_range_of_depths(self):
        result = tiny.run_stereo(self.folder, depth_min=3, depth_max=2)
        self.assert_one_error(result, "PatchMatchStereo.depth_max")

    def test_only_one_end_of_the_range(self):
        result = tiny.run_stereo(self.folder, depth_max=3)
        self.assert_one_error(result, "PatchMatchStereo.depth_min")
        result = tiny.run_stereo(self.folder, depth_min=3)
        self.assert_one_error(result, "PatchMatchStereo.depth_max")

    def test_unknown_option(self):
        result = tiny.run_stereo(self.folder, no_such_option=1)
        self.assert_one_error(result, "no_such_option")

    def test_not_a_number(self):
        result = tiny.run_stereo(self.folder, window_radius="five")
        self.assert_one_error(result, "five")

    def test_no_workspace_given(self):
        result = tiny.run([tiny.COLMAP, "patch_match_stereo"])
        self.assert_one_error(result, "workspace_path")

    def test_unknown_workspace_format(self):
        result = tiny.run_stereo(self.folder, ["--workspace_format", "MVE"])
        self.assert_one_error(result, "workspace_format")


def _limit_file_size(limit):
    """For a child process: writing beyond that many bytes of a file fails."""
    def apply():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
    return apply


class Shortage(tiny.TestCase):

    @unittest.skipIf("ASAN_OPTIONS" in os.environ, "AddressSanitizer needs more addresses")
    def test_makes_do_with_fewer_threads(self):
        # The stacks of that many threads do not fit.
        tiny.make_workspace(self.folder)
        limit = 3 << 30
        result = tiny.run(
            tiny.stereo_command(self.folder, num_threads=1024),
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS,
                                                  (limit, limit)))
        self.assert_success(result)


class CannotWrite(tiny.TestCase):

    def setUp(self):
        super().setUp()
        self.names = tiny.make_workspace(self.folder)

    def test_no_room(self):
        # A depth map has 24,576 bytes. What fits is less than that.
        result = tiny.run(tiny.stereo_command(self.folder),
                          preexec_fn=_limit_file_size(20000))
        self.assert_one_error(result, "view0.png.photometric.bin")
        self.assertEqual(os.listdir(self.path("stereo", "depth_maps")), [])
        self.assertEqual(os.listdir(self.path("stereo", "normal_maps")), [])

    def test_no_room_for_a_model(self):
        for kind in ("TXT", "BIN"):
            def convert(name, **options):
                os.mkdir(self.path(name))
                return tiny.run(
                    [tiny.COLMAP, "model_converter", "--input_path", self.path("sparse"),
                     "--output_path", self.path(name), "--output_type", kind], **options)

            self.assert_success(convert(kind))
            sizes = {name: os.path.getsize(self.path(kind, name))
                     for name in os.listdir(self.path(kind))}
            largest = max(sizes, key=sizes.get)
            result = convert(kind + "2", preexec_fn=_limit_file_size(sizes[largest] // 2))
            self.assert_one_error(result, largest)

    def test_full_disk(self):
        depth_maps = self.path("stereo", "depth_maps")
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=40k", "none",
                           depth_maps], stderr=subprocess.DEVNULL
                          ).returncode != 0:
            self.skipTest("may not mount a small file system")
        self.addCleanup(subprocess.run, ["umount", depth_maps])
        result = tiny.run_stereo(self.folder)
        self.assert_one_error(result, "No space left on device")
        # The first one fitted, and is whole.
        self.assertEqual(os.listdir(depth_maps), ["view0.png.photometric.bin"])
        tiny.read_map(tiny.map_path(self.folder, "view0.png",
                                    which="photometric"))

    def test_read_only(self):
        depth_maps = self.path("stereo", "depth_maps")
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "ro", "none",
                           depth_maps], stderr=subprocess.DEVNULL
                          ).returncode != 0:
            self.skipTest("may not mount a read-only file system")
        self.addCleanup(subprocess.run, ["umount", depth_maps])
        self.assert_one_error(tiny.run_stereo(self.folder), depth_maps)

    def test_output_folder_is_a_file(self):
        os.rmdir(self.path("stereo", "normal_maps"))
        with open(self.path("stereo", "normal_maps"), "w") as file:
            file.write("in the way")
        self.assert_one_error(tiny.run_stereo(self.folder), "normal_maps")


class Fusion(tiny.TestCase):

    def fuse(self, output, **options):
        return tiny.run([tiny.COLMAP, "stereo_fusion", "--workspace_path",
                         self.folder, "--output_path", output], **options)

    def test_no_workspace(self):
        self.assert_one_error(self.fuse(self.path("fused.ply")))

    def test_no_room(self):
        tiny.make_workspace(self.folder)
        self.assert_success(tiny.run_stereo(self.folder))
        self.assert_success(self.fuse(self.path("fused.ply")))
        size = os.path.getsize(self.path("fused.ply"))
        result = self.fuse(self.path("fused2.ply"),
                           preexec_fn=_limit_file_size(size // 2))
        self.assert_one_error(result, "fused2.ply")


if __name__ == "__main__":
    unittest.main()
