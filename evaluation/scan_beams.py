"""The beams of a laser scan, kept by direction so that those close to a place are found fast."""

import numpy as np

from . import blocks

_ANGLE_MARGIN = 1e-9  # Added to angles on either side, against rounding.


class ScanBeams:
    """Rays from the scanner, at the origin, through the points that it measured.

    They are in a grid over azimuth (columns, from -pi on) and inclination (rows, from the
    vertical axis on). points: those of the scan, (n, 3), in the order of the grid. A point
    at the scanner itself has no beam and is left out.
    """

    def __init__(self, points):
        points = points[(points != 0).any(axis=1)]
        # For a few points per cell. Finer cells than 0.04 degrees would be smaller than beams.
        self._num_rows = int(np.clip(np.sqrt(len(points) / 6), 8, 4096))
        self._num_columns = 2 * self._num_rows
        cells = np.empty(len(points), np.int32)
        for part in blocks.slices(len(points)):
            cells[part] = self._cells_of(points[part].astype(np.float64))
        self.points = points[np.argsort(cells, kind="stable")]
        # Cell i has points[starts[i]:starts[i + 1]].
        num_cells = self._num_rows * self._num_columns
        self._starts = np.zeros(num_cells + 1, np.int64)
        np.cumsum(np.bincount(cells, minlength=num_cells), out=self._starts[1:])

    def _row_of(self, inclination):
        return np.floor(inclination * (self._num_rows / np.pi)).astype(np.int64)

    def _column_of(self, azimuth):
        """Without a bound, as azimuths go round."""
        return np.floor((azimuth + np.pi) * (self._num_columns / (2 * np.pi))).astype(np.int64)

    def _cells_of(self, points):
        inclination, azimuth = _direction(points)
        return (np.clip(self._row_of(inclination), 0, self._num_rows - 1) * self._num_columns
                + np.clip(self._column_of(azimuth), 0, self._num_columns - 1))

    def near(self, places, distances):
        """Yields the beams that pass places (n, 3) at no more than their distances (n,).

        Arrays place, begin, end of one length: places[place[i]] is close to the beams of
        points[begin[i]:end[i]], and maybe to fewer. place rises in each of them.
        """
        inclination, azimuth = _direction(places)
        angle = _half_angle(np.linalg.norm(places, axis=1), distances)
        row_begin = np.maximum(self._row_of(inclination - angle), 0)
        row_end = np.minimum(self._row_of(inclination + angle) + 1, self._num_rows)
        # Between the planes through the vertical axis that touch the sphere around the place.
        angle = _half_angle(np.hypot(places[:, 0], places[:, 1]), distances)
        begin, end = self._column_of(azimuth - angle), self._column_of(azimuth + angle) + 1

        goes_round = end - begin >= self._num_columns
        place = np.flatnonzero(goes_round)
        yield (place, self._starts[row_begin[place] * self._num_columns],
               self._starts[row_end[place] * self._num_columns])
        others = np.flatnonzero(~goes_round)
        for which, row in blocks.numbered((row_end - row_begin)[others]):
            place = others[which]
            row += row_begin[place]
            yield self._cells(place, row, np.maximum(begin[place], 0),
                              np.minimum(end[place], self._num_columns))
            yield self._cells(place, row, begin[place] + self._num_columns, self._num_columns)
            yield self._cells(place, row, 0, end[place] - self._num_columns)

    def _cells(self, place, row, begin, end):
        """Those of columns from begin to end, where there are any."""
        some = np.flatnonzero(begin < end)
        begin, end = (np.broadcast_to(column, row.shape)[some] for column in (begin, end))
        first = row[some] * self._num_columns
        return place[some], self._starts[first + begin], self._starts[first + end]


def _direction(points):
    """Inclination and azimuth."""
    x, y, z = points.T
    return np.arctan2(np.hypot(x, y), z), np.arctan2(y, x)


def _half_angle(lengths, distances):
    """At which spheres of radius distance are seen; pi from within them."""
    outside = lengths > distances
    ratio = np.divide(distances, lengths, out=np.zeros_like(lengths), where=outside)
    return np.where(outside, np.arcsin(ratio) + _ANGLE_MARGIN, np.pi)
