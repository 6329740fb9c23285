"""Scores of depth maps by hand, and next to a reference; medians, textureness and colours."""

import math
import unittest

import numpy as np

import helpers  # noqa: F401 (it finds the package)
from evaluation import view_picture
from evaluation.depth_map_score import (DepthMapScorer, ErrorHistogram, Tolerance, check_shapes,
                                        corresponding_pixels)
from evaluation.processes import Failure
from evaluation.textureness import textureness

NAN, INF = math.nan, math.inf


def score(depth, truth, tolerances=(Tolerance(0.5, "m"),), mask=None):
    return DepthMapScorer(tolerances).add(*(np.array(values, np.float32, ndmin=2)
                                            for values in (depth, truth)), mask)


class ScoreTest(unittest.TestCase):
    def expect(self, found, **values):
        self.assertEqual({name: getattr(found, name) for name in values}, values)

    def test_by_hand(self):
        # Errors: 0, 0.25, 0.5; two measurements without estimate; one estimate without
        # measurement; one pixel of the map is negative.
        found = score([[1, 2.25, 4.5, 0], [3, -1, 0, 0]], [[1, 2, 4, 2], [0, 8, 0, 0]],
                      [Tolerance(0.25, "m"), Tolerance(12.5, "%"), Tolerance(1, "%")])
        self.expect(found, num_maps=1, num_pixels=8, num_estimates=4, num_invalid=1,
                    num_measurements=5, num_measurements_covered=3, num_estimates_measured=3,
                    coverage=0.5, measurement_coverage=0.6, median_absolute_error=0.25,
                    median_relative_error=0.125)
        # A tolerance includes its own value.
        for i, expected in enumerate(((0.4, 2 / 3, 0.5), (0.6, 1, 0.75), (0.2, 1 / 3, 0.25))):
            np.testing.assert_allclose(found.at(i), expected)

    def test_what_is_no_depth(self):
        found = score([NAN, INF, -INF, -2, 0], [1] * 5)
        self.expect(found, num_invalid=4, num_estimates=0, num_measurements=5,
                    median_absolute_error=None)
        self.assertEqual(found.at(0), (0, None, 0))
        found = score([1] * 4, [NAN, INF, -2, 0])
        self.expect(found, num_measurements=0, num_estimates=4, num_estimates_measured=0)
        self.assertEqual(found.at(0), (None, None, None))
        # The only measurement is not at the centre of a pixel of the map.
        found = score([[1]], [[1, 0], [0, 0]], [Tolerance(0.5, "m")])
        self.expect(found, num_measurements=1, num_complete=[1], num_estimates_measured=0)
        self.assertEqual(found.at(0), (1, None, None))

    def test_maps_of_other_sizes(self):
        small, large = [[1, 0]], [[1, 1, 1, 1], [1, 3, 0, 1]]
        # The centre of a small pixel lies on the corner of the lower right one of 2x2.
        found = score(small, large)
        self.expect(found, num_measurements=7, num_measurements_covered=4, num_complete=[3],
                    num_estimates_measured=1, num_accurate=[0])
        found = score(large, small)
        self.expect(found, num_pixels=8, num_estimates=7, num_estimates_measured=4,
                    num_accurate=[3], num_measurements=1, num_complete=[0])
        for size, other, pixels in ((4, 4, [0, 1, 2, 3]), (4, 2, [0, 0, 1, 1]), (2, 4, [1, 3]),
                                    (3, 5, [0, 2, 4]), (3, 1, [0, 0, 0])):
            self.assertEqual(corresponding_pixels((size,), (other,))[0].tolist(), pixels)

    def test_masks_leave_pixels_out(self):
        mask = np.zeros((2, 4), bool)
        mask[0, 0] = mask[1, 1] = True
        found = score([[1, 7]], np.ones((2, 4)), mask=mask)
        self.expect(found, num_pixels=1, num_estimates=1, num_measurements=2,
                    median_absolute_error=0)
        self.assertEqual(found.at(0), (1, 1, 1))

    def test_every_pixel_counts_the_same_overall(self):
        scorer = DepthMapScorer([Tolerance(0.5, "m")])
        self.assertEqual((scorer.overall().num_maps, scorer.overall().at(0)),
                         (0, (None, None, None)))
        scorer.add(np.float32([[2, 3, 4]]), np.ones((1, 3), np.float32))
        second = scorer.add(np.float32([[1, 1], [1, 6]]), np.ones((2, 2), np.float32))
        self.assertEqual(second.median_absolute_error, 0)
        self.expect(scorer.overall(), num_maps=2, num_pixels=7, median_absolute_error=1)
        np.testing.assert_allclose(scorer.overall().at(0), [3 / 7] * 3)

    def test_shapes(self):
        for width, height, other_width, other_height, same in (
                (768, 512, 1536, 1024, True), (1, 1, 1, 1, True), (667, 1000, 4000, 6000, True),
                (500, 333, 6000, 4000, True), (500, 334, 6000, 4000, True),
                (512, 768, 1536, 1024, False), (760, 480, 1536, 1024, False),
                (100, 50, 100, 100, False), (500, 340, 6000, 4000, False)):
            for sizes in ((width, height, other_width, other_height),
                          (other_width, other_height, width, height)):
                shapes = sizes[1::-1], sizes[:1:-1]
                if same:
                    check_shapes(*shapes)
                else:
                    self.assertRaisesRegex(
                        Failure, "a depth map of {}x{} pixels has another shape than its ground "
                        "truth of {}x{}".format(*sizes), check_shapes, *shapes)

    def test_random_maps(self):
        # Pixels by floating-point centres, shares by their definitions.
        random = np.random.default_rng(7)

        def at(values, y, x):
            return values[int(y * values.shape[0] + 1e-9), int(x * values.shape[1] + 1e-9)]

        def pairs(of, other):
            height, width = of.shape
            for (row, col), value in np.ndenumerate(of.astype(float)):
                yield value, float(at(other, (row + 0.5) / height, (col + 0.5) / width))

        for shape, truth_shape in (((23, 31), (23, 31)), ((20, 30), (30, 45)),
                                   ((41, 50), (19, 23))):
            depth, truth = (np.where(random.random(size) < 0.2, random.choice((0, NAN), size),
                                     random.uniform(1, 3, size)).astype(np.float32)
                            for size in (shape, truth_shape))
            met = [(g, d) for g, d in pairs(truth, depth) if g > 0]
            judged = [(g, d) for d, g in pairs(depth, truth) if d > 0 and g > 0]
            found = score(depth, truth, (Tolerance(0.1, "m"), Tolerance(20, "%")))
            self.expect(found, num_measurements=len(met), num_estimates_measured=len(judged))
            self.assertAlmostEqual(found.median_absolute_error,
                                   np.median([abs(d - g) for g, d in judged]), 6)
            for i, limit in enumerate((lambda g: 0.1, lambda g: 0.2 * g)):
                completeness, accuracy = (np.mean([abs(d - g) <= limit(g) for g, d in part])
                                          for part in (met, judged))
                np.testing.assert_allclose(found.at(i), (
                    completeness, accuracy, 2 / (1 / completeness + 1 / accuracy)))


class HistogramTest(unittest.TestCase):
    def test_few_values_are_exact(self):
        histogram = ErrorHistogram()
        self.assertIsNone(histogram.median())
        for value, median in ((4, 4), (0, 2), (0.25, 0.25), (0.125, 0.1875), (1e-30, 0.125)):
            histogram.add(np.array([value], np.float32))
            self.assertEqual(histogram.median(), median)
        for value in (np.finfo(np.float32).max, INF, INF, INF, INF, INF):
            histogram.add(np.array([value], np.float32))
        self.assertEqual(histogram.median(), INF)

    def test_many_values(self):
        for count in (1000, 1001, 100000):
            values = np.random.default_rng(3).lognormal(-5, 3, count).astype(np.float32)
            histogram = ErrorHistogram()
            for part in np.array_split(values, 7):
                histogram.add(part)
            median = np.median(values.astype(float))
            self.assertAlmostEqual(histogram.median(), median, delta=5e-4 * median)


class TexturenessTest(unittest.TestCase):
    def test_variance_of_each_patch(self):
        image = np.random.default_rng(1).integers(0, 256, (7, 9)).astype(np.uint8)
        found = textureness(image)
        for (row, col), value in np.ndenumerate(found):
            patch = image[max(0, row - 2):row + 3, max(0, col - 2):col + 3] / 255
            variance = patch.var()
            self.assertAlmostEqual(value, (variance + 5e-5) / (variance + 1e-4), 6)
        np.testing.assert_array_equal(textureness(image * 0 + 9), 0.5)


class ColorsTest(unittest.TestCase):
    def test_errors(self):
        depth = np.float32([[0, NAN, -1, 2, 2.02, 4, 2]])
        truth = np.float32([[2, 2, 2, 2, 2, 2, 0]])
        *missing, exact, one_percent, far, unknown = view_picture.color_errors(depth, truth)[0]
        self.assertEqual(np.array(missing).tolist(), [[0, 0, 0]] * 3)
        self.assertEqual(unknown.tolist(), [150, 150, 150])
        self.assertGreater(exact[1], exact[0])  # Green, yellow and red.
        self.assertGreater(min(one_percent[:2]), 200)
        self.assertGreater(far[0], 2 * far[1])

    def test_depths(self):
        depth = np.float32([[1, 1, 2, 4, 4, 9, 0]])
        scale = view_picture.depth_scale(depth)
        near, _, _, far, _, farther, none = view_picture.color(depth, scale, depth > 0, "black")[0]
        self.assertGreater(near[0], near[2])  # Red near and blue far.
        self.assertGreater(far[2], far[0])
        self.assertGreater(farther.max(), 40)
        self.assertEqual(none.tolist(), [0, 0, 0])
        for same in (np.zeros((1, 1)), np.full((2, 2), 3.0)):  # No depth, and one only.
            view_picture.color(same, view_picture.depth_scale(same), same > 0, "black")

    def test_normals(self):
        normals = np.float32([[(0, 0, -1), (1, 0, 0), (0, 0, 0)]])
        self.assertEqual(view_picture.color_normals(normals)[0].tolist(),
                         [[128, 128, 255], [255, 128, 128], [0, 0, 0]])
