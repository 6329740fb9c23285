#!/usr/bin/python3
"""Are the rooms that examples/generate.py renders what they say they are?

Depth that is exact and belongs to the cameras, a sparse model that agrees with both,
photographs that are neither dark nor burnt. TAPA_SCENE_SHRINK says how many times fewer
pixels per side (4); at 1 all scenes are generated in full, which takes minutes.
"""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import cv2
import numpy as np

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "../.."))
EXAMPLES = os.path.join(ROOT, "examples")
sys.path[:0] = [EXAMPLES, ROOT]
from evaluation import colmap_model  # noqa: E402
from rendering import povray, scene  # noqa: E402

GENERATE = os.path.join(EXAMPLES, "generate.py")
SHRINK = int(os.environ.get("TAPA_SCENE_SHRINK", "4"))
NEW = [name for name in scene.names() if name != "room"]  # It has tests of its own.
WHOLE = NEW if SHRINK == 1 else ["office"]


def generate(*words, path=None):
    return subprocess.run([sys.executable, GENERATE, *words], stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, timeout=3000, check=False,
                          env=dict(os.environ, PATH=path or os.environ["PATH"]))


def points_of(depth, pose, camera):
    """What the centres of pixels see, in the world: rows x columns x 3."""
    rows, cols = np.mgrid[0:camera.height, 0:camera.width]
    rays = np.stack(((cols + 0.5 - camera.width / 2) / camera.focal,
                     (rows + 0.5 - camera.height / 2) / camera.focal, np.ones(depth.shape)), -1)
    rotation, translation = pose
    return (rays * depth[..., None] - translation) @ rotation


def project(points, pose, camera):
    """Columns and rows as of pixel centres, and depths."""
    rotation, translation = pose
    x, y, z = np.moveaxis(points @ rotation.T + translation, -1, 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        return (camera.focal * x / z + camera.width / 2 - 0.5,
                camera.focal * y / z + camera.height / 2 - 0.5, z)


def warped(source, target, pose, camera):
    """Errors in metres where source, points in the world, meets the depth target; the
    images of both there; whether each point was met."""
    col, row, z = project(source, pose, camera)
    with np.errstate(invalid="ignore"):
        inside = (z > 0) & (col >= 0) & (row >= 0) & (col < camera.width - 1) & (
            row < camera.height - 1)
    left, top = col[inside].astype(int), row[inside].astype(int)
    a, b = col[inside] - left, row[inside] - top
    corners = np.stack([target[top + i, left + j] for i in (0, 1) for j in (0, 1)])
    weights = np.stack([(1 - b) * (1 - a), (1 - b) * a, b * (1 - a), b * a])
    low, high = corners.min(axis=0), corners.max(axis=0)
    # Nothing stands in front, and no edge lies between the four pixels. Inverse depth is
    # linear on a plane.
    clear = (high >= z[inside] - 0.02) & (high - low <= 0.03 * low)
    error = np.abs(1 / (weights / corners).sum(axis=0) - z[inside])
    return error[clear], inside, clear


class DepthTest(unittest.TestCase):
    """Of all views of all scenes, without photographs."""

    def test_depth_of_all_views(self):
        for name in NEW:
            with self.subTest(name), tempfile.TemporaryDirectory(prefix="tapa-") as work:
                self.check(name, scene.load(name), work)

    def check(self, name, one, work):
        camera = one.camera.shrunk(max(SHRINK, 2))
        for file, _ in one.pictures:  # Depth needs none of what is in them.
            cv2.imwrite(os.path.join(work, file), np.zeros((2, 2, 3), np.uint8))
        renderer = povray.Renderer(one, camera, work)
        depths = [renderer.depth(view) for view in range(len(one.poses))]
        poses = [pose.world_to_camera() for pose in one.poses]
        self.check_walk(poses)
        for depth in depths:
            self.assertGreater(depth.min(), 0.3)
            self.assertLess(depth.max(), min(0.99 * one.depth_range, 65535 / 4000))
        self.check_views_agree(name, camera, poses, depths)
        self.check_floor(name, camera, poses, depths)

    def check_walk(self, poses):
        self.assertGreaterEqual(len(poses), 8)
        centres = [-rotation.T @ translation for rotation, translation in poses]
        for rotation, _ in poses:
            np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-9)
            self.assertAlmostEqual(np.linalg.det(rotation), 1, 9)
        for one, other in zip(centres, centres[1:]):
            self.assertGreater(np.linalg.norm(one - other), 0.08)
            self.assertLess(np.linalg.norm(one - other), 1.3)

    def check_views_agree(self, name, camera, poses, depths):
        errors, seen = [], []
        for view, depth in enumerate(depths):
            points = points_of(depth, poses[view], camera)
            count = np.zeros(depth.shape, int)
            for other, target in enumerate(depths):
                if other != view:
                    error, inside, clear = warped(points, target, poses[other], camera)
                    met = np.zeros(clear.shape, bool)
                    met[clear] = error < 0.02
                    count[inside] += met
                    errors.append(error)
            seen.append((count >= 2).mean())
        errors = np.concatenate(errors)
        print(f"{name}: depth in other views: median difference {1e3 * np.median(errors):.3f} mm, "
              f"{100 * (errors < 0.005).mean():.1f} % within 5 mm; two others or more see "
              f"{100 * np.mean(seen):.1f} %")
        self.assertLess(np.median(errors), 0.001)
        self.assertGreater((errors < 0.005).mean(), 0.85)
        self.assertGreater(np.mean(seen), 0.7)

    def check_floor(self, name, camera, poses, depths):
        """The floor is at y = 0, so that rays half a pixel off would show."""
        heights = np.concatenate([points_of(depth, pose, camera)[..., 1].ravel()
                                  for depth, pose in zip(depths, poses)])
        on_floor = np.abs(heights[np.abs(heights) < 0.003])
        self.assertGreater(len(on_floor), 0.02 * len(heights), name)
        self.assertLess(np.median(on_floor), 0.0002, name)


class DataTest(unittest.TestCase):
    """What the program writes."""

    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory(prefix="tapa-")
        cls.out = cls._folder.name
        result = generate(*WHOLE, "--out", cls.out, "--shrink", str(SHRINK))
        if result.returncode:
            raise AssertionError(result.stderr)

    @classmethod
    def tearDownClass(cls):
        cls._folder.cleanup()

    def test_data(self):
        for name in WHOLE:
            with self.subTest(name):
                self.check(name, scene.load(name))

    def check(self, name, one):
        folder, camera = os.path.join(self.out, name), one.camera.shrunk(SHRINK)
        names = [one.view_name(view) for view in range(len(one.poses))]
        self.assertEqual(sorted(os.listdir(folder)),
                         ["gt_depth", "images", "made_from.txt", "sparse"])
        for part, end in (("images", ".jpg"), ("gt_depth", ".png")):
            self.assertEqual(sorted(os.listdir(os.path.join(folder, part))),
                             [view + end for view in names])
        greys, depths = [], []
        for view in names:
            image = cv2.imread(os.path.join(folder, "images", view + ".jpg"))
            depth = cv2.imread(os.path.join(folder, "gt_depth", view + ".png"),
                               cv2.IMREAD_UNCHANGED)
            self.assertEqual(image.shape, (camera.height, camera.width, 3))
            self.assertEqual((depth.shape, depth.dtype), (image.shape[:2], np.uint16))
            self.assertGreater(depth.min(), 0)
            grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY).astype(float)
            self.assertTrue(60 < grey.mean() < 200, f"{view}: mean {grey.mean()}")
            self.assertLess((grey > 250).mean(), 0.08, view)
            self.assertLess((grey < 5).mean(), 0.08, view)
            greys.append(grey)
            depths.append(depth / 4000)
        self.check_photographs_agree(name, one, camera, greys, depths)
        self.check_model(name, one, camera, os.path.join(folder, "sparse"), names, depths)

    def check_photographs_agree(self, name, one, camera, greys, depths):
        poses = [pose.world_to_camera() for pose in one.poses]
        pairs = []
        for view, other in zip(range(len(poses)), range(1, len(poses))):
            points = points_of(depths[view], poses[view], camera)
            col, row, _ = project(points, poses[other], camera)
            error, inside, clear = warped(points, depths[other], poses[other], camera)
            keep = np.flatnonzero(inside)[clear][error < 0.02]
            there = cv2.remap(greys[other].astype(np.float32),
                              col.ravel()[keep].astype(np.float32)[:, None],
                              row.ravel()[keep].astype(np.float32)[:, None], cv2.INTER_LINEAR)
            pairs.append(np.stack((greys[view].ravel()[keep], there.ravel())))
        here, there = np.hstack(pairs)
        correlation = np.corrcoef(here, there)[0, 1]
        print(f"{name}: photographs warped: median difference "
              f"{np.median(np.abs(here - there)):.2f} grey levels, correlation {correlation:.4f}")
        self.assertGreater(correlation, 0.9)

    def check_model(self, name, one, camera, folder, names, depths):
        with open(os.path.join(folder, "cameras.txt"), encoding="utf-8") as file:
            line = [line for line in file if line[0] != "#"][0].split()
        self.assertEqual(line[1], "PINHOLE")
        np.testing.assert_allclose(
            [float(word) for word in line[2:]],
            [camera.width, camera.height, camera.focal, camera.focal, camera.width / 2,
             camera.height / 2])
        with open(os.path.join(folder, "points3D.txt"), encoding="utf-8") as file:
            rows = [line.split() for line in file if line[0] != "#"]
        errors = []
        for row in rows:
            point = np.array([float(word) for word in row[1:4]])
            for view in {int(word) - 1 for word in row[8::2]}:
                col, line, z = project(point, one.poses[view].world_to_camera(), camera)
                col, line = int(np.clip(round(float(col)), 0, camera.width - 1)), int(
                    np.clip(round(float(line)), 0, camera.height - 1))
                errors.append(abs(float(z) / depths[view][line, col] - 1))
        print(f"{name}: {len(rows)} sparse points, in {len(errors)} views; against the depth "
              f"median {100 * np.median(errors):.3f} %, "
              f"90th percentile {100 * np.quantile(errors, 0.9):.2f} %")
        self.assertGreater(len(rows), 600 if SHRINK == 1 else 60)
        self.assertLess(np.median(errors), 0.01 * SHRINK)
        self.assertEqual(len(colmap_model.read_views(folder)), len(names))

    def test_what_is_there_is_kept(self):
        path = os.path.join(self.out, WHOLE[0], "made_from.txt")
        before = os.stat(path).st_mtime_ns
        again = generate(WHOLE[0], "--out", self.out, "--shrink", str(SHRINK))
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertIn("is there already", again.stderr)
        other = generate(WHOLE[0], "--out", self.out, "--shrink", "10")
        self.assertEqual(other.returncode, 1)
        self.assertRegex(other.stderr, "^ERROR: .* was not made from these files at this size.*\n$")
        self.assertEqual(os.stat(path).st_mtime_ns, before)


class ProgramTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="tapa-")
        self.addCleanup(folder.cleanup)
        self.out = folder.name

    def test_bad_input_is_one_line(self):
        for words, text in ((["castle"], "invalid choice: 'castle'"), ([], "are required"),
                            (["office", "--shrink", "7"], "cannot be divided by 7"),
                            (["office", "--jobs", "0"], "not a whole number")):
            result = generate(*words, "--out", self.out)
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertRegex(result.stderr, "^ERROR: .*\n$")
            self.assertIn(text, result.stderr)
        self.assertEqual(os.listdir(self.out), [])

    def test_without_the_renderer(self):
        result = generate("office", "--out", self.out, path=self.out)
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stderr,
                         "ERROR: POV-Ray is not installed (Debian: apt-get install povray)\n")
        self.assertEqual(os.listdir(self.out), [])

    def test_nothing_is_left_by_a_run_that_is_stopped(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            process = subprocess.Popen([sys.executable, GENERATE, "office", "--out", self.out],
                                       stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            while not os.listdir(self.out) and process.poll() is None:
                time.sleep(0.05)
            time.sleep(0.3)
            process.send_signal(number)
            self.assertEqual(process.wait(timeout=120), 128 + number)
            self.assertEqual(os.listdir(self.out), [])


if __name__ == "__main__":
    if shutil.which("povray") is None:
        print("SKIPPED: POV-Ray is not installed (Debian: apt-get install povray)")
        sys.exit(77)
    unittest.main()
