"""Signs that the score of a cloud does not say what it should.

Each function returns a sentence for the user, "" where there is nothing to say.
"""

import numpy as np

_MAX_SAMPLE = 100000
_MAX_SIZE_RATIO = 20  # Metres and millimetres, or inches, differ by more than that.


def typical_radius(points):
    """Median distance from the place that has the medians of the coordinates.

    A few stray points do not change it. It is taken of at most 100000 points, evenly drawn.
    0 for no points.
    """
    if not len(points):
        return 0.0
    sample = points[::-(-len(points) // _MAX_SAMPLE)].astype(np.float64)
    return float(np.median(np.linalg.norm(sample - np.median(sample, axis=0), axis=1)))


def check_unit(reconstruction, scan, name):
    """Whether a scan looks as if it had another unit than the reconstruction."""
    radius, scan_radius = typical_radius(reconstruction), typical_radius(scan)
    if not radius or not scan_radius:
        return ""  # A single point, or many at one place, have no size.
    ratio = max(scan_radius / radius, radius / scan_radius)
    if ratio < _MAX_SIZE_RATIO:
        return ""
    return (f"{name} is {ratio:.2g} times {'larger' if scan_radius > radius else 'smaller'} than "
            f"the reconstruction (half of the points are within {scan_radius:.2g} and "
            f"{radius:.2g} of their centres): see to it that both are in metres")


def check_precision(points, least_tolerance, name):
    """Whether single precision stores coordinates to no better than a tenth of a tolerance."""
    if points.dtype != np.float32:
        return ""
    largest = float(max(points.max(), -points.min())) if len(points) else 0.0
    step = largest * float(np.finfo(np.float32).eps)
    if step <= least_tolerance / 10:
        return ""
    return (f"{name} has coordinates of up to {largest:.2g}, which single precision stores to "
            f"{step:.2g} only: move everything nearer to the origin")


def check_overlap(completeness, largest_tolerance, num_tolerances):
    """Whether no point of the scans is complete at the largest tolerance."""
    if completeness.good_at(num_tolerances - 1).any():
        return ""
    return (f"no point of the scans is within {largest_tolerance:.2g} m of the reconstruction: "
            "see to it that the reconstruction is in the frame of the MeshLab project, and in "
            "metres")


def check_judged(accuracy, num_tolerances):
    """Whether no point of the reconstruction is judged."""
    if accuracy.judged.any() or accuracy.good_at(num_tolerances - 1).any():
        return ""
    return ("no point of the reconstruction can be judged, as none is in a beam of a scanner, "
            "before a measured point or close to it; the accuracy is given as 0")
