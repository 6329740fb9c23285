"""Agreement of depth maps with measured depth.

An estimate is a pixel of the depth map with a positive, finite depth; a measurement is
such a pixel of the ground truth. The two may differ in size: a pixel corresponds to that
one of the other map in which its centre lies. An estimate d is within a tolerance of a
measurement g if |d - g| <= tolerance, where a relative tolerance is taken of g.
"""

import dataclasses
from typing import NamedTuple

import numpy as np

from .depth_maps import is_depth
from .processes import Failure


class Tolerance(NamedTuple):
    """unit: m, or % of the true depth."""
    value: float
    unit: str

    def limits(self, measured):
        return measured * self.value / 100 if self.unit == "%" else self.value


def _share(part, whole):
    return part / whole if whole else None


@dataclasses.dataclass
class DepthMapScore:
    """Of one map or several. Shares are 0 to 1, and None where there is nothing to share."""
    tolerances: list
    num_maps: int = 0
    # Pixels of the depth maps, those with an estimate, and those whose depth is negative,
    # infinite or not a number, which count as without an estimate.
    num_pixels: int = 0
    num_estimates: int = 0
    num_invalid: int = 0
    # Measurements, and those whose corresponding pixel has an estimate.
    num_measurements: int = 0
    num_measurements_covered: int = 0
    # Estimates whose corresponding pixel has a measurement.
    num_estimates_measured: int = 0
    # For each tolerance: measurements within it of their estimate, and the other way round.
    num_complete: np.ndarray = 0
    num_accurate: np.ndarray = 0
    # Median error of the estimates with a measurement: |d - g| and |d - g| / g.
    median_absolute_error: float = None
    median_relative_error: float = None

    def add_counts(self, other):
        for field in dataclasses.fields(self):
            if field.name.startswith("num_"):
                setattr(self, field.name, getattr(self, field.name) + getattr(other, field.name))

    @property
    def coverage(self):
        return _share(self.num_estimates, self.num_pixels)

    @property
    def measurement_coverage(self):
        return _share(self.num_measurements_covered, self.num_measurements)

    def at(self, i):
        """Completeness, accuracy and F1 at a tolerance. F1 is 0 if completeness is.

        Shares of nothing are None: where few pixels are measured, the pixels of a small map
        may all miss them.
        """
        completeness = _share(int(self.num_complete[i]), self.num_measurements)
        accuracy = _share(int(self.num_accurate[i]), self.num_estimates_measured)
        if not completeness:
            return completeness, accuracy, completeness
        if accuracy is None:
            return completeness, None, None
        return completeness, accuracy, 2 * completeness * accuracy / (completeness + accuracy)


class ErrorHistogram:
    """The median of any number of values in 2 MB of memory, to within 0.05 %.

    Bins are 1/2048 of a power of two wide and know the mean of their values, so that the
    median is exact where a bin holds one value only. What is below 1e-9 counts as 0, what is
    above 1e9 as one bin.
    """
    _SHIFT = 23 - 11  # Those bits of a float's fraction that choose no bin.
    _FIRST, _LAST = np.array((1e-9, 1e9), np.float32).view(np.uint32) >> _SHIFT

    def __init__(self):
        self._counts = np.zeros(int(self._LAST - self._FIRST) + 2, np.int64)
        self._sums = np.zeros(len(self._counts))

    def add(self, values):
        """values: float32, 0 or more."""
        # The order of the bits of positive floats is that of their values.
        bins = np.clip(values.view(np.uint32) >> self._SHIFT, self._FIRST - 1, self._LAST)
        bins = np.where(values < np.float32(1e-9), 0, bins - self._FIRST + 1)
        self._counts += np.bincount(bins, minlength=len(self._counts))
        self._sums += np.bincount(bins, np.where(bins, values, 0), len(self._counts))

    def median(self):
        """Of an even number of values the mean of the middle two; None if there are none."""
        ends = np.cumsum(self._counts)
        if not ends[-1]:
            return None
        bins = np.searchsorted(ends, ((ends[-1] - 1) // 2, ends[-1] // 2), side="right")
        return float((self._sums[bins] / self._counts[bins]).mean())


def corresponding_pixels(shape, other_shape):
    """Which rows and columns of another map have the centres of the pixels of a map."""
    return np.ix_(*((2 * np.arange(size) + 1) * other // (2 * size)
                    for size, other in zip(shape, other_shape)))


class DepthMapScorer:
    """Scores depth maps, and all of them together, where every pixel counts the same.

    It takes 4 MB, however many maps there are.
    """

    def __init__(self, tolerances):
        self._tolerances = tolerances
        self._overall = DepthMapScore(tolerances, num_complete=np.zeros(len(tolerances), int),
                                      num_accurate=np.zeros(len(tolerances), int))
        self._absolute, self._relative = ErrorHistogram(), ErrorHistogram()

    def add(self, depth, truth, mask=None):
        """Scores one map. mask: which pixels of the truth count, in the map those that
        correspond to one. Raises Failure if one map cannot be the other one scaled."""
        check_shapes(depth.shape, truth.shape)
        to_depth = corresponding_pixels(truth.shape, depth.shape)
        to_truth = corresponding_pixels(depth.shape, truth.shape)
        if mask is None:
            mask = np.ones(truth.shape, bool)
        score = DepthMapScore(self._tolerances, 1)

        # Completeness: over the measurements.
        measured = mask & is_depth(truth)
        estimates = depth[to_depth][measured]
        covered = is_depth(estimates)
        score.num_measurements = len(estimates)
        score.num_measurements_covered, score.num_complete, _ = self._compare(
            estimates[covered], truth[measured][covered])

        # Accuracy: over the estimates.
        counts = mask[to_truth]
        estimated = counts & is_depth(depth)
        score.num_pixels, score.num_estimates, nonzero = map(
            np.count_nonzero, (counts, estimated, depth[counts]))
        score.num_invalid = nonzero - score.num_estimates
        measurements = truth[to_truth][estimated]
        known = is_depth(measurements)
        measurements = measurements[known].astype(np.float64)
        score.num_estimates_measured, score.num_accurate, errors = self._compare(
            depth[estimated][known], measurements)
        absolute, relative = errors.astype(np.float32), (errors / measurements).astype(np.float32)
        score.median_absolute_error, score.median_relative_error = map(
            _median, (absolute, relative))
        self._absolute.add(absolute)
        self._relative.add(relative)
        self._overall.add_counts(score)
        return score

    def _compare(self, estimates, measurements):
        """Number of pairs, how many are within each tolerance, and all errors."""
        measurements = measurements.astype(np.float64)
        errors = np.abs(estimates - measurements)
        return len(errors), np.array([np.count_nonzero(errors <= tolerance.limits(measurements))
                                      for tolerance in self._tolerances], int), errors

    def overall(self):
        return dataclasses.replace(self._overall, median_absolute_error=self._absolute.median(),
                                   median_relative_error=self._relative.median())


def _median(values):
    return float(np.median(values.astype(np.float64))) if len(values) else None


def check_shapes(shape, truth_shape):
    """Raises Failure unless one size is the other one scaled, within one pixel each way."""
    # Judged at the smaller of the two, where rounding matters.
    (height, width), (other_height, other_width) = sorted(
        (truth_shape, shape), key=lambda one: one[1])
    if ((width - 1) / other_width > (height + 1) / other_height
            or (height - 1) / other_height > (width + 1) / other_width):
        raise Failure(f"a depth map of {shape[1]}x{shape[0]} pixels has another shape than its "
                      f"ground truth of {truth_shape[1]}x{truth_shape[0]}")
