"""Makes small dense workspaces and runs the built program on them.

The scene is a slanted plane with a random texture, seen by cameras in a row.
Needs nothing but Python's standard library. The environment variable COLMAP
names the program, where it is not build/bin/colmap.
"""

import math
import os
import random
import re
import shutil
import struct
import subprocess
import tempfile
import unittest
import zlib

WIDTH = 96
HEIGHT = 64
FOCAL = 100.0
BASELINE = 0.3  # Between neighbouring cameras, in scene units.
CELLS_PER_UNIT = 24  # Of the texture.

COLMAP = os.environ.get("COLMAP") or os.path.join(
    os.path.dirname(os.path.abspath(__file__)), "../../build/bin/colmap")
# One iteration and a small window: enough to tell files apart, and fast.
FAST = {"num_iterations": 1, "window_radius": 3, "num_samples": 5}


def _texture(seed=1):
    """Grey value, 0 to 255, by position on the plane."""
    rng = random.Random(seed)
    size = 256
    cells = [[rng.randrange(256) for _ in range(size)] for _ in range(size)]

    def sample(x, y):
        u, v = x * CELLS_PER_UNIT, y * CELLS_PER_UNIT
        iu, iv = int(u // 1), int(v // 1)
        fu, fv = u - iu, v - iv
        row0, row1 = cells[iv % size], cells[(iv + 1) % size]
        a, b = iu % size, (iu + 1) % size
        top = row0[a] * (1 - fu) + row0[b] * fu
        bottom = row1[a] * (1 - fu) + row1[b] * fu
        return int(top * (1 - fv) + bottom * fv)

    return sample


_SAMPLE = _texture()


def depth_at(x, center_x):
    """Depth of the plane Z = 4 + X / 4 at the ray (x, ., 1) of a camera."""
    return (4 + center_x / 4) / (1 - x / 4)


def render(center_x, width, height):
    """Grey values of what a camera sees, row by row."""
    scale = width / WIDTH
    pixels = bytearray()
    for row in range(height):
        y = (row + 0.5 - height / 2) / (FOCAL * scale)
        for col in range(width):
            x = (col + 0.5 - width / 2) / (FOCAL * scale)
            z = depth_at(x, center_x)
            pixels.append(_SAMPLE(center_x + x * z + 8, y * z + 8))
    return bytes(pixels)


def write_png(path, width, height, pixels, channels=1):
    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data +
                struct.pack(">I", zlib.crc32(kind + data)))

    stride = width * channels
    rows = b"".join(b"\0" + pixels[row * stride:(row + 1) * stride]
                    for row in range(height))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" +
                   chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8,
                                              0 if channels == 1 else 2, 0, 0,
                                              0)) +
                   chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def write_mask(path, width=WIDTH, height=HEIGHT, border=0.5):
    """Masks what is to the left of a share of the width."""
    os.makedirs(os.path.dirname(path), exist_ok=True)
    write_png(path, width, height, bytes(
        0 if i % width < border * width else 255 for i in range(width * height)))


def read_rgb_png(path):
    """Returns width, height and the filtered rows of a PNG of 8-bit colour.

    Fails unless the file is whole.
    """
    with open(path, "rb") as file:
        data = file.read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", path + " is no PNG"
    chunks = {}
    at = 8
    while b"IEND" not in chunks:
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        content = data[at + 8:at + 8 + size]
        checksum, = struct.unpack(">I", data[at + 8 + size:at + 12 + size])
        assert checksum == zlib.crc32(kind + content), path + " is damaged"
        chunks[kind] = chunks.get(kind, b"") + content
        at += 12 + size
    width, height, bits, color = struct.unpack(">IIBB", chunks[b"IHDR"][:10])
    assert (bits, color) == (8, 2), path + " is not in colour"
    return width, height, zlib.decompress(chunks[b"IDAT"])


def color_halves(path):
    """Gives a grey image of write_png a red and a blue half."""
    with open(path, "rb") as file:
        data = file.read()
    width, height = struct.unpack(">II", data[16:24])
    begin = data.index(b"IDAT")
    size, = struct.unpack(">I", data[begin - 4:begin])
    rows = zlib.decompress(data[begin + 4:begin + 4 + size])
    pixels = bytearray()
    for row in range(height):
        for col in range(width):
            grey = rows[row * (width + 1) + 1 + col]
            pixels += bytes((grey, grey // 2, grey // 4) if col < width / 2
                            else (grey // 4, grey // 2, grey))
    write_png(path, width, height, bytes(pixels), channels=3)


def make_model(path, names, width=WIDTH, height=HEIGHT, num_points=60,
               separate_cameras=False):
    """Writes a sparse text model, in which every view sees every point."""
    os.makedirs(path, exist_ok=True)
    rng = random.Random(2)
    focal = FOCAL * width / WIDTH
    points = []
    for _ in range(num_points):
        x, y = rng.uniform(-1, 2), rng.uniform(-1, 1)
        points.append((x, y, 4 + x / 4))
    with open(os.path.join(path, "cameras.txt"), "w") as file:
        for i in range(len(names) if separate_cameras else 1):
            file.write("%d PINHOLE %d %d %r %r %r %r\n" % (
                i + 1, width, height, focal, focal, width / 2, height / 2))
    with open(os.path.join(path, "images.txt"), "w") as file:
        for i, name in enumerate(names):
            center = i * BASELINE
            camera = i + 1 if separate_cameras else 1
            file.write("%d 1 0 0 0 %r 0 0 %d %s\n" % (
                i + 1, -center, camera, name))
            file.write(" ".join(
                "%r %r %d" % (focal * (x - center) / z + width / 2,
                              focal * y / z + height / 2, j + 1)
                for j, (x, y, z) in enumerate(points)) + "\n")
    with open(os.path.join(path, "points3D.txt"), "w") as file:
        for j, (x, y, z) in enumerate(points):
            track = " ".join("%d %d" % (i + 1, j) for i in range(len(names)))
            file.write("%d %r %r %r 128 128 128 0.1 %s\n" % (
                j + 1, x, y, z, track))


def make_images(path, names, width=WIDTH, height=HEIGHT):
    for i, name in enumerate(names):
        image_path = os.path.join(path, name)
        os.makedirs(os.path.dirname(image_path), exist_ok=True)
        write_png(image_path, width, height,
                  render(i * BASELINE, width, height))


def make_config(workspace, names, sources="__all__"):
    stereo = os.path.join(workspace, "stereo")
    for kind in ("depth_maps", "normal_maps", "consistency_graphs"):
        os.makedirs(os.path.join(stereo, kind), exist_ok=True)
    with open(os.path.join(stereo, "patch-match.cfg"), "w") as file:
        for name in names:
            file.write("%s\n%s\n" % (name, sources))
    with open(os.path.join(stereo, "fusion.cfg"), "w") as file:
        file.write("".join(name + "\n" for name in names))


def make_workspace(path, num_views=4, names=None, sources="__all__",
                   **model_options):
    """Makes a COLMAP workspace. Returns the names of its images."""
    names = names or ["view%d.png" % i for i in range(num_views)]
    make_images(os.path.join(path, "images"), names)
    make_model(os.path.join(path, "sparse"), names, **model_options)
    make_config(path, names, sources)
    return names


def map_path(workspace, name, kind="depth_maps", which="geometric",
             stereo="stereo"):
    return os.path.join(workspace, stereo, kind, "%s.%s.bin" % (name, which))


def read_map(path):
    """Returns width, height and the values of a map."""
    with open(path, "rb") as file:
        data = file.read()
    fields = data.split(b"&", 3)
    width, height, channels = (int(field) for field in fields[:3])
    values = struct.unpack("<%df" % (width * height * channels), fields[3])
    return width, height, values


def read_graph(path):
    """Returns (column, row) of the pixels that a consistency graph lists."""
    with open(path, "rb") as file:
        data = file.read().split(b"&", 3)[3]
    values = struct.unpack("<%di" % (len(data) // 4), data)
    pixels = []
    at = 0
    while at < len(values):
        pixels.append(values[at:at + 2])
        at += 3 + values[at + 2]
    return pixels


def write_map(path, width, height, values):
    with open(path, "wb") as file:
        file.write(b"%d&%d&%d&" % (width, height, len(values) // (width * height)))
        file.write(struct.pack("<%df" % len(values), *values))


def write_true_maps(workspace, name, index, width, height):
    """Depth and normal maps of view number `index`, without an error."""
    depths = [depth_at((col + 0.5 - width / 2) / (FOCAL * width / WIDTH),
                       index * BASELINE)
              for _ in range(height) for col in range(width)]
    length = math.hypot(0.25, 1)
    normals = [value for component in (0.25 / length, 0.0, -1 / length)
               for value in [component] * (width * height)]
    write_map(map_path(workspace, name), width, height, depths)
    write_map(map_path(workspace, name, "normal_maps"), width, height, normals)


def read_cloud(path):
    """Names of the properties that fusion wrote, and a tuple of values per point."""
    with open(path, "rb") as file:
        header, data = file.read().split(b"end_header\n", 1)
    properties = re.findall(r"property (\w+) (\w+)", header.decode())
    count = int(re.search(rb"element vertex (\d+)", header)[1])
    layout = "<" + "".join({"double": "d", "float": "f", "uchar": "B"}[kind]
                           for kind, _ in properties)
    assert len(data) == count * struct.calcsize(layout), path
    return [name for _, name in properties], list(struct.iter_unpack(layout, data))


def depth_errors(workspace, name, index, **where):
    """|depth / true depth - 1| of the pixels of view number `index` that have a
    depth, and the number of all pixels."""
    width, _, depths = read_map(map_path(workspace, name, **where))
    errors = []
    for i, depth in enumerate(depths):
        if depth > 0:
            x = (i % width + 0.5 - width / 2) / (FOCAL * width / WIDTH)
            errors.append(abs(depth / depth_at(x, index * BASELINE) - 1))
    return errors, len(depths)


def snapshot(workspace, stereo="stereo"):
    """Content of all files with maps, by relative path."""
    files = {}
    root = os.path.join(workspace, stereo)
    for folder, _, names in os.walk(root):
        for name in names:
            path = os.path.join(folder, name)
            with open(path, "rb") as file:
                files[os.path.relpath(path, root)] = file.read()
    return files


def stereo_command(workspace, arguments=(), **options):
    """options: PatchMatchStereo options beside those of FAST; None: the default."""
    command = [COLMAP, "patch_match_stereo", "--workspace_path", workspace]
    for name, value in {**FAST, **options}.items():
        if value is not None:
            command += ["--PatchMatchStereo." + name, str(value)]
    return command + list(arguments)


def run(command, timeout=300, **options):
    """Runs a command. Returns its result with all output as text."""
    return subprocess.run(command, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True,
                          stdin=subprocess.DEVNULL, timeout=timeout, **options)


def run_stereo(workspace, arguments=(), **options):
    return run(stereo_command(workspace, arguments, **options))


def stop_stereo_at(workspace, text, **options):
    """Runs stereo until a line that it prints has the text, then kills it. Returns whether one
    had."""
    process = subprocess.Popen(stereo_command(workspace, **options), stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True)
    found = any(text in line for line in process.stdout)
    process.kill()
    process.communicate()
    return found


def write_sources(workspace, names, *views):
    """Lists views, each with its sources, by their numbers."""
    with open(os.path.join(workspace, "stereo", "patch-match.cfg"), "w") as file:
        for view, sources in views:
            file.write("%s\n%s\n" % (names[view], ", ".join(names[i] for i in sources)))


class TestCase(unittest.TestCase):
    """A test with a folder of its own, self.folder."""

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="tapa-")
        self.addCleanup(shutil.rmtree, self.folder, True)

    def path(self, *parts):
        return os.path.join(self.folder, *parts)

    def assert_same_files(self, expected, actual):
        """Of two snapshots; names those that differ."""
        self.assertEqual(sorted(expected), sorted(actual))
        self.assertEqual([], [name for name in expected
                              if expected[name] != actual[name]])

    def assert_success(self, result):
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertNotIn("ERROR", result.stdout)

    def assert_one_error(self, result, *texts):
        """One line says what is wrong; the program ends in order."""
        self.assertEqual(result.returncode, 1, result.stdout)
        errors = [line for line in result.stdout.splitlines()
                  if "ERROR" in line or "Check failed" in line]
        self.assertEqual(len(errors), 1, result.stdout)
        self.assertTrue(errors[0].startswith("ERROR: "), errors[0])
        for text in texts:
            self.assertIn(text, errors[0])
        self.assertNotIn("***", result.stdout, "a stack trace")
