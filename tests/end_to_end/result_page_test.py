#!/usr/bin/env python3
"""scripts/result_page shows what the real programs leave in a workspace."""

import os
import unittest

import tiny_workspace as tiny

PROGRAM = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scripts/result_page")


class ResultPage(tiny.TestCase):

    def run_with_log(self, name, command):
        result = tiny.run(command)
        self.assert_success(result)
        with open(self.path(name + ".log"), "w") as file:
            file.write(result.stdout)

    def test_all_that_there_is(self):
        names = tiny.make_workspace(
            self.folder, names=["view0.png", "left/view.png", "view2.png", "gone.png"])
        os.remove(self.path("images", "gone.png"))
        self.run_with_log("stereo", tiny.stereo_command(
            self.folder, tapa=1, tapa_debug=self.path("tapa_debug"), allow_missing_files=1,
            write_consistency_graph=1, seed=17))
        self.run_with_log("fusion", [
            tiny.COLMAP, "stereo_fusion", "--workspace_path", self.folder, "--output_path",
            self.path("fused.ply")])
        result = tiny.run([PROGRAM, self.folder])
        self.assertEqual((result.returncode, result.stdout),
                         (0, "Page: %s\n" % self.path("result.html")))
        with open(self.path("result.html"), encoding="utf-8") as file:
            text = file.read()
        for name in names[:3]:
            for title in ("photograph", "depth", "normals", "confidence of points",
                          "photographs that agree", "origin of depth"):
                self.assertIn('alt="%s of %s"' % (title, name), text)
        self.assertRegex(text, "<td>gone.png</td><td>[^<]*its image [^<]* is missing")
        self.assertEqual(text.count("; stereo took "), 3)
        self.assertRegex(text, r"<td>Dense stereo</td><td>[\d.]+ s</td><td>stereo.log</td>")
        self.assertRegex(text, r"<td>fusion</td><td>[\d.]+ s</td><td>fusion.log</td>")
        self.assertIn("<td>seed</td><td>17</td><td>17</td>", text)


if __name__ == "__main__":
    unittest.main()
