"""The graphical interface starts, and its Stereo button works without CUDA: the
window shows how far the run is, and its maps meanwhile."""

import os
import subprocess
import time
import unittest

import tiny_workspace as tiny

OFFSCREEN = {**os.environ, "QT_QPA_PLATFORM": "offscreen"}


class Gui(tiny.TestCase):

    def test_it_starts(self):
        process = subprocess.Popen([tiny.COLMAP, "gui"], env=OFFSCREEN,
                                   stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True)
        time.sleep(3)
        running = process.poll() is None
        process.kill()
        output, _ = process.communicate()
        self.assertTrue(running, output)

    def test_stereo_button(self):
        names = tiny.make_workspace(self.folder)
        self.press_stereo()
        for name in names:
            tiny.read_map(tiny.map_path(self.folder, name))

    def test_stop_button(self):
        tiny.make_workspace(self.folder)
        self.press_stereo("stop")
        self.assertEqual(os.listdir(self.path("stereo", "depth_maps")), [])

    def press_stereo(self, *arguments):
        result = tiny.run([os.environ["GUI_STEREO"], self.folder, *arguments],
                          env=OFFSCREEN)
        self.assertEqual(result.returncode, 0, result.stdout)


if __name__ == "__main__":
    unittest.main()
