"""Depth maps as other programs might guess them."""

import contextlib
import io
import os
import unittest

import numpy as np

from helpers import TestCase
from evaluation import depth_maps, poor_priors
from evaluation.exchange import formats

HEIGHT, WIDTH = 60, 90


def _depth():
    rows, cols = np.mgrid[:HEIGHT, :WIDTH]
    depth = (3 + rows / HEIGHT + 2 * (cols > 40)).astype(np.float32)
    depth[:5] = 0
    return depth


def _back(prior):
    """Depth in units of the nearest one."""
    return 0.7 / (prior - 0.2)


class PoorPriors(TestCase):

    def make(self, kind):
        own = _depth()
        return poor_priors.make_prior(kind, own, own[:, ::-1], np.random.default_rng(1)), own

    def test_true(self):
        prior, own = self.make("true")
        self.assertTrue((prior[:5] == 0).all())
        np.testing.assert_allclose(_back(prior[5:]) * own[5:].min(), own[5:], rtol=1e-5)

    def test_poor(self):
        prior, own = self.make("poor")
        known = prior > 0
        self.assertFalse(known[:5].any())
        self.assertTrue(0.6 < known[5:].mean() < 0.98)
        ratios = _back(prior[known]) / own[known]
        errors = np.abs(ratios / np.median(ratios) - 1)
        self.assertTrue(0.01 < np.median(errors) < 0.1)

    def test_wrong(self):
        for kind in ("other", "plane", "noise"):
            prior, own = self.make(kind)
            self.assertEqual(prior.shape, own.shape)
            self.assertTrue((prior >= 0).all())
        other, own = self.make("other")
        np.testing.assert_array_equal(other[:, ::-1], self.make("true")[0])

    def test_program(self):
        for folder in ("images/left", "gt_depth/left"):
            os.makedirs(self.path("data", folder))
        for name in ("a.jpg", "b.jpg", "without.jpg"):
            open(self.path("data/images/left", name), "w").close()
        for name in ("a", "b"):
            depth_maps.write_bin(self.path("data/gt_depth/left", name + ".bin"), _depth())
        with contextlib.redirect_stdout(io.StringIO()):
            poor_priors.main([self.path("data"), "--out", self.path("out"), "--kind", "poor"])
        self.assertEqual(sorted(os.listdir(self.path("out/left"))), ["a.jpg.exr", "b.jpg.exr"])
        first, second = (formats.read_numbers(self.path("out/left", name), 1)
                         for name in ("a.jpg.exr", "b.jpg.exr"))
        self.assertEqual(first.shape, (HEIGHT // 2, WIDTH // 2))
        self.assertTrue((first != second).any())


if __name__ == "__main__":
    unittest.main()
