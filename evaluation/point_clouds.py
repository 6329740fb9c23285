"""Point clouds in PLY files.

Points are float32 of shape (n, 3), in the unit and the frame of their file, or float64 if the
file has them so and they are far from the origin (is_far). Unreadable files raise Failure with the path in the message.

The reader is our own, as Debian 12 has none that takes every kind of PLY: ascii or binary of
either byte order, properties of any type in any order, lists and other elements among them.
"""

import itertools
import os
import warnings
from typing import NamedTuple

import numpy as np

from . import files
from .processes import Failure

# NumPy's names of PLY's types, both old and new ones.
_TYPES = {name: code for names, code in (
    ("char int8", "i1"), ("uchar uint8", "u1"), ("short int16", "i2"), ("ushort uint16", "u2"),
    ("int int32", "i4"), ("uint uint32", "u4"), ("float float32", "f4"), ("double float64", "f8"))
    for name in names.split()}
_SIZE_TYPES = {name: code for name, code in _TYPES.items() if code[0] != "f"}
_BYTE_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_MAX_LINE = 65536  # Headers have short lines; what does not is another kind of file.
_FAR = 1000.0  # Metres.
_ROWS = 1 << 18  # That are read at a time.


class _Property(NamedTuple):
    """size_type: of the number in front of a list, None where there is one value only."""
    name: str
    type: str
    size_type: str = None


class _Element(NamedTuple):
    """What a header says of the rows of one kind."""
    name: str
    count: int
    properties: list

    def has_lists(self):
        return any(entry.size_type for entry in self.properties)


def is_far(values):
    """Whether single precision stores coordinates to no better than a tenth of a millimetre."""
    return bool(len(values)) and bool(np.abs(values).max() > _FAR)


class Cloud(NamedTuple):
    """Points with their colours, (n, 3) of red, green and blue, and how many views confirm them.

    Those are None where the file does not say. kept: which of the vertices of the file are there.
    """
    points: np.ndarray
    colors: np.ndarray
    confidence: np.ndarray
    kept: np.ndarray


def read_ply(path):
    """Points of a file, and how many were left out as they are not finite."""
    points, finite = _read_finite(path)
    return points, len(finite) - len(points)


def read_cloud(path):
    """Points of a file as a Cloud; those that are not finite are left out."""
    values, finite = _read_finite(path, ("red", "green", "blue", "confidence"))
    colors, confidence = values[:, 3:6], values[:, 6]
    is_colored = bool((colors >= 0).all() and (colors <= 255).all())  # NaN is neither.
    return Cloud(values[:, :3], colors.astype(np.uint8) if is_colored else None,
                 confidence.astype(np.float32) if np.isfinite(confidence).all() else None, finite)


def _read_finite(path, more=()):
    """The vertices whose coordinates are finite, and which of all they are."""
    try:
        with open(path, "rb") as file:
            values = _read_vertices(file, path, more)
    except OSError as error:
        raise Failure(f"{path} cannot be read: {error.strerror}") from error
    # Of single precision: what is beyond its range is as good as infinite.
    finite = (np.abs(values[:, :3]) <= np.finfo(np.float32).max).all(axis=1)
    values = values if finite.all() else values[finite]
    return values if is_far(values[:, :3]) else values.astype(np.float32, copy=False), finite


def _read_vertices(file, path, more):
    """Coordinates and, in the columns behind them, further properties; NaN where there is none."""
    byte_order, elements, num_lines = _read_header(file, path)
    source = _Binary(file, byte_order) if byte_order else _Ascii(file, num_lines)
    for element in elements:
        is_vertex = element.name == "vertex"
        places, columns = _columns(element, path, more) if is_vertex else ([], [])
        # A wrong header must not ask for all memory; what is not touched is not taken.
        most = min(element.count, os.fstat(file.fileno()).st_size)
        is_double = is_vertex and all(element.properties[i].type == "f8" for i in columns[:3])
        values = np.empty((most if is_vertex else 0, 3 + len(more)),
                          np.float64 if is_double else np.float32)
        end = 0
        # What has no properties takes no place in the file.
        for rows in source.rows(element, columns, path) if element.properties else ():
            begin, end = end, end + len(rows)
            if is_vertex:
                with np.errstate(over="ignore", invalid="ignore"):
                    values[begin:end, places] = rows
        if end < element.count and element.properties:
            raise Failure(f"{path} is truncated: of {element.count} elements {element.name} it "
                          f"has {end}")
        if is_vertex:
            values[:, np.setdiff1d(np.arange(values.shape[1]), places)] = np.nan
            return values
    raise Failure(f"{path} has no vertices")


def _read_header(file, path):
    """The byte order ("" of an ascii file), elements in their order, and the number of lines."""
    if file.readline(_MAX_LINE).split() != [b"ply"]:
        raise Failure(f"{path} is not a PLY file")
    byte_order, elements = None, []
    for number in itertools.count(2):
        line = file.readline(_MAX_LINE)
        if not line.endswith(b"\n"):
            raise Failure(f"{path} is truncated: its header has no end")
        words = line.decode("latin-1").split()
        try:
            match words:
                case [] | ["comment", *_] | ["obj_info", *_]:
                    pass
                case ["end_header"]:
                    break
                case ["format", name, "1.0"]:
                    byte_order = _BYTE_ORDERS[name]
                case ["element", name, count] if count.isdecimal():
                    elements.append(_Element(name, int(count), []))
                case ["property", "list", size_type, kind, name]:
                    elements[-1].properties.append(
                        _Property(name, _TYPES[kind], _SIZE_TYPES[size_type]))
                case ["property", kind, name]:
                    elements[-1].properties.append(_Property(name, _TYPES[kind]))
                case _:
                    raise ValueError
        except (IndexError, KeyError, ValueError) as error:
            text = line.decode("latin-1").strip()[:80]
            raise Failure(f"{path} has a header that cannot be understood, line {number}: "
                          f"'{text}'") from error
    if byte_order is None:
        raise Failure(f"{path} does not say its format")
    return byte_order, elements, number


def _columns(element, path, more):
    """Which of the coordinates and further properties a vertex has, and where it has them."""
    columns = {entry.name: i for i, entry in reversed(list(enumerate(element.properties)))
               if not entry.size_type}
    for name in "xyz":
        if name not in columns:
            raise Failure(f"{path} has no property {name} of its vertices")
    found = [(place, columns[name]) for place, name in enumerate(("x", "y", "z", *more))
             if name in columns]
    return [place for place, _ in found], [column for _, column in found]


class _Binary:
    """Reads the rows of elements, one element after the other, from a binary file.

    rows() yields arrays of the values in some columns, (n, columns), of all rows that are
    there; there may be fewer than the header says.
    """

    def __init__(self, file, byte_order):
        self._file = file
        self._byte_order = byte_order
        self._size = os.fstat(file.fileno()).st_size

    def rows(self, element, columns, path):
        if element.has_lists():
            yield from _rows_with_lists(self, element, columns, path)
            return
        row = np.dtype([(str(i), self._byte_order + entry.type)
                        for i, entry in enumerate(element.properties)])
        for begin in range(0, element.count, _ROWS):
            count = min(_ROWS, element.count - begin)
            # A wrong header must not ask for all memory, here either.
            data = self._file.read(min(count * row.itemsize, self._size - self._file.tell()))
            rows = np.frombuffer(data, row, len(data) // row.itemsize)
            values = np.empty((len(rows), len(columns)))
            for i, column in enumerate(columns):
                values[:, i] = rows[str(column)]
            yield values
            if len(rows) < count:
                return

    def begin_row(self):
        pass

    def take(self, kind, count):
        """The next values. Raises EOFError where there are none."""
        size = count * np.dtype(kind).itemsize
        if size > self._size - self._file.tell():
            raise EOFError
        return np.frombuffer(self._file.read(size), self._byte_order + kind)


class _Ascii:
    """The same from an ascii file, in which each row has a line of its own."""

    def __init__(self, file, num_lines):
        self._file = file
        self._number = num_lines
        self._words = []

    def __iter__(self):
        return self

    def __next__(self):
        """The next line that is not empty."""
        for line in self._file:
            self._number += 1
            if not line.isspace():
                return line.decode("latin-1")
        raise StopIteration

    def rows(self, element, columns, path):
        try:
            if element.has_lists() or not columns:
                yield from _rows_with_lists(self, element, columns, path)
                return
            for begin in range(0, element.count, _ROWS):
                count = min(_ROWS, element.count - begin)
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")  # That there are no more rows.
                    rows = np.loadtxt(self, usecols=columns, max_rows=count, ndmin=2,
                                      comments=None)
                yield rows.reshape(-1, len(columns))
                if len(rows) < count:
                    return
        except (OverflowError, ValueError) as error:  # A list of infinite length, or no number.
            reason = str(error).partition(" at row")[0]
            if "invalid column" in reason:
                reason = "there are values missing"
            raise Failure(f"{path}, line {self._number}: {reason}") from error

    def begin_row(self):
        try:
            self._words = next(self).split()
        except StopIteration as error:
            raise EOFError from error

    def take(self, kind, count):
        if count > len(self._words):
            raise ValueError("there are values missing")
        values = [float(word) for word in self._words[:count]]
        del self._words[:count]
        return values


def _rows_with_lists(source, element, columns, path):
    """Goes from value to value, as lists may have any length."""
    for number in range(element.count):
        values = []
        try:
            source.begin_row()
            for entry in element.properties:
                size = 1 if entry.size_type is None else int(source.take(entry.size_type, 1)[0])
                if size < 0:
                    raise Failure(f"{path} is damaged: {element.name} {number} has a list of "
                                  "negative length")
                taken = source.take(entry.type, size)
                values.append(np.nan if entry.size_type else taken[0])
        except EOFError:
            return
        yield np.array([[values[column] for column in columns]])


def write_ply(path, points, colors=None):
    """Writes points as binary PLY, with colours (n, 3) of red, green and blue, 0 to 255."""
    code, kind = ("<f8", "double") if points.dtype == np.float64 else ("<f4", "float")
    fields = [(name, code, kind, points[:, i]) for i, name in enumerate("xyz")]
    if colors is not None:
        fields += [(name, "u1", "uchar", colors[:, i])
                   for i, name in enumerate(("red", "green", "blue"))]
    rows = np.empty(len(points), [(name, code) for name, code, _, _ in fields])
    for name, _, _, values in fields:
        rows[name] = values
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}",
              *(f"property {kind} {name}" for name, _, kind, _ in fields), "end_header", ""]
    files.write_bytes(path, "\n".join(header).encode("ascii"), rows.tobytes())
