"""Several workers share out the views; the maps do not depend on who made them.
"""

import os
import unittest

import tiny_workspace as tiny

CPU = -1
# No machine has that many.
MISSING_GPU = 1000


class Workers(tiny.TestCase):

    def maps(self, name, *workers):
        """Files and output of a run in a workspace of its own."""
        folder = self.path(name)
        self.names = tiny.make_workspace(folder)
        result = tiny.run([os.environ["WORKER_STEREO"], folder] +
                          [str(worker) for worker in workers])
        self.assert_success(result)
        return tiny.snapshot(folder), result.stdout

    def test_maps_do_not_depend_on_their_number(self):
        expected, _ = self.maps("one", CPU)
        actual, output = self.maps("three", CPU, CPU, CPU)
        self.assert_same_files(expected, actual)
        # Every view is reported once in each pass: photometric maps, drafts, geometric maps.
        for name in self.names:
            self.assertEqual(output.count(" %s: " % name), 3, output)
        self.assertIn("Seconds per megapixel and view", output)

    def test_a_failing_gpu_leaves_its_views_to_the_cpu(self):
        expected, _ = self.maps("cpu", CPU)
        actual, output = self.maps("missing", MISSING_GPU, CPU)
        self.assert_same_files(expected, actual)
        self.assertIn("GPU 1000 failed at view", output)
        self.assertIn("from now on the CPU is used in its place", output)


if __name__ == "__main__":
    unittest.main()
