"""Shares of good points in which the density of points has no weight."""

import dataclasses

import numpy as np

from . import blocks

_GRID_SHIFTS = (0.0, 0.5)
_MAX_CELL = 2e9
_POINTS_PER_PART = 1 << 22


@dataclasses.dataclass
class Verdicts:
    """What became of points at all tolerances, which are numbered in rising order.

    What is good at one is good at all that follow.
    """
    # The first tolerance at which a point is good; their number if there is none.
    first_good: np.ndarray
    # Whether it is bad at the tolerances before. Otherwise it cannot be judged there and
    # does not count.
    judged: np.ndarray

    def good_at(self, tolerance):
        return self.first_good <= tolerance


def average(points, verdicts, num_tolerances, voxel_size):
    """Share of good points among those that are judged, for each tolerance.

    The mean over all cubes of edge voxel_size that hold judged points. There are two grids
    of cubes, one shifted by half an edge along all axes, and the mean is taken over the cubes
    of both. 0 where nothing is judged.

    Which cube a point is in is computed in single precision, so that points at multiples of
    the edge fall where one expects them; cubes further than 2e9 edges from the origin are one.
    """
    shares, num_cubes = np.zeros(num_tolerances), np.zeros(num_tolerances, np.int64)
    # Cubes are dealt out to parts, neighbours to different ones, to save memory.
    num_parts = 1 + len(points) // _POINTS_PER_PART
    for shift in _GRID_SHIFTS:
        for part in range(num_parts):
            cells, chosen = _cells_of_part(points, voxel_size, shift, part, num_parts)
            if not len(cells):
                continue
            ids = _cube_ids(cells)
            order = np.argsort(ids)
            ids, chosen = ids[order], chosen[order]
            starts = np.flatnonzero(np.diff(ids, prepend=ids[0] - 1))
            first_good, judged = verdicts.first_good[chosen], verdicts.judged[chosen]
            for tolerance in range(num_tolerances):
                good = first_good <= tolerance
                num_good = np.add.reduceat(good, starts, dtype=np.int64)
                num_judged = np.add.reduceat(good | judged, starts, dtype=np.int64)
                counts = num_judged > 0
                shares[tolerance] += (num_good[counts] / num_judged[counts]).sum()
                num_cubes[tolerance] += np.count_nonzero(counts)
    return [float(share / max(number, 1)) for share, number in zip(shares, num_cubes)]


def _cells_of_part(points, voxel_size, shift, part, num_parts):
    """Cubes, (n, 3), of the points that are in one part of them, and which points these are."""
    cells, chosen = [], []
    for block in blocks.slices(len(points)):
        with np.errstate(over="ignore"):
            cell = np.floor(points[block] * np.float32(1 / voxel_size) + np.float32(shift))
        cell = np.clip(cell, -_MAX_CELL, _MAX_CELL).astype(np.int32)
        inside = np.flatnonzero(cell.sum(axis=1, dtype=np.int64) % num_parts == part)
        cells.append(cell[inside])
        chosen.append((block.start + inside).astype(np.uint32))
    return (np.concatenate(cells or [np.empty((0, 3), np.int32)]),
            np.concatenate(chosen or [np.empty(0, np.uint32)]))


def _cube_ids(cells):
    """One number for each cube."""
    low = cells.min(axis=0).astype(np.int64)
    spans = [int(span) for span in cells.max(axis=0) - low + 1]
    if spans[0] * spans[1] * spans[2] < 2 ** 62:
        x, y, z = (cells - low).T
        return (x * spans[1] + y) * spans[2] + z
    # Very far apart: the values that there are on an axis are numbered first.
    ids = np.zeros(len(cells), np.int64)
    for axis in range(3):
        values, numbers = np.unique(cells[:, axis], return_inverse=True)
        ids = np.unique(ids * len(values) + numbers, return_inverse=True)[1]
    return ids
