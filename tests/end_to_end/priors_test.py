"""Depth maps from elsewhere: what they are taken for, and what is wrong with them."""

import os
import shutil
import struct
import unittest

import tiny_workspace as tiny


def write_pfm(path, width, height, values):
    """Values row by row, the first row on top."""
    os.makedirs(os.path.dirname(path), exist_ok=True)
    rows = [values[row * width:(row + 1) * width] for row in range(height)]
    with open(path, "wb") as file:
        file.write(b"Pf\n%d %d\n-1.0\n" % (width, height))
        for row in reversed(rows):
            file.write(struct.pack("<%df" % width, *row))


class Priors(tiny.TestCase):

    # The scene does not change from row to row.
    WRONG = staticmethod(lambda depth, row: 1 + row)

    def setUp(self):
        super().setUp()
        self.names = tiny.make_workspace(self.folder)

    def write_prior(self, index, width=48, height=32, value=lambda depth, row: 0.5 / depth + 0.1,
                    name=None):
        """Inverse depths of a unit of their own, half as large as the photographs."""
        name = name or self.names[index] + ".pfm"
        write_pfm(self.path("priors", name), width, height, [
            value(tiny.depth_at((col + 0.5 - width / 2) / (tiny.FOCAL * width / tiny.WIDTH),
                                index * tiny.BASELINE), row)
            for row in range(height) for col in range(width)])

    def write_all(self, **arguments):
        for i in range(len(self.names)):
            self.write_prior(i, **arguments)

    def stereo(self, *arguments, **options):
        return tiny.run_stereo(self.folder, arguments,
                               **{"prior_path": self.path("priors"), **options})


class Maps(Priors):

    def test_they_help(self):
        """One iteration finds little alone."""
        self.write_all()
        for tapa in (0, 1):
            medians = []
            for prior_path in ("", self.path("priors")):
                shutil.rmtree(self.path("stereo"))
                tiny.make_config(self.folder, self.names)
                result = self.stereo(prior_path=prior_path, filter=0, tapa=tapa)
                self.assert_success(result)
                errors, _ = tiny.depth_errors(self.folder, self.names[1], 1)
                medians.append(sorted(errors)[len(errors) // 2])
            self.assertIn("4 of 4 views have one, and 4 of them fit", result.stdout)
            self.assertLess(medians[1], medians[0])
            self.assertLess(medians[1], 0.01)

    def test_only_some_views(self):
        self.write_prior(2)
        self.write_prior(1, value=self.WRONG)
        result = self.stereo()
        self.assert_success(result)
        self.assertIn("2 of 4 views have one, and 1 of them fit", result.stdout)
        self.assertIn("WARNING: The depth map " + self.path("priors", "view1.png.pfm")
                      + " does not fit", result.stdout)

    def test_what_does_not_fit_changes_nothing(self):
        self.assert_success(self.stereo(prior_path=""))
        expected = tiny.snapshot(self.folder)
        shutil.rmtree(self.path("stereo"))
        tiny.make_config(self.folder, self.names)
        self.write_all(value=self.WRONG)
        self.assert_success(self.stereo())
        actual = tiny.snapshot(self.folder)
        for name in expected:
            if name.endswith(".bin"):
                self.assertEqual(expected[name], actual[name], name)

    def test_levels(self):
        names = self.names = self.names[:3]
        shutil.rmtree(self.folder)
        size = {"width": 512, "height": 336}
        tiny.make_images(self.path("images"), names, **size)
        tiny.make_model(self.path("sparse"), names, **size)
        tiny.make_config(self.folder, names)
        self.write_all(width=64, height=42)
        result = self.stereo()
        self.assert_success(result)
        self.assertIn("level 1", result.stdout)

    def test_names(self):
        self.write_prior(0, name="view0.pfm")
        self.assertIn("1 of 4 views have one, and 1 of them fit", self.stereo().stdout)


class Kept(Priors):
    """Maps that are there already."""

    def setUp(self):
        super().setUp()
        self.write_all()
        self.assert_success(self.stereo())
        self.before = tiny.snapshot(self.folder)

    def test_same_priors(self):
        result = self.stereo()
        self.assert_success(result)
        self.assertIn("nothing to do", result.stdout)
        self.assert_same_files(self.before, tiny.snapshot(self.folder))

    def test_goes_on(self):
        for kind in ("depth_maps", "normal_maps"):
            os.remove(tiny.map_path(self.folder, self.names[1], kind))
        self.assert_success(self.stereo())
        self.assert_same_files(self.before, tiny.snapshot(self.folder))

    def test_other_priors_are_noticed(self):
        self.assert_one_error(self.stereo(prior_path=""), "other priors")
        self.write_prior(1, value=lambda depth, row: depth)
        self.assert_one_error(self.stereo(), "other priors")
        os.remove(self.path("priors", self.names[1] + ".pfm"))
        self.assert_one_error(self.stereo(), "other priors")
        self.assert_same_files(self.before, tiny.snapshot(self.folder))


class BadPriors(Priors):

    def expect_error(self, *texts):
        before = tiny.snapshot(self.folder)
        self.assert_one_error(self.stereo(), *texts)
        self.assert_same_files(before, tiny.snapshot(self.folder))

    def test_no_folder(self):
        self.expect_error("no folder of depth maps", self.path("priors"), "view0.png.exr")

    def test_none(self):
        os.mkdir(self.path("priors"))
        self.expect_error("no depth maps in " + self.path("priors"))

    def test_shape(self):
        self.write_all()
        self.write_prior(2, width=40, height=32)
        self.expect_error("view2.png.pfm has 40x32 pixels", "96x64")

    def test_damaged(self):
        self.write_all()
        path = self.path("priors", "view2.png.pfm")
        os.truncate(path, os.path.getsize(path) // 2)
        self.expect_error(path)
        for extension in ("exr", "png", "npy"):
            os.replace(path, self.path("priors", "view2.png." + extension))
            path = self.path("priors", "view2.png." + extension)
            self.expect_error(path)


if __name__ == "__main__":
    unittest.main()
