"""Files from strangers: names lead nowhere else, and no file takes what its size does not explain.

Most of what stands here was found by fuzzing (scripts/fuzz.sh).
"""

import os
import sqlite3
import struct
import unittest
from contextlib import closing

import page_workspace
from helpers import TestCase
from result_page_test import NAMES, PageCase
from evaluation import binary_model, colmap_model, files, model_names, plan, point_clouds
from evaluation.page.logs import Logs
from evaluation.processes import Failure

BAD_NAMES = ("..", "../a.jpg", "x/../../a.jpg", "/a.jpg", "a\x1b[2J.jpg", "a\0b.jpg", "a" * 300,
             "folder/" * 1000 + "a.jpg", "")
GOOD_NAMES = ("a.jpg", "x/b c.jpg", "..a", "a../b..c.jpg", "\xe9\udcff.jpg", "a" * 255)


def binary_images(name, num_observations=0, pose=(1, 0, 0, 0, 0, 0, 0)):
    """images.bin of one photograph."""
    return (struct.pack("<Qi7di", 1, 1, *pose, 1) + os.fsencode(name) + b"\0"
            + struct.pack("<Q", num_observations))


class NamesTest(TestCase):
    def test_names(self):
        for name in GOOD_NAMES:
            colmap_model.check_name(name, "images.txt")
        for name in BAD_NAMES:
            with self.assertRaisesRegex(Failure, "^[ -~]*$") as caught:
                colmap_model.check_name(name, "images.txt")
            self.assertLess(len(str(caught.exception)), 300)

    def test_models(self):
        self.write("text/cameras.txt", "1 PINHOLE 8 6 5 5 4 3\n")
        files.write_bytes(self.path("binary/cameras.bin"),
                          struct.pack("<QiiQQ4d", 1, 1, 1, 8, 6, 5, 5, 4, 3))
        for name in BAD_NAMES[:5]:
            self.write("text/images.txt", f"1 1 0 0 0 0 0 0 1 {name}\n\n")
            files.write_bytes(self.path("binary/images.bin"), binary_images(name))
            for folder in ("text", "binary"):
                for read in (binary_model.read_any, model_names.read_names):
                    with self.assertRaisesRegex(Failure, f"{folder}/images.* calls a photograph"):
                        read(self.path(folder))


class FilesTest(TestCase):
    def expect(self, name, content, read):
        """read(path) says in one line what is wrong with a file."""
        path = self.path(name)
        files.write_bytes(path, content)
        with self.assertRaises(Failure) as caught:
            read(path)
        self.assertIn(path, str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))

    def test_binary_models(self):
        for content in (binary_images("a.jpg", 2**60), binary_images("a.jpg", 2**64 - 1),
                        struct.pack("<Q", 2**64 - 1),
                        binary_images("a.jpg", pose=(float("nan"), 0, 0, 0, 0, 0, 0)),
                        binary_images("a.jpg", pose=(float("inf"), 0, 0, 0, 0, 0, 0)),
                        binary_images("a.jpg", pose=(1, 0, 0, 0, 0, 0, float("nan")))):
            self.expect("images.bin", content, binary_model.read_images)

    def test_cameras(self):
        for camera in ("0 6 5 5 4 3", f"{10**9} 6 5 5 4 3", f"{10**400} 6 5 5 4 3",
                       "8 6 nan 5 4 3", "8 6 5 inf 4 3"):
            self.expect("cameras.txt", f"1 PINHOLE {camera}\n".encode(), colmap_model.read_cameras)

    def test_points(self):
        head = "ply\nformat {} 1.0\nelement vertex {}\n{}end_header\n"
        xyz = "".join(f"property float {name}\n" for name in "xyz")
        for content in (
                # A list of infinite length.
                head.format("ascii", 1, xyz + "property list uint uint l\n") + "1 2 3 inf\n",
                head.format("ascii", 10**18, xyz) + "1 2 3\n",
                head.format("binary_little_endian", 10**18, xyz),
                # Rows of which a few would be more than all memory.
                head.format("binary_little_endian", 10**9, xyz + "".join(
                    f"property double p{i}\n" for i in range(20000))),
                head.format("ascii", "9" * 5000, xyz)):
            self.expect("a.ply", content.encode(), point_clouds.read_cloud)

    def test_nesting(self):
        self.expect("a.json", b"[" * 100_000, files.read_json)
        self.expect("a.toml", b"a = " + b"[" * 100_000, lambda path: plan.Plan(path, "", ""))

    def test_logs_with_odd_numbers(self):
        for number in ("1.2.3", ".", "9" * 400):
            self.write("x.log", f"Elapsed time: {number} [minutes]\n"
                       f" 5.0 % 1:00 to go  photometric 1/2 a.jpg: 0.1 megapixels in {number} s\n")
            logs = Logs([self.folder])
            self.assertEqual((logs.steps, logs.view_seconds), ([], {}))


class PageOfStrangersTest(PageCase):
    def test_names_are_text(self):
        name = "<img src=x onerror=alert(1)>&'\"<"  + "script>.jpg"
        self.make([name, *NAMES])
        self.write("out/dense/0/x.log", f"$ <b>{name}\nElapsed time: 1.0 [minutes]\n")
        self.write("out/dense/0/stereo/options.geometric.txt", f"{name} = {name}\n")
        text, scene = self.make_page()
        self.assertIn(name, [camera["name"] for camera in scene["cameras"]])
        for part in ("<img src=x", "<b>", "\"<script", "alert(1)>"):
            self.assertNotIn(part, text)

    def write_database(self, *statements):
        with closing(sqlite3.connect(self.path("out/database.db"))) as database:
            for statement in [*statements, "CREATE TABLE keypoints(image_id, rows)",
                              "CREATE TABLE two_view_geometries(pair_id, rows)",
                              "INSERT INTO two_view_geometries VALUES ('x', 1), (NULL, 'y')"]:
                database.execute(statement)
            database.commit()

    def test_a_database_that_is_a_program(self):
        self.make(NAMES)
        self.write_database(
            "CREATE VIEW images AS WITH RECURSIVE n(image_id) AS (SELECT 1 UNION ALL "
            "SELECT image_id + 1 FROM n) SELECT image_id, '' AS name FROM n")
        self.expect_error([self.workspace, "--out", self.page], "database.db")
        self.assertFalse(os.path.exists(self.page))

    def test_values_of_any_type_in_a_database(self):
        self.make(NAMES)
        self.write_database("CREATE TABLE images(image_id, name)", "INSERT INTO images VALUES "
                            "(NULL, 'a'), ('x', 'b'), (1, NULL), (3, 'other.jpg')")
        text, _ = self.make_page()
        self.assertIn("other.jpg", text)


if __name__ == "__main__":
    unittest.main()
