"""Files from strangers write nowhere else, and take no more memory than their size explains."""

import os
import resource
import struct
import unittest
import zlib

import tiny_workspace as tiny

# Of names of images in a model, that lead to other places or are none.
NAMES = ["../../stranger.png", "/tmp/stranger.png", "\x1b[2Jstranger.png", "a" * 300]
MEMORY = 2 << 30  # Bytes that a run may address here.


def write_bomb(path, width, height):
    """A PNG of next to no bytes whose header promises so many pixels."""
    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))

    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n"
                   + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
                   + chunk(b"IDAT", zlib.compress(bytes(100000))) + chunk(b"IEND", b""))


def limit_memory():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


class ImageNames(tiny.TestCase):
    """Of a model, in text and in binary."""

    def setUp(self):
        super().setUp()
        self.workspace = self.path("a", "b", "workspace")
        os.makedirs(self.workspace)
        self.names = tiny.make_workspace(self.workspace)
        self.text = self.read("images.txt").replace(self.names[1], "%s")

    def read(self, name):
        with open(os.path.join(self.workspace, "sparse", name)) as file:
            return file.read()

    def write(self, name, text):
        with open(os.path.join(self.workspace, "sparse", name), "w") as file:
            file.write(text)

    def expect_refusal(self, command, *words):
        before = tiny.snapshot(self.folder, ".")
        result = tiny.run([tiny.COLMAP, command, *words])
        self.assert_one_error(result, "sparse/images.", "an image called '")
        self.assertNotIn("\x1b", result.stdout)
        self.assertEqual(before, tiny.snapshot(self.folder, "."))

    def test_names(self):
        for name in NAMES:
            with self.subTest(name=name[:30]):
                self.write("images.txt", self.text % name)
                self.expect_refusal("patch_match_stereo", "--workspace_path", self.workspace)
                self.expect_refusal("stereo_fusion", "--workspace_path", self.workspace,
                                    "--output_path", self.path("fused.ply"))
                self.expect_refusal("image_undistorter", "--image_path", self.workspace,
                                    "--input_path", os.path.join(self.workspace, "sparse"),
                                    "--output_path", self.path("undistorted"))

    def test_line_break_in_a_binary_model(self):
        sparse = os.path.join(self.workspace, "sparse")
        self.assertEqual(0, tiny.run([
            tiny.COLMAP, "model_converter", "--input_path", sparse, "--output_path", sparse,
            "--output_type", "BIN"]).returncode)
        path = os.path.join(sparse, "images.bin")
        with open(path, "rb") as file:
            data = file.read()
        with open(path, "wb") as file:
            file.write(data.replace(b"view1.png\0", b"view1\n../x\0"))
        self.expect_refusal("patch_match_stereo", "--workspace_path", self.workspace)


class Links(tiny.TestCase):
    def test_maps_that_are_links_are_replaced_and_not_written_through(self):
        names = tiny.make_workspace(self.folder)
        target = self.path("stranger.txt")
        with open(target, "w") as file:
            file.write("mine")
        for folder in ("depth_maps", "normal_maps"):
            os.makedirs(self.path("stereo", folder), exist_ok=True)
            for name in names:
                os.symlink(target, self.path("stereo", folder, name + ".photometric.bin"))
        result = tiny.run_stereo(self.folder, geom_consistency=0)
        with open(target) as file:
            self.assertEqual(file.read(), "mine")
        # Either it refuses what is no map, or replaces it.
        for name in names:
            path = self.path("stereo", "depth_maps", name + ".photometric.bin")
            self.assertEqual(result.returncode != 0, os.path.islink(path))


class Memory(tiny.TestCase):
    """Pictures of any number of pixels take few bytes."""

    def setUp(self):
        super().setUp()
        self.names = tiny.make_workspace(self.folder)

    def expect_refusal(self, *texts, **options):
        before = tiny.snapshot(self.folder, ".")
        result = tiny.run(tiny.stereo_command(self.folder, **options), preexec_fn=limit_memory)
        self.assert_one_error(result, *texts)
        self.assertNotIn("not enough memory", result.stdout)
        self.assertEqual(before, tiny.snapshot(self.folder, "."))

    def test_photograph(self):
        write_bomb(self.path("images", "view1.png"), 60000, 40000)
        self.expect_refusal("view1.png", "60000x40000", "96x64")

    def test_mask(self):
        os.makedirs(self.path("masks"))
        write_bomb(self.path("masks", "view1.png.png"), 60000, 40000)
        self.expect_refusal("view1.png.png", "60000x40000", "96x64",
                            mask_path=self.path("masks"))

    def test_prior(self):
        os.makedirs(self.path("priors"))
        write_bomb(self.path("priors", "view1.png.png"), 60000, 40000)
        self.expect_refusal("view1.png.png", "60000x40000", "96x64",
                            prior_path=self.path("priors"))

    def test_camera(self):
        tiny.make_model(self.path("sparse"), self.names, width=2**40, height=2**40)
        self.expect_refusal("cameras.txt", "1099511627776x1099511627776")


if __name__ == "__main__":
    unittest.main()
