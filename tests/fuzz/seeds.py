#!/usr/bin/python3
"""Writes small valid files for fuzzers to begin with: FOLDER/READER/NAME.

    tests/fuzz/seeds.py FOLDER

READER is that of a fuzzer, tests/fuzz/READER_fuzz.cc or one of readers_fuzz.py.
"""

import contextlib
import json
import os
import sqlite3
import struct
import sys
import tempfile
import zlib

POSE = (1, 0, 0, 0, 0.5, 0, 0)
PLY = "ply\nformat {} 1.0\ncomment x\nelement vertex {}\n{}end_header\n"
XYZ = "".join(f"property float {name}\n" for name in "xyz")
SPLIT = b"----\n"  # Between the files of a model (input.h).


def _png(width, height, bits, channels=1):
    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))

    row = b"\0" + bytes(range(1, 1 + width * channels * bits // 8))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(
        ">IIBBBBB", width, height, bits, 0 if channels == 1 else 2, 0, 0, 0))
        + chunk(b"IDAT", zlib.compress(row * height)) + chunk(b"IEND", b""))


def _pfm(width, height, channels=1):
    return (b"P%s\n%d %d\n-1\n" % (b"f" if channels == 1 else b"F", width, height)
            + struct.pack(f"<{width * height * channels}f", *range(width * height * channels)))


def _npy(kind, shape, data):
    header = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}\n"
    return b"\x93NUMPY\1\0" + struct.pack("<H", len(header)) + header.encode() + data


def _exr(width, height):
    """Of one channel, not compressed."""
    def attribute(name, kind, data):
        return name + b"\0" + kind + b"\0" + struct.pack("<I", len(data)) + data

    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = (b"\x76\x2f\x31\x01\2\0\0\0"
              + attribute(b"channels", b"chlist", b"Z\0" + struct.pack("<iB3xii", 2, 0, 1, 1)
                          + b"\0")
              + attribute(b"compression", b"compression", b"\0")
              + attribute(b"dataWindow", b"box2i", box)
              + attribute(b"displayWindow", b"box2i", box)
              + attribute(b"lineOrder", b"lineOrder", b"\0")
              + attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
              + attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0))
              + attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0")
    line = 8 + 4 * width
    table = b"".join(struct.pack("<Q", len(header) + 8 * height + line * row)
                     for row in range(height))
    return header + table + b"".join(
        struct.pack("<iI", row, 4 * width) + struct.pack(f"<{width}f", *range(width))
        for row in range(height))


def _maps():
    return {"depth": b"3&2&1&" + struct.pack("<6f", *range(6)),
            "normals": b"2&1&3&" + struct.pack("<6f", 0, 0, 0, 0, -1, -1),
            "graph": b"3&2&1&" + struct.pack("<9i", 2, 1, 2, 7, 8, 0, 0, 1, 9)}


def _depth_files():
    return {".exr": _exr(3, 2), ".pfm": _pfm(3, 2), ".png": _png(3, 2, 16),
            ".npy": _npy("<f4", (2, 3), struct.pack("<6f", *range(6)))}


def _text_model():
    return (b"# comment\n3 PINHOLE 640 480 500 500 320 240\n"
            b"4 SIMPLE_RADIAL 640 480 500 320 240 0\n"
            + SPLIT + b"7 1 0 0 0 0.5 0 0 3 first view.jpg\n10 20 1 30 40 -1\n"
            b"8 1 0 0 0 -0.5 0 0 4 x/second.jpg\n\n"
            + SPLIT + b"1 0.1 0.2 4 255 0 9 0.5 7 0 8 0\n")


def _binary_model():
    cameras = struct.pack("<QiiQQ4d", 1, 3, 1, 640, 480, 500, 500, 320, 240)
    images = struct.pack("<Q", 2) + b"".join(
        struct.pack("<I7dI", number, *POSE, 3) + name + b"\0"
        + struct.pack("<Q2dQ", 1, 10, 20, 1) for number, name in ((7, b"a.jpg"), (8, b"b.jpg")))
    points = struct.pack("<QQ3d3Bd", 1, 1, 0.1, 0.2, 4, 255, 0, 9, 0.5) + struct.pack(
        "<Q4I", 2, 7, 0, 8, 0)
    return SPLIT.join((cameras, images, points))


def _database():
    """Of COLMAP, as far as it is read."""
    with tempfile.NamedTemporaryFile() as file:
        with contextlib.closing(sqlite3.connect(file.name)) as database:
            database.executescript(
                "PRAGMA page_size = 512;"
                "CREATE TABLE images(image_id INTEGER PRIMARY KEY, name TEXT);"
                "CREATE TABLE keypoints(image_id INTEGER PRIMARY KEY, rows INTEGER);"
                "CREATE TABLE two_view_geometries(pair_id INTEGER PRIMARY KEY, rows INTEGER);"
                "INSERT INTO images VALUES (1, 'a.jpg'), (2, 'b.jpg');"
                "INSERT INTO keypoints VALUES (1, 10), (2, 0);"
                "INSERT INTO two_view_geometries VALUES (2147483649, 5);")
        return file.read()


_PROJECT = b"""<!DOCTYPE MeshLabDocument>
<MeshLabProject><MeshGroup><MLMesh label="a" filename="a.ply">
<MLMatrix44>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</MLMatrix44></MLMesh></MeshGroup></MeshLabProject>
"""
_PLAN = b"""output = "results.md"
images = "images"
[sets.room]
data = "examples/room"
methods = ["plain", "tapa"]
[[sections]]
title = "Results"
level = 2
text = "x"
set = "room"
show = ["depth"]
"""
_LOG = b"""$ stereo
 50.0 %  0:01 to go  level 1 photometric 1/2 a.jpg: 0.1 megapixels in 1.5 s
WARNING: View a.jpg is left out
===========
Feature extraction
===========
Elapsed time: 0.5 [minutes]
"""


def seeds():
    """Contents by name, by reader."""
    points = struct.pack("<6f", *range(6))
    models = {"model": _text_model()}, {"model": _binary_model()}
    return {
        "map_file": _maps(),
        "depth_file": {kind[1:]: bytes([i]) + data
                       for i, (kind, data) in enumerate(_depth_files().items())},
        "problem_config": {
            "all": b"a.jpg\n__all__\nb.jpg\n__auto__, 2\n",
            "named": b"# comment\n\nx/c, d;e.jpg\na.jpg, b.jpg;x/c, d;e.jpg\n# 1.jpg\na.jpg\n"},
        "options_record": {"record": b"# comment\nwindow_radius = 5\nmask_path = x = y\n"},
        "views_record": {"record": b"# comment\n0a 0b+0c+0d 0e 0f 10 a b.jpg\n1 2 3 4 5 c.jpg\n"},
        "image_names": {"names": b"\xef\xbb\xbfa.jpg\r\n#1.jpg\n# comment\n a.jpg \n"},
        "points_file": {"ply": PLY.format("binary_little_endian", 2, XYZ).encode() + points},
        "text_model": models[0], "binary_model": models[1],
        # Of the evaluation.
        "ply": {
            "ascii": PLY.format("ascii", 2, XYZ + "property list uchar int l\n").encode()
            + b"1 2 3 0\n4 5 6 1 7\n",
            "binary": PLY.format("binary_little_endian", 2, XYZ).encode() + points,
            "big": PLY.format("binary_big_endian", 1, XYZ + "property list uchar int l\n").encode()
            + struct.pack(">3fBi", 1, 2, 3, 1, 4)},
        "visibility": {"vis": struct.pack("<Q6I", 2, 3, 0, 1, 2, 1, 0)},
        "meshlab_project": {"mlp": _PROJECT},
        "evaluation_text_model": models[0], "evaluation_binary_model": models[1],
        "evaluation_map": _maps(), "graph": _maps(),
        "numbers": {kind[1:]: bytes([i]) + data
                    for i, (kind, data) in enumerate(_depth_files().items())},
        "normals": {"png": b"\2" + _png(3, 2, 16, 3), "pfm": b"\1" + _pfm(3, 2, 3)},
        "json": {"scores": json.dumps({"a": [1, 2.5, None, {"b": "c"}]}).encode()},
        "plan": {"plan": _PLAN}, "log": {"log": _LOG}, "database": {"database": _database()},
    }


def main(folder):
    for reader, files in seeds().items():
        os.makedirs(os.path.join(folder, reader), exist_ok=True)
        for name, content in files.items():
            with open(os.path.join(folder, reader, name), "wb") as file:
                file.write(content)


if __name__ == "__main__":
    main(*sys.argv[1:])
