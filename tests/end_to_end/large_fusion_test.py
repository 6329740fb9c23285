"""Fusion of 50 views of 6 megapixels is faster than COLMAP's rule, in little memory.

    COLMAP=build/bin/colmap python3 tests/end_to_end/large_fusion_test.py

prints how long both took and how much memory. The maps are exact, of a wall; each of its
points is in ten views, as many as photographs of a room have in common.
"""

import os
import re
import time
import unittest

import memory_test
import tiny_workspace as tiny

NUM_VIEWS = 50
WIDTH, HEIGHT = 3000, 2000
BASELINE = 0.4  # A tenth of the depth: neighbours share nine tenths of what they see.
MAX_MEGABYTES = 2000
MAX_SECONDS = 1800  # On a slow machine.


class LargeFusionTest(tiny.TestCase):

    def fuse(self, name, *options):
        begin = time.monotonic()
        result = tiny.run([
            tiny.COLMAP, "stereo_fusion", "--workspace_path", self.folder, "--output_path",
            self.path(name + ".ply"), *options], timeout=MAX_SECONDS)
        seconds = time.monotonic() - begin
        self.assert_success(result)
        megabytes = memory_test.peak_megabytes(result)
        points = int(re.search(r"Number of fused points: (\d+)", result.stdout)[1])
        print("%s: %.0f s, %d MB, %d points" % (name, seconds, megabytes, points), flush=True)
        return seconds, megabytes

    def test_time_and_memory(self):
        names = memory_test.make_workspace(self.folder, NUM_VIEWS, WIDTH, HEIGHT, BASELINE)
        memory_test.write_maps(self.folder, names, WIDTH, HEIGHT)
        seconds, megabytes = self.fuse("agreement")
        colmap_seconds, _ = self.fuse("colmap", "--StereoFusion.agreement", "0")
        self.assertLess(megabytes, MAX_MEGABYTES)
        self.assertLess(seconds, colmap_seconds)


if __name__ == "__main__":
    unittest.main()
