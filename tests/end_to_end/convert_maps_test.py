#!/usr/bin/env python3
"""Maps go out of a workspace as files of other programs and into another one by
scripts/convert_maps, and the real programs take them for what they are."""

import os
import shutil
import unittest

import tiny_workspace as tiny

PROGRAM = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scripts/convert_maps")
NAMES = ["view0.png", "left/view.png", "view2.png", "view3.png"]


class ConvertMaps(tiny.TestCase):

    def setUp(self):
        super().setUp()
        self.here, self.there = self.path("here"), self.path("there")
        tiny.make_workspace(self.here, names=NAMES)
        tiny.make_workspace(self.there, names=NAMES)
        self.assert_success(tiny.run_stereo(self.here, write_consistency_graph=1))

    def export(self, kind):
        self.assert_success(tiny.run([PROGRAM, "export", "--workspace_path", self.here,
                                      "--output_path", self.path(kind), "--format", kind]))

    def importing(self, kind, *words):
        return tiny.run([PROGRAM, "import", "--workspace_path", self.there, "--input_path",
                         self.path(kind), *words])

    def fuse(self, workspace):
        """What is in the file of points."""
        output = os.path.join(workspace, "fused.ply")
        self.assert_success(tiny.run([
            tiny.COLMAP, "stereo_fusion", "--workspace_path", workspace, "--output_path", output]))
        with open(output, "rb") as file:
            return file.read()

    def test_the_same_points(self):
        points = self.fuse(self.here)
        self.assertGreater(len(tiny.read_cloud(os.path.join(self.here, "fused.ply"))[1]), 1000)
        for kind in ("exr", "pfm", "npy"):
            self.export(kind)
            self.assert_success(self.importing(kind, "--overwrite"))
            for name in NAMES:
                for folder in ("depth_maps", "normal_maps"):
                    paths = [tiny.map_path(workspace, name, folder)
                             for workspace in (self.here, self.there)]
                    self.assertEqual(*map(tiny.read_map, paths))
            self.assertEqual(points, self.fuse(self.there))

    def test_nearly_the_same_points(self):
        self.fuse(self.here)
        count = len(tiny.read_cloud(os.path.join(self.here, "fused.ply"))[1])
        self.export("png")
        for with_normals in (True, False):
            if not with_normals:
                shutil.rmtree(self.path("png", "normals"))
            self.assert_success(self.importing("png", "--overwrite"))
            self.fuse(self.there)
            points = tiny.read_cloud(os.path.join(self.there, "fused.ply"))[1]
            self.assertAlmostEqual(len(points) / count, 1, delta=0.01 if with_normals else 0.3)
            errors = sorted(abs(z - (4 + x / 4)) for x, _, z, *_ in points)
            self.assertLess(errors[len(errors) // 2], 0.02)

    def test_stereo_does_not_take_them_for_its_own(self):
        self.export("exr")
        self.assert_success(self.importing("exr"))
        result = tiny.run_stereo(self.there, seed=7)
        self.assert_success(result)
        self.assertIn("options that are not known", result.stdout)
        self.assertFalse(os.path.exists(os.path.join(self.there, "stereo",
                                                     "options.geometric.txt")))
        self.assertEqual(*(tiny.read_map(tiny.map_path(workspace, NAMES[1]))
                           for workspace in (self.here, self.there)))

    def test_stereo_computes_the_rest(self):
        """A depth that another program knows stays what it is among maps of stereo."""
        self.export("npy")
        for name in NAMES[1:]:
            os.remove(self.path("npy", "depth", name + ".npy"))
        self.assert_success(self.importing("npy"))
        imported = tiny.read_map(tiny.map_path(self.there, NAMES[0]))
        self.assert_success(tiny.run_stereo(self.there, seed=7))
        self.assertEqual(imported, tiny.read_map(tiny.map_path(self.there, NAMES[0])))
        self.assertFalse(os.path.exists(os.path.join(self.there, "stereo",
                                                     "options.geometric.txt")))
        self.fuse(self.there)
        self.assertGreater(len(tiny.read_cloud(os.path.join(self.there, "fused.ply"))[1]), 1000)

    def test_maps_of_stereo_are_kept(self):
        self.export("exr")
        before = tiny.snapshot(self.here)
        self.there = self.here
        self.assert_one_error(self.importing("exr"), "options.geometric.txt", "--overwrite")
        self.assert_same_files(before, tiny.snapshot(self.here))
        self.assert_success(self.importing("exr", "--overwrite"))
        self.fuse(self.here)


if __name__ == "__main__":
    unittest.main()
