"""What is computed from times of views, on a log of which all is known."""

import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
from evaluation.cluster import speed_up  # noqa: E402

_LINE = " 50 %  0:00:10 to go  {} {}/4 view {}.png: 2.00 megapixels in {} s, 1.0 s per megapixel"


def log(steps, elapsed):
    lines = [_LINE.format(name, i + 1, i, seconds)
             for name, step in steps.items() for i, seconds in enumerate(step)]
    return [*lines, f"Elapsed time: {elapsed / 60:.6f} [minutes]"]


class SpeedUpTest(unittest.TestCase):

    def setUp(self):
        self.times = speed_up.Times(log({"level 1 photometric": [1.0, 2.0, 3.0, 4.0],
                                         "photometric": [10.0, 10.0, 10.0, 10.0]}, 55))

    def test_every_kind_of_pass_counts(self):
        steps = {name: [1.0] for name in ("level 1 geometric", "photometric", "draft", "geometric")}
        self.assertEqual(len(speed_up.Times(log(steps, 10)).views()), 4)

    def test_times_of_a_log(self):
        self.assertEqual(self.times.views(), [[1, 2, 3, 4], [10, 10, 10, 10]])
        self.assertAlmostEqual(self.times.start, 5, 3)

    def test_a_step_ends_with_its_slowest_share(self):
        steps = self.times.views()
        self.assertEqual(speed_up.shares(steps[0], 2), [3, 7])
        self.assertEqual(speed_up.shares(steps[0], 9), [1, 2, 3, 4])
        # Two steps, one before and one after.
        self.assertEqual(speed_up.seconds_on(steps, 2, 5, 1), 4 * 6 + 7 + 20)
        self.assertEqual(speed_up.seconds_on(steps, 1000, 0, 0), 4 + 10)

    def test_what_limits(self):
        steps = self.times.views()
        self.assertEqual(speed_up.limit(steps, 1, 1, 0), "computing")
        self.assertEqual(speed_up.limit(steps, 1000, 1, 0), "the slowest view of each step")
        self.assertEqual(speed_up.limit(steps, 1000, 9, 0), "starts of the steps")

    def test_a_share_that_was_computed_again_counts_once(self):
        times = speed_up.Times(log({"photometric": [1.0, 2.0]}, 3) * 2)
        self.assertEqual(times.views(), [[1, 2]])

    def test_the_division_is_that_of_the_program(self):
        for num_items in (1, 5, 12):
            for count in range(1, num_items + 1):
                self.assertEqual(len(speed_up.shares([1.0] * num_items, count)), count)
                self.assertGreater(min(speed_up.shares([1.0] * num_items, count)), 0)


if __name__ == "__main__":
    unittest.main()
