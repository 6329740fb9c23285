"""TAPA in the program: its options, and the record of a workspace's options."""

import os
import unittest

import tiny_workspace as tiny

SWITCHES = ("tapa_texture_weighting", "tapa_fine_superpixels",
            "tapa_coarse_superpixels", "tapa_refinement")


def record_path(workspace, which="geometric", stereo="stereo"):
    return os.path.join(workspace, stereo, "options.%s.txt" % which)


def read_record(workspace, which="geometric"):
    with open(record_path(workspace, which)) as file:
        lines = [line for line in file.read().splitlines()
                 if not line.startswith("#")]
    return dict(line.split(" = ") for line in lines)


class Switches(tiny.TestCase):

    def setUp(self):
        super().setUp()
        self.names = tiny.make_workspace(self.folder)

    def run_with(self, name, **options):
        """Files of a run in a workspace of its own."""
        workspace = self.path(name)
        tiny.make_workspace(workspace)
        self.assert_success(tiny.run_stereo(workspace, num_iterations=2,
                                            **options))
        for view in self.names:
            width, height, depths = tiny.read_map(
                tiny.map_path(workspace, view))
            self.assertEqual((width, height), (tiny.WIDTH, tiny.HEIGHT))
            self.assertGreater(sum(depth > 0 for depth in depths),
                               len(depths) / 4)
        return tiny.snapshot(workspace)

    def test_every_switch(self):
        maps = {"plain": self.run_with("plain"),
                "all": self.run_with("all", tapa=1),
                "again": self.run_with("again", tapa=1)}
        self.assertEqual(maps["all"], maps["again"])
        for switch in SWITCHES:
            maps[switch] = self.run_with(switch, tapa=1, **{switch: 0})
        name = "depth_maps/%s.geometric.bin" % self.names[1]
        contents = {case: maps[case][name] for case in maps
                    if case != "again"}
        self.assertEqual(len(set(contents.values())), len(contents),
                         "a switch does nothing")
        self.assertEqual(read_record(self.path("plain"))["tapa"], "0")
        self.assertEqual(read_record(self.path("all"))["tapa"], "1")

    def test_refinement_is_for_the_last_pass(self):
        maps = self.run_with("all", tapa=1)
        others = self.run_with("without", tapa=1, tapa_refinement=0)
        name = "depth_maps/%s.%s.bin"
        for view in self.names:
            self.assertEqual(maps[name % (view, "photometric")],
                             others[name % (view, "photometric")])

    def test_everything_off_is_without_filter(self):
        maps = self.run_with("off", tapa=1, **{s: 0 for s in SWITCHES})
        others = self.run_with("plain", filter=0)
        name = "depth_maps/%s.geometric.bin" % self.names[0]
        self.assertEqual(maps[name], others[name])

    def test_colours_matter(self):
        workspace = self.path("colours")
        tiny.make_workspace(workspace)
        grey = self.run_with("grey", tapa=1)
        for name in self.names:
            tiny.color_halves(os.path.join(workspace, "images", name))
        self.assert_success(tiny.run_stereo(workspace, num_iterations=2,
                                            tapa=1))
        name = "depth_maps/%s.geometric.bin" % self.names[1]
        self.assertNotEqual(grey[name], tiny.snapshot(workspace)[name])

    def test_other_sizes_and_windows(self):
        self.assert_success(tiny.run_stereo(self.folder, tapa=1,
                                            max_image_size=40,
                                            geom_consistency=0))
        width, height, _ = tiny.read_map(tiny.map_path(
            self.folder, self.names[0], which="photometric"))
        self.assertEqual(width, 40)

    def test_project_file(self):
        with open(self.path("project.ini"), "w") as file:
            file.write("workspace_path = %s\n[PatchMatchStereo]\n"
                       "num_iterations = 1\ntapa = true\n"
                       "tapa_coarse_superpixels = false\n"
                       "tapa_textureness_variance = 1.25e-05\n" % self.folder)
        result = tiny.run([tiny.COLMAP, "patch_match_stereo",
                           "--project_path", self.path("project.ini")])
        self.assert_success(result)
        self.assertIn("tapa: 1\n", result.stdout)
        record = read_record(self.folder)
        self.assertEqual(record["tapa"], "1")
        self.assertEqual(record["tapa_coarse_superpixels"], "0")
        self.assertEqual(float(record["tapa_textureness_variance"]), 1.25e-5)

    def test_new_project_file(self):
        # What the program writes itself it reads again.
        result = tiny.run([tiny.COLMAP, "project_generator", "--output_path",
                           self.path("project.ini")])
        self.assert_success(result)
        with open(self.path("project.ini")) as file:
            text = file.read()
        for switch in SWITCHES:
            self.assertIn("%s=true" % switch, text)
        self.assertIn("\ntapa=false\n", text)
        text = text.replace("\ntapa=false\n", "\ntapa=true\n")
        text = text.replace("\nnum_iterations=4\n", "\nnum_iterations=1\n")
        # Options of other commands are not known to this one.
        section = text[text.index("[PatchMatchStereo]\n"):].split("\n[")[0]
        with open(self.path("project.ini"), "w") as file:
            file.write("workspace_path = %s\n%s\n" % (self.folder, section))
        self.assert_success(tiny.run([tiny.COLMAP, "patch_match_stereo",
                                      "--project_path",
                                      self.path("project.ini")]))
        # The same as the defaults on the command line.
        self.assert_success(tiny.run([tiny.COLMAP, "patch_match_stereo",
                                      "--workspace_path", self.folder,
                                      "--PatchMatchStereo.num_iterations", "1",
                                      "--PatchMatchStereo.tapa", "1"]))

    def test_out_of_range(self):
        for name, value in (("tapa_min_textureness", 0),
                            ("tapa_weight_range", 2),
                            ("tapa_fine_divisor", 0),
                            ("tapa_coarse_divisor", -1),
                            ("tapa_fill_radius", -1),
                            ("tapa_completion_agreement", 1.5),
                            ("tapa_textureness_variance", "nan")):
            with self.subTest(name=name, value=value):
                result = tiny.run_stereo(self.folder, tapa=1, **{name: value})
                self.assert_one_error(result, "PatchMatchStereo." + name)


class Pictures(tiny.TestCase):
    """tapa_debug writes pictures of every view that the last pass computes."""

    ALL = ["00_legend", "01_photograph", "02_textureness",
           "03_fine_superpixels", "04_coarse_superpixels", "05_fine_planes",
           "06_coarse_planes", "07_chosen_hypotheses", "08_swept_depth",
           "09_filtered_depth", "10_plane_agreement", "11_origin",
           "12_final_depth", "13_final_normals"]

    def setUp(self):
        super().setUp()
        self.names = tiny.make_workspace(
            self.folder, names=["view0.png", "view1.png", "left/view.png",
                                "right/far/view.png"])

    def run_stereo(self, **options):
        return tiny.run_stereo(self.folder, **{
            "tapa": 1, "tapa_debug": self.path("pictures"), **options})

    def expect_pictures(self, view, missing=(), folder="pictures"):
        folder = self.path(folder, view)
        self.assertEqual(
            sorted(os.listdir(folder)),
            [name + ".png" for name in self.ALL if name not in missing])
        for name in os.listdir(folder):
            width, height, pixels = tiny.read_rgb_png(
                os.path.join(folder, name))
            self.assertEqual(len(pixels), height * (3 * width + 1))
            if name != "00_legend.png":
                self.assertEqual((width, height), (tiny.WIDTH, tiny.HEIGHT))

    def test_every_view(self):
        result = self.run_stereo()
        self.assert_success(result)
        self.assertNotIn("WARNING", result.stdout)
        for name in self.names:
            self.expect_pictures(name)
        # It is written down nowhere, and the maps are the same without it.
        self.assertNotIn("tapa_debug", read_record(self.folder))
        maps = tiny.snapshot(self.folder)
        other = self.path("other")
        tiny.make_workspace(other, names=self.names)
        self.assert_success(tiny.run_stereo(other, tapa=1))
        self.assertEqual(maps, tiny.snapshot(other))

    def test_photometric_pass_only(self):
        # One iteration: no plane was fitted before refinement.
        self.assert_success(self.run_stereo(geom_consistency=0))
        self.expect_pictures(self.names[0])

    def test_parts_that_are_off(self):
        self.assert_success(self.run_stereo(tapa_coarse_superpixels=0,
                                            tapa_refinement=0,
                                            tapa_texture_weighting=0))
        self.expect_pictures(self.names[0], missing=(
            "04_coarse_superpixels", "06_coarse_planes",
            "09_filtered_depth", "10_plane_agreement", "11_origin"))

    def test_smaller_than_the_photograph(self):
        self.assert_success(self.run_stereo(max_image_size=48))
        width, height, _ = tiny.read_rgb_png(
            self.path("pictures", self.names[2], "12_final_depth.png"))
        self.assertEqual((width, height), (48, 32))

    def test_views_that_have_maps(self):
        self.assert_success(tiny.run_stereo(self.folder, tapa=1))
        os.remove(tiny.map_path(self.folder, self.names[2]))
        # What is left of other runs goes.
        folder = self.path("pictures", self.names[2])
        os.makedirs(folder)
        for name in ("10_plane_agreement.png", "mine.png"):
            with open(os.path.join(folder, name), "w") as file:
                file.write("of another run")
        result = self.run_stereo()
        self.assert_success(result)
        warnings = [line for line in result.stdout.splitlines()
                    if line.startswith("WARNING")]
        self.assertEqual(len(warnings), 1, result.stdout)
        self.assertIn("3 of 4 views have their maps already", warnings[0])
        self.assertEqual(os.listdir(self.path("pictures")), ["left"])
        os.remove(os.path.join(folder, "mine.png"))
        self.expect_pictures(self.names[2])

    def expect_refusal(self, *texts, **options):
        result = self.run_stereo(**options)
        self.assert_one_error(result, *texts)
        maps = [name for name in tiny.snapshot(self.folder)
                if name.endswith(".bin")]
        self.assertEqual(maps, [], "found out too late")

    def test_folder_that_cannot_be_made(self):
        with open(self.path("pictures"), "w"):
            pass
        self.expect_refusal(self.path("pictures"), "cannot be made",
                            "the pictures of tapa_debug")

    def test_folder_of_the_photographs(self):
        # There, the folders of the pictures have the names of photographs.
        self.expect_refusal(self.path("images"), "cannot be made",
                            tapa_debug=self.path("images"))

    def test_folder_that_cannot_be_written(self):
        self.expect_refusal("/proc", tapa_debug="/proc/pictures")

    def test_picture_that_cannot_be_written(self):
        # A folder stands where one of the last files has to go.
        blocked = self.path("pictures", self.names[1], "12_final_depth.png")
        os.makedirs(blocked)
        result = self.run_stereo()
        self.assert_one_error(result, "Cannot write", blocked)
        self.assertFalse(os.path.exists(
            tiny.map_path(self.folder, self.names[1])))
        for folder, _, files in os.walk(self.path("pictures")):
            for name in files:
                self.assertTrue(name.endswith(".png"), "half-written " + name)
                tiny.read_rgb_png(os.path.join(folder, name))
        # It goes on from there.
        os.rmdir(blocked)
        self.assert_success(self.run_stereo())
        for name in self.names:
            self.expect_pictures(name)

    def test_without_tapa(self):
        self.expect_refusal("PatchMatchStereo.tapa_debug", "tapa is on",
                            tapa=0)
        self.assertFalse(os.path.exists(self.path("pictures")))


class Record(tiny.TestCase):
    """A workspace's maps remember the options that made them."""

    def setUp(self):
        super().setUp()
        self.names = tiny.make_workspace(self.folder)

    def expect_refusal(self, *texts, **options):
        before = tiny.snapshot(self.folder)
        result = tiny.run_stereo(self.folder, **options)
        self.assert_one_error(result, "made with other options", *texts)
        self.assertEqual(before, tiny.snapshot(self.folder))

    def test_other_options(self):
        self.assert_success(tiny.run_stereo(self.folder))
        self.expect_refusal("photometric maps", "seed was 0, is 1", seed=1)
        self.expect_refusal("tapa was 0, is 1", tapa=1)
        self.expect_refusal("max_image_size was -1, is 48", max_image_size=48)
        self.expect_refusal("num_samples was 5, is 6; sigma_spatial was -1, is"
                            " 2.5", num_samples=6, sigma_spatial=2.5)
        # Only the second pass depends on these.
        self.expect_refusal("geometric maps", "filter was 1, is 0", filter=0)
        self.expect_refusal("geometric maps",
                            "geom_consistency_max_cost was 3, is 2",
                            geom_consistency_max_cost=2)

    def test_other_options_of_tapa(self):
        self.assert_success(tiny.run_stereo(self.folder, tapa=1))
        self.expect_refusal("tapa was 1, is 0")
        self.expect_refusal("tapa_fine_superpixels was 1, is 0", tapa=1,
                            tapa_fine_superpixels=0)
        self.expect_refusal("geometric maps", "tapa_refinement was 1, is 0",
                            tapa=1, tapa_refinement=0)
        self.expect_refusal("tapa_textureness_variance was 5e-05, is 6e-05",
                            tapa=1, tapa_textureness_variance=0.00006)

    def test_unfinished_run(self):
        self.assert_success(tiny.run_stereo(self.folder))
        for name in self.names[1:]:
            for which in ("photometric", "geometric"):
                os.remove(tiny.map_path(self.folder, name, which=which))
        self.expect_refusal("seed was 0, is 1", seed=1)
        self.assert_success(tiny.run_stereo(self.folder))

    def test_views_that_are_not_in_the_list(self):
        # The record is about all maps beside it.
        tiny.make_config(self.folder, self.names[:1])
        self.assert_success(tiny.run_stereo(self.folder, geom_consistency=0))
        tiny.make_config(self.folder, self.names[1:])
        self.expect_refusal("seed was 0, is 1", geom_consistency=0, seed=1)
        self.assert_success(tiny.run_stereo(self.folder, geom_consistency=0))

    def test_options_that_change_no_map(self):
        self.assert_success(tiny.run_stereo(self.folder))
        os.remove(tiny.map_path(self.folder, self.names[1]))
        # 0.6 is COLMAP's default; no photograph is as large as the limit.
        result = tiny.run_stereo(self.folder, num_threads=1, use_gpu=0,
                                 cache_size=1, allow_missing_files=1,
                                 ncc_sigma=0.6, tapa_fill_radius=7,
                                 max_image_size=2000)
        self.assert_success(result)
        self.assertNotIn("WARNING", result.stdout)

    def test_maps_removed(self):
        self.assert_success(tiny.run_stereo(self.folder))
        for name in self.names:
            for kind in ("depth_maps", "normal_maps"):
                for which in ("photometric", "geometric"):
                    os.remove(tiny.map_path(self.folder, name, kind, which))
        self.assert_success(tiny.run_stereo(self.folder, seed=1))
        for which in ("photometric", "geometric"):
            self.assertEqual(read_record(self.folder, which)["seed"], "1")

    def test_photometric_maps_of_a_last_pass(self):
        # They are filtered, those before a geometric pass are not.
        self.assert_success(tiny.run_stereo(self.folder, geom_consistency=0))
        self.expect_refusal("filter was 1, is 0",
                            "before a geometric pass nothing is filtered")

    def test_photometric_maps_of_a_first_pass(self):
        self.assert_success(tiny.run_stereo(self.folder))
        self.expect_refusal("filter was 0, is 1", geom_consistency=0)
        # Without the filter it is the same pass.
        result = tiny.run_stereo(self.folder, geom_consistency=0, filter=0)
        self.assert_success(result)
        self.assertNotIn("WARNING", result.stdout)

    def test_passes_have_numbers_of_their_own(self):
        names = ("num_iterations", "first_perturbation", "num_samples", "window_step")
        defaults = {name: None for name in tiny.FAST}
        colmap = ["5", "1", "15", "1"]
        for options, photometric, geometric in (
                ({}, ["4", "1", "3", "2"], ["2", "0.125", "3", "2"]),
                ({"num_levels": 2}, ["1", "0.0078125", "3", "2"],
                 ["2", "0.0078125", "3", "2"]),
                ({"colmap_defaults": 1, "num_levels": 3}, colmap, colmap)):
            folder = self.path("options%d" % len(options))
            tiny.make_workspace(folder, num_views=2)
            self.assert_success(tiny.run_stereo(
                folder, **{**defaults, **options, "max_image_size": 24}))
            for which, expected in (("photometric", photometric),
                                    ("geometric", geometric)):
                record = read_record(folder, which)
                self.assertEqual([record[name] for name in names], expected)

    def test_geometric_maps_know_the_pass_before(self):
        self.assert_success(tiny.run_stereo(self.folder))
        for name in self.names:
            for kind in ("depth_maps", "normal_maps"):
                os.remove(tiny.map_path(self.folder, name, kind, "photometric"))
        self.expect_refusal("passes_before was level 0 photometric 1 from 1, is "
                            "level 0 photometric 1 from 0.5",
                            first_perturbation=0.5, geom_perturbation=0.125)

    def test_maps_with_other_rays(self):
        self.assert_success(tiny.run_stereo(self.folder))
        for which in ("photometric", "geometric"):
            path = self.path("stereo", "options.%s.txt" % which)
            with open(path) as file:
                lines = file.readlines()
            with open(path, "w") as file:
                file.writelines(line for line in lines if not line.startswith("rays"))
        self.expect_refusal("rays was not set, is through the centres of pixels")

    def test_maps_of_unknown_origin(self):
        self.assert_success(tiny.run_stereo(self.folder))
        expected = tiny.snapshot(self.folder)
        os.remove(record_path(self.folder, "photometric"))
        os.remove(record_path(self.folder, "geometric"))
        result = tiny.run_stereo(self.folder, seed=1)
        self.assert_success(result)
        warnings = [line for line in result.stdout.splitlines()
                    if line.startswith("WARNING")]
        self.assertEqual(len(warnings), 2, result.stdout)
        self.assertIn("not known", warnings[0])
        actual = tiny.snapshot(self.folder)
        self.assertEqual(actual, {name: expected[name] for name in expected
                                  if not name.startswith("options.")})

    def test_damaged_record(self):
        self.assert_success(tiny.run_stereo(self.folder))
        path = record_path(self.folder, "photometric")
        for content in (b"", b"seed = 0", b"\0\xff\n"):
            with open(path, "wb") as file:
                file.write(content)
            result = tiny.run_stereo(self.folder)
            self.assert_one_error(result, path, "damaged" if content
                                  else "empty")

    def test_it_is_the_same_after_every_run(self):
        self.assert_success(tiny.run_stereo(self.folder))
        before = tiny.snapshot(self.folder)
        self.assert_success(tiny.run_stereo(self.folder))
        self.assertEqual(before, tiny.snapshot(self.folder))


class Resume(tiny.TestCase):

    def test_goes_on(self):
        names = tiny.make_workspace(self.folder)
        options = {"tapa": 1, "num_iterations": 2}
        self.assert_success(tiny.run_stereo(self.folder, **options))
        expected = tiny.snapshot(self.folder)
        for name in names[1:3]:
            for kind in ("depth_maps", "normal_maps"):
                os.remove(tiny.map_path(self.folder, name, kind))
        os.remove(tiny.map_path(self.folder, names[3], which="photometric"))
        result = tiny.run_stereo(self.folder, num_threads=1, **options)
        self.assert_success(result)
        self.assertEqual(expected, tiny.snapshot(self.folder))


if __name__ == "__main__":
    unittest.main()
