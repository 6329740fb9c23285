"""Names of photographs in sparse models, and those that make_workspace.sh takes."""

import os
import struct
import subprocess

from helpers import ROOT, TestCase
from evaluation import colmap_model, model_names, workspaces
from evaluation.processes import Failure

NAMES = ["a b.jpg", "#1, left.png", " c.jpg", "sub/d.jpg"]


class ModelNamesTest(TestCase):
    def write(self, name, content):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "wb") as file:
            file.write(content)

    def write_text(self, begin="", end="\n"):
        lines = ["# comment"]
        for number, name in enumerate(NAMES):
            lines += [f"{number} 1 0 0 0 0 0 0 1 {name}", "1 2 -1"]
        self.write("sparse/images.txt", (begin + end.join(lines) + end).encode())

    def write_binary(self):
        images = b"".join(
            struct.pack("<I7dI", number, 1, 0, 0, 0, 0, 0, 0, 1) + name.encode() + b"\0"
            + struct.pack("<Q", number) + number * struct.pack("<2dq", 1, 2, -1)
            for number, name in enumerate(NAMES))
        self.write("sparse/images.bin", struct.pack("<Q", len(NAMES)) + images)

    def test_text_and_binary(self):
        self.assertIsNone(model_names.read_names(self.path("sparse")))
        self.write_text()
        self.assertEqual(model_names.read_names(self.path("sparse")), NAMES)
        self.write_text("\ufeff", "\r\n")
        self.assertEqual(model_names.read_names(self.path("sparse")), NAMES)
        os.remove(self.path("sparse/images.txt"))
        self.write_binary()
        self.assertEqual(model_names.read_names(self.path("sparse")), NAMES)
        os.truncate(self.path("sparse/images.bin"), 100)
        with self.assertRaisesRegex(Failure, "images.bin"):
            model_names.read_names(self.path("sparse"))

    def test_views_have_the_same_names(self):
        self.write_text()
        self.write("sparse/cameras.txt", b"1 PINHOLE 640 480 500 500 320 240\n")
        for end in ("\n", "\r\n"):
            self.write_text(end=end)
            views = colmap_model.read_views(self.path("sparse"))
            self.assertEqual(sorted(view.name for view in views), sorted(NAMES))
        # A carriage return alone ends no line, and is no part of a name.
        self.write("sparse/images.txt", b"1 1 0 0 0 0 0 0 1 a\rb.jpg\n\n")
        for read in (colmap_model.read_views, model_names.read_names):
            with self.assertRaisesRegex(Failure, "no name of a file"):
                read(self.path("sparse"))

    def test_stray_files_are_no_photographs(self):
        self.write_binary()
        for name in [*NAMES, ".DS_Store", "._a b.jpg", "Thumbs.db", "without_pose.jpg"]:
            self.write("images/" + name, b"x")
        self.assertEqual(sorted(workspaces.photographs(self.folder)), sorted(NAMES))
        subprocess.run([os.path.join(ROOT, "scripts/make_workspace.sh"), self.folder,
                        self.path("w")], check=True, stdout=subprocess.DEVNULL)
        with open(self.path("w/stereo/fusion.cfg"), encoding="utf-8") as file:
            self.assertEqual(sorted(file.read().splitlines()), sorted(NAMES))
