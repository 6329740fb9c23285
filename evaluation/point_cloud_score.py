"""Agreement of a reconstruction with laser scans as ETH3D defines it.

Schoeps et al., "A Multi-View Stereo Benchmark with High-Resolution Images and Multi-Camera
Videos", CVPR 2017; docs/evaluation.md explains it. Points are stored in single precision, to
which tolerances are rounded, too; distances and beams are computed in double precision, and a
distance that equals a tolerance is within it. No result depends on the number of threads.
"""

import concurrent.futures
import dataclasses

import numpy as np
import scipy.spatial

from . import blocks
from .scan_beams import ScanBeams
from .voxel_average import Verdicts

MAX_NUM_TOLERANCES = 250
_PLACES = 1 << 15  # That are judged at a time.


@dataclasses.dataclass
class LaserScan:
    """points: in the scanner's frame; pose: a matrix, (4, 4), from there to the world."""
    points: np.ndarray
    pose: np.ndarray

    def world_points(self):
        world = np.empty_like(self.points)
        for block in blocks.slices(len(world)):
            world[block] = _rotate(self.pose[:3, :3], self.points[block]) + self.pose[:3, 3]
        return world

    def places(self, points):
        """Points of the world in the scanner's frame, in double precision."""
        return _rotate(self.pose[:3, :3].T, points - self.pose[:3, 3])


@dataclasses.dataclass
class BeamShape:
    """A cone that is cut off at the scanner.

    start_radius: there, in metres; divergence_halfangle: between its axis and its side, in
    degrees.
    """
    start_radius: float = 0.5 * 0.00225
    divergence_halfangle: float = 0.011

    def radius_at(self, distance):
        return self.start_radius + distance * np.tan(np.radians(self.divergence_halfangle))


def _rotate(rotation, points):
    """One column after the other, as a product of matrices may depend on threads."""
    x, y, z = points.T.astype(np.float64)
    return np.stack([row[0] * x + row[1] * y + row[2] * z for row in rotation], axis=1)


def merge_scans(scans):
    """The points of all scans in the world, one scan after the other."""
    return np.concatenate([scan.world_points() for scan in scans])


def _limits(tolerances):
    """Tolerances in the precision of the points, such that points 0.1 apart are within 0.1."""
    return np.array(tolerances, np.float32).astype(np.float64)


def judge_completeness(scan_points, reconstruction, tolerances, num_threads=1):
    """Verdicts of the scans' points: whether a point of the reconstruction is that close.

    tolerances: in rising order.
    """
    first_good = np.full(len(scan_points), len(tolerances), np.uint8)
    if len(reconstruction):
        limits = _limits(tolerances)
        tree = scipy.spatial.cKDTree(reconstruction.astype(np.float64), balanced_tree=False)
        for block in blocks.slices(len(scan_points)):
            # The tree finds what is less than the bound.
            distances, _ = tree.query(scan_points[block], workers=num_threads,
                                      distance_upper_bound=limits[-1] * (1 + 1e-9))
            first_good[block] = np.searchsorted(limits, distances)
    return Verdicts(first_good, np.ones(len(scan_points), bool))


def judge_accuracy(reconstruction, scans, tolerances, shape, num_threads=1):
    """Verdicts of the reconstruction: whether points are that close to one whose beam they are in.

    If not, a point is judged where it is in the part of some beam that the scanner found empty,
    before the beam's point; elsewhere nothing is known about it.
    """
    limits = _limits(tolerances)
    verdicts = Verdicts(np.full(len(reconstruction), len(tolerances), np.uint8),
                        np.zeros(len(reconstruction), bool))
    for scan in scans:
        beams = ScanBeams(scan.points)

        def judge(points, scan=scan, beams=beams):
            least, in_front = _look(scan.places(reconstruction[points]), beams, shape)
            verdicts.first_good[points] = np.minimum(verdicts.first_good[points],
                                                     np.searchsorted(limits, least))
            verdicts.judged[points] |= in_front

        # No other scan can change what is good at all tolerances.
        open_points = np.flatnonzero(verdicts.first_good).astype(np.uint32)
        with concurrent.futures.ThreadPoolExecutor(num_threads) as threads:
            for _ in threads.map(judge, [open_points[block] for block
                                         in blocks.slices(len(open_points), _PLACES)]):
                pass
    return verdicts


def f1_score(completeness, accuracy):
    total = completeness + accuracy
    return 2 * completeness * accuracy / total if total > 0 else 0.0


def _look(places, beams, shape):
    """What one scanner saw at places, (n, 3) in its frame.

    The least distance to a measured point whose beam the place is in, infinite where there is
    none, and whether the place is before such a point.
    """
    lengths = np.linalg.norm(places, axis=1)
    radii = shape.radius_at(lengths)
    least, in_front = np.full(len(places), np.inf), np.zeros(len(places), bool)
    # Places at the scanner are in all beams, and points that some program left at its origin
    # may be many: of equal ones the first is looked at.
    same_as = np.arange(len(places))
    at_scanner = np.flatnonzero(lengths <= radii)
    _, first, which = np.unique(places[at_scanner], axis=0, return_index=True, return_inverse=True)
    same_as[at_scanner] = at_scanner[first[which]]
    looked = np.unique(same_as)
    for place, begin, end in beams.near(places[looked], radii[looked]):
        for which, number in blocks.numbered(end - begin):
            seen = looked[place[which]]
            _measure(seen, places[seen], radii[seen], beams.points[begin[which] + number],
                     least, in_front)
    return np.sqrt(least[same_as]), in_front[same_as]


def _measure(seen, places, radii, ends, least, in_front):
    """Takes beams that end in points into account for one place each.

    seen: which places, in rising order; least: squared distances; both arrays are of all places.
    """
    (px, py, pz), (x, y, z) = (points.T.astype(np.float64, order="C") for points in (places, ends))
    along = x * px + y * py + z * pz
    squared_range = x * x + y * y + z * z
    squared_aside = ((y * pz - z * py) ** 2 + (z * px - x * pz) ** 2 + (x * py - y * px) ** 2)
    inside = np.flatnonzero((along >= 0) & (squared_aside <= radii * radii * squared_range))
    if not len(inside):
        return
    seen = seen[inside]
    squared = ((x[inside] - px[inside]) ** 2 + (y[inside] - py[inside]) ** 2
               + (z[inside] - pz[inside]) ** 2)
    starts = np.flatnonzero(np.diff(seen, prepend=-1))
    seen = seen[starts]
    least[seen] = np.minimum(least[seen], np.minimum.reduceat(squared, starts))
    in_front[seen] |= np.logical_or.reduceat(along[inside] < squared_range[inside], starts)
