"""Masks: what they leave out of stereo and of fusion, and what is wrong with them."""

import os
import shutil
import unittest

import tiny_workspace as tiny


class Masks(tiny.TestCase):

    def setUp(self):
        super().setUp()
        self.names = tiny.make_workspace(self.folder)

    def mask_all(self, **arguments):
        for name in self.names:
            tiny.write_mask(self.path("masks", name + ".png"), **arguments)

    def stereo(self, *arguments, **options):
        return tiny.run_stereo(self.folder, arguments,
                               **{"mask_path": self.path("masks"), **options})

    def fuse(self, *arguments, masks=True):
        return tiny.run([tiny.COLMAP, "stereo_fusion", "--workspace_path", self.folder,
                         "--output_path", self.path("fused.ply"),
                         *(["--StereoFusion.mask_path", self.path("masks")]
                           if masks else []), *arguments])

    def columns(self, name, kind="depth_maps", **where):
        """Whether anything is in each column of a map."""
        width, _, values = tiny.read_map(tiny.map_path(self.folder, name, kind, **where))
        return [any(values[column::width]) for column in range(width)]

    def assert_masked(self, names=None, border=0.5, **where):
        """The maps have nothing to the left, and something to the right of it."""
        for name in self.names if names is None else names:
            for kind in ("depth_maps", "normal_maps"):
                columns = self.columns(name, kind, **where)
                first = round(border * len(columns))
                self.assertEqual(columns[:first], [False] * first, name)
                self.assertGreater(sum(columns[first:]), 0.6 * (len(columns) - first))


class Maps(Masks):

    def test_masked_pixels_have_nothing(self):
        self.mask_all()
        for tapa in (0, 1):
            for geometric in (0, 1):
                shutil.rmtree(self.path("stereo"))
                tiny.make_config(self.folder, self.names)
                self.assert_success(self.stereo(
                    tapa=tapa, geom_consistency=geometric, num_iterations=3,
                    write_consistency_graph=1))
                self.assert_masked(which="photometric")
                if geometric:
                    self.assert_masked()

    def test_others_are_right(self):
        self.mask_all()
        self.assert_success(self.stereo(num_iterations=4, window_radius=5,
                                        num_samples=15))
        errors, num_pixels = tiny.depth_errors(self.folder, self.names[1], 1)
        self.assertLess(sorted(errors)[len(errors) // 2], 0.01)
        self.assertGreater(len(errors), 0.3 * num_pixels)

    def test_only_of_some_views(self):
        tiny.write_mask(self.path("masks", self.names[2] + ".png"))
        result = self.stereo()
        self.assert_success(result)
        self.assertIn("3 of 4 images have no mask", result.stdout)
        self.assert_masked(self.names[2:3])
        self.assertTrue(any(self.columns(self.names[1])[:30]))

    def test_sizes(self):
        # Masks larger than the photographs, and maps that are smaller.
        self.mask_all(width=2 * tiny.WIDTH, height=2 * tiny.HEIGHT, border=0.25)
        self.assert_success(self.stereo(max_image_size=48))
        self.assert_masked(border=0.25)
        self.assertFalse(any(self.columns(self.names[0])[:12]))

    def test_levels(self):
        names = self.names[:3]
        shutil.rmtree(self.folder)
        size = {"width": 512, "height": 336}
        tiny.make_images(self.path("images"), names, **size)
        tiny.make_model(self.path("sparse"), names, **size)
        tiny.make_config(self.folder, names)
        self.names = names
        self.mask_all()
        result = self.stereo()
        self.assert_success(result)
        self.assertIn("level 1", result.stdout)
        self.assert_masked()

    def test_pictures(self):
        self.mask_all()
        self.assert_success(self.stereo(tapa=1, tapa_debug=self.path("pictures")))
        self.assertIn("12_final_depth.png",
                      os.listdir(self.path("pictures", self.names[0])))


class Points(Masks):

    def test_fusion_takes_the_same_masks(self):
        self.mask_all()
        self.assert_success(self.stereo(num_iterations=4))
        clouds = []
        for masks in (False, True):
            self.assert_success(self.fuse(masks=masks))
            clouds.append(tiny.read_cloud(self.path("fused.ply")))
        self.assertGreater(len(clouds[0][1]), 100)
        self.assertEqual(*clouds)


class Kept(Masks):
    """Maps that are there already."""

    def setUp(self):
        super().setUp()
        self.mask_all()
        self.assert_success(self.stereo())
        self.before = tiny.snapshot(self.folder)

    def test_goes_on_where_it_was(self):
        result = self.stereo()
        self.assert_success(result)
        self.assertIn("nothing to do", result.stdout)
        for which in ("photometric", "geometric"):
            for kind in ("depth_maps", "normal_maps"):
                os.remove(tiny.map_path(self.folder, self.names[1], kind, which))
        self.assert_success(self.stereo())
        self.assert_same_files(self.before, tiny.snapshot(self.folder))

    def test_the_folder_may_have_another_name(self):
        os.rename(self.path("masks"), self.path("others"))
        self.assert_success(self.stereo(mask_path=self.path("others")))
        self.assert_same_files(self.before, tiny.snapshot(self.folder))

    def test_other_masks_are_noticed(self):
        self.assert_one_error(self.stereo(mask_path=""), "other masks")
        tiny.write_mask(self.path("masks", self.names[1] + ".png"), border=0.25)
        self.assert_one_error(self.stereo(), "other masks")
        os.remove(self.path("masks", self.names[1] + ".png"))
        self.assert_one_error(self.stereo(), "other masks")
        self.assert_same_files(self.before, tiny.snapshot(self.folder))

    def test_masks_that_come_later_are_noticed(self):
        folder = self.path("later")
        tiny.make_workspace(folder)
        self.assert_success(tiny.run_stereo(folder))
        self.assert_one_error(tiny.run_stereo(folder, mask_path=self.path("masks")),
                              "other masks")


class BadMasks(Masks):

    def expect_error(self, *texts):
        """From stereo, which leaves nothing behind, and from fusion by either rule."""
        before = tiny.snapshot(self.folder)
        self.assert_one_error(self.stereo(), *texts)
        self.assert_same_files(before, tiny.snapshot(self.folder))
        for name in self.names:
            tiny.write_true_maps(self.folder, name, self.names.index(name),
                                 tiny.WIDTH, tiny.HEIGHT)
        for rule in ("0", "1"):
            self.assert_one_error(self.fuse("--StereoFusion.agreement", rule), *texts)
        shutil.rmtree(self.path("stereo"))
        tiny.make_config(self.folder, self.names)

    def test_no_folder(self):
        self.expect_error("no folder of masks", self.path("masks"), "view0.png.png")

    def test_no_mask(self):
        os.mkdir(self.path("masks"))
        self.expect_error("no masks in " + self.path("masks"), "view0.png.png")

    def test_shape(self):
        self.mask_all()
        tiny.write_mask(self.path("masks/view2.png.png"), 96, 60)
        self.expect_error("masks/view2.png.png has 96x60", "96x64", "distortion")

    def test_no_image(self):
        self.mask_all()
        with open(self.path("masks/view2.png.png"), "w") as file:
            file.write("This is no image.\n")
        self.expect_error("masks/view2.png.png cannot be read", "remove it")

    def test_cut_off(self):
        self.mask_all()
        path = self.path("masks/view2.png.png")
        os.truncate(path, os.path.getsize(path) // 2)
        self.expect_error("masks/view2.png.png cannot be read")


if __name__ == "__main__":
    unittest.main()
