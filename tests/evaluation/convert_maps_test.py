"""scripts/convert_maps: maps become files of other programs, such files become maps."""

import json
import os
import shutil
import struct
import subprocess

import cv2
import numpy as np

import page_workspace
from helpers import ROOT, ProgramTest, TestCase, write_map
from evaluation import binary_model, colmap_model, depth_maps, files, point_clouds, processes
from evaluation.exchange import convert_maps, formats, slopes
from evaluation.page import confidence
from evaluation.processes import Failure

NAMES = ["a.jpg", "rig/b.jpg"]
WIDTH, HEIGHT = page_workspace.SIZE
FORMATS = [extension[1:] for extension in formats.EXTENSIONS]
# Of the camera of page_workspace.
CAMERA = colmap_model.Camera("PINHOLE", WIDTH, HEIGHT, (40, 40, WIDTH / 2, HEIGHT / 2))


def slanted_plane(camera, normal=(0.6, 0, -0.8)):
    """Depth of a plane with a normal, 4 units away, and its normals."""
    u, v = colmap_model.pixel_rays(camera)
    depth = -4 / (normal[0] * u + normal[1] * v + normal[2])
    return depth.astype(np.float32), np.broadcast_to(np.float32(normal), (*depth.shape, 3))


class ConvertMapsCase(ProgramTest):
    """A workspace w with maps that have holes, and an equal one, v, without maps."""
    main = convert_maps.main

    def setUp(self):
        super().setUp()
        self.said = []
        processes.say = self.said.append
        page_workspace.make(self.path("w"), NAMES)
        page_workspace.make(self.path("v"), NAMES, num_mapped=0)
        self.depth, self.normals = map(np.array, slanted_plane(CAMERA))
        self.depth[:3], self.normals[:3] = 0, 0
        for name in NAMES:
            for path, values in zip(self.maps("w", name), (self.depth, self.normals)):
                files.write_bytes(path, depth_maps.encode_bin(values))

    def maps(self, workspace, name, kind="geometric"):
        """Paths of the depth and the normal map of a photograph."""
        return [self.path(workspace, "stereo", folder, f"{name}.{kind}.bin")
                for folder in ("depth_maps", "normal_maps")]

    def read_maps(self, workspace, name):
        depth, normals = self.maps(workspace, name)
        return depth_maps.read_map(depth), depth_maps.read_map(normals, 3)

    def export_words(self, out, *words):
        return ["export", "--workspace_path", self.path("w"), "--output_path", self.path(out),
                *words]

    def import_words(self, folder, *words, workspace="v"):
        return ["import", "--workspace_path", self.path(workspace), "--input_path",
                self.path(folder), *words]

    def export(self, out, *words):
        return self.run_well(*self.export_words(out, *words))

    def write_depth(self, name, values, folder="in"):
        """A file of any program."""
        formats.write_numbers(self.path(folder, name), values)

    def import_one(self, *words):
        """Depth and normals that files in the folder "in" give to a.jpg."""
        shutil.rmtree(self.path("v/stereo/depth_maps"), ignore_errors=True)
        shutil.rmtree(self.path("v/stereo/normal_maps"), ignore_errors=True)
        self.run_well(*self.import_words("in", *words))
        return self.read_maps("v", "a.jpg")


class ExportTest(ConvertMapsCase):
    def test_round_trip(self):
        for name in FORMATS:
            self.export(name, "--format", name)
            shutil.rmtree(self.path("v/stereo"))
            self.assertIn("maps of 2 of 2", self.run_well(*self.import_words(name)))
            steps = (0.5 / 5000, 1 / 65535) if name == "png" else (0, 0)
            for view in NAMES:
                for found, expected, half in zip(self.read_maps("v", view),
                                                 (self.depth, self.normals), steps):
                    self.assertLessEqual(np.abs(found - expected).max(), half + 1e-6 * (half > 0))
                    self.assertFalse(found[:3].any())
                if name != "png":
                    for pair in zip(self.maps("v", view), self.maps("w", view)):
                        self.assertEqual(*map(files.read_bytes, pair))
        self.assertEqual(self.said, [])

    def test_layout_and_record(self):
        self.export("png", "--format", "png")
        self.assertEqual(files.names_below(self.path("png")), [
            *(f"{kind}/{name}.png" for kind in ("confidence", "depth") for name in NAMES),
            "maps.json", *(f"normals/{name}.png" for name in NAMES)])
        record = json.loads(self.read("png/maps.json"))
        self.assertEqual([record[key] for key in ("format", "maps", "depth_scale")],
                         ["png", "geometric", 5000])
        self.assertEqual(record["views"]["rig/b.jpg"], {
            "width": WIDTH, "height": HEIGHT, "fx": 40, "fy": 40, "cx": 24, "cy": 16})
        depth = cv2.imread(self.path("png/depth/rig/b.jpg.png"), cv2.IMREAD_UNCHANGED)
        self.assertEqual(depth.dtype, np.uint16)
        np.testing.assert_array_equal(depth, np.rint(self.depth.astype(float) * 5000))
        # Red, green, blue are x, y, z.
        normals = cv2.imread(self.path("png/normals/a.jpg.png"), cv2.IMREAD_UNCHANGED)
        self.assertEqual(normals[-1, -1, ::-1].tolist(), [52428, 32768, 6553])
        self.assertEqual(normals[0, 0].tolist(), [0, 0, 0])

    def test_floats_as_others_read_them(self):
        for name in ("exr", "pfm"):
            self.export(name, "--format", name)
            read = [cv2.imread(self.path(name, kind, f"a.jpg.{name}"), cv2.IMREAD_UNCHANGED)
                    for kind in ("depth", "normals")]
            np.testing.assert_array_equal(read[0], self.depth)
            np.testing.assert_array_equal(read[1][:, :, ::-1], self.normals)
            self.assertNotIn("depth_scale", json.loads(self.read(name, "maps.json")))
        self.export("npy", "--format", "npy")
        np.testing.assert_array_equal(np.load(self.path("npy/normals/a.jpg.npy")), self.normals)

    def test_smaller_maps_have_their_own_intrinsics(self):
        for path, channels in zip(self.maps("w", "a.jpg"), ((), (3,))):
            write_map(path, np.ones((*channels, HEIGHT // 2, WIDTH // 2)))
        self.export("out", "--format", "npy")
        views = json.loads(self.read("out/maps.json"))["views"]
        self.assertEqual([views["a.jpg"][key] for key in ("width", "fx", "cx")], [24, 20, 12])
        self.assertEqual(views["rig/b.jpg"]["fx"], 40)

    def test_scale_of_png(self):
        self.assertIn("depth = value / 1000, in steps of 0.001",
                      self.export("out", "--format", "png", "--depth_scale", "1000"))
        self.expect_error(self.export_words("no", "--format", "png", "--depth_scale", "1e5"),
                          "does not fit into 16 bits at 100000 steps per unit; lower "
                          "--depth_scale to 5000")
        self.assertFalse(any(name.startswith("no") for name in os.listdir(self.folder)))
        # The largest depth has one of the last values.
        self.depth[5, 5] = 65534 / 2000
        files.write_bytes(self.maps("w", "a.jpg")[0], depth_maps.encode_bin(self.depth))
        self.assertIn("value / 2000", self.export("fits", "--format", "png"))
        self.depth[5, 6] = 1e-4
        files.write_bytes(self.maps("w", "a.jpg")[0], depth_maps.encode_bin(self.depth))
        self.export("near", "--format", "png")
        self.assertIn("1 depths of a.jpg are less than half a step", self.said[-1])

    def test_models_of_any_unit(self):
        for factor, scale in ((1e-30, 5e33), (1e30, 5e-27)):
            for name in NAMES:
                files.write_bytes(self.maps("w", name)[0],
                                  depth_maps.encode_bin(self.depth * np.float32(factor)))
            self.assertIn(f"value / {scale:g},", self.export(f"{factor}", "--format", "png"))
            self.run_well(*self.import_words(f"{factor}", "--overwrite"))
            np.testing.assert_allclose(self.read_maps("v", "a.jpg")[0], factor * self.depth, 1e-4)

    def test_confidence_of_points(self):
        depth = np.full((HEIGHT, WIDTH), page_workspace.DEPTH, np.float32)
        depth[:6] = 0
        files.write_bytes(self.maps("w", "rig/b.jpg")[0], depth_maps.encode_bin(depth))
        self.assertIn("how many views confirm", self.export("out", "--format", "npy"))
        cloud = point_clouds.read_cloud(self.path("w/fused.ply"))
        view = binary_model.read_any(self.path("w/sparse"))[1]
        expected = confidence.seen_by(view, depth, cloud.points, cloud.confidence, WIDTH)
        found = np.load(self.path("out/confidence/rig/b.jpg.npy"))
        self.assertGreater(np.mean(found > 0), 0.5)
        np.testing.assert_array_equal(found, np.where(depth > 0, expected, 0))

    def test_confidence_of_graphs(self):
        graph = f"{WIDTH}&{HEIGHT}&1&".encode() + struct.pack("<5i", 4, 2, 2, 7, 8)
        paths = [self.path("w/stereo/consistency_graphs", f"{name}.geometric.bin")
                 for name in NAMES]
        words = ("--format", "png", "--confidence", "graphs")
        files.write_bytes(paths[0], graph)
        self.expect_error(self.export_words("out", *words), "no consistency graph of every view")
        files.write_bytes(paths[1], graph)
        self.assertIn("source photographs agree", self.export("out", *words))
        values = cv2.imread(self.path("out/confidence/a.jpg.png"), cv2.IMREAD_UNCHANGED)
        self.assertEqual((values[2, 4], np.count_nonzero(values)), (200, 1))
        self.assertEqual(json.loads(self.read("out/maps.json"))["confidence_scale"], 100)
        files.write_bytes(paths[1], b"9" + graph)
        self.expect_error(self.export_words("no", *words), f"{paths[1]} has 948x32 pixels")
        # Without points graphs are taken, without both nothing.
        files.write_bytes(paths[1], graph)
        os.remove(self.path("w/fused.ply"))
        self.assertIn("source photographs", self.export("graphs", "--format", "npy"))
        os.remove(paths[0])
        self.assertIn("no confidence", self.export("none", "--format", "npy"))
        self.assertFalse(os.path.exists(self.path("none/confidence")))
        self.expect_error(self.export_words("no", "--format", "npy", "--confidence", "points"),
                          "no points with confidence (fused*.ply): run stereo_fusion")

    def test_photometric_maps(self):
        page_workspace.write_maps(self.path("w"), "a.jpg", "photometric")
        self.assertIn("1 views", self.export("out", "--format", "exr", "--input_type",
                                             "photometric"))
        self.assertEqual(json.loads(self.read("out/maps.json"))["maps"], "photometric")

    def test_what_is_lacking_is_said(self):
        os.remove(self.maps("w", "a.jpg")[1])
        page_workspace.write_maps(self.path("w"), "other.jpg")
        self.export("out", "--format", "npy")
        self.assertEqual([line[:40] for line in self.said], [
            "WARNING: 1 maps are of no photograph of ", "WARNING: 1 views have no normals, such a"])
        self.assertFalse(os.path.exists(self.path("out/depth/other.jpg.npy")))

    def test_refusals(self):
        words = ("--format", "exr")
        for path in self.maps("w", "rig/b.jpg"):
            content = files.read_bytes(path)
            files.write_bytes(path, content[:-4])
            self.expect_error(self.export_words("out", *words), f"{path} is truncated")
            files.write_bytes(path, content)
        write_map(self.maps("w", "a.jpg")[1], np.ones((3, 5, 5)))
        self.expect_error(self.export_words("out", *words), "is not of the size of")
        self.assertFalse(any(name.startswith("out") for name in os.listdir(self.folder)))
        self.write("full/file")
        self.expect_error(self.export_words("full", *words), "full is not empty; name another")
        self.expect_error(self.export_words("full/file", *words), "cannot be written")
        os.mkdir(self.path("out.new"))
        self.expect_error(self.export_words("out", *words), "out.new is there")
        self.assertTrue(os.path.isdir(self.path("out.new")))
        self.expect_error(self.export_words("x", "--format", "tiff"), "'tiff'")
        self.expect_error(self.export_words("x", *words, "--input_type", "photometric"),
                          "no photometric depth map")
        self.expect_error(["export", "--workspace_path", self.path("none"), "--output_path", "x",
                           *words], "is no dense workspace")
        self.expect_error([], "required: COMMAND")

    def test_as_a_program(self):
        words = self.export_words("out", "--format", "exr", "--confidence", "none")
        result = subprocess.run([os.path.join(ROOT, "scripts", "convert_maps"), *words],
                                check=True, capture_output=True, text=True)
        self.assertEqual((result.stdout, result.stderr), (
            f"{self.path('out')}: 2 views, as EXR; no confidence: there are no fused points and "
            "no consistency graphs, or they are not wanted\n", ""))


class ImportTest(ConvertMapsCase):
    def test_depth_alone(self):
        """In any format, with names of other programs; what is none in any way."""
        depth = np.array(self.depth)
        depth[0, :3] = np.nan, np.inf, -0.0
        as_pfm = b"Pf\n%d %d\n1.0\n" % (WIDTH, HEIGHT) + depth[::-1].astype(">f4").tobytes()
        _, as_exr = cv2.imencode(".exr", depth)
        for name, content in (
                ("depth/a.jpg.exr", as_exr.tobytes()), ("a.pfm", as_pfm),
                ("a.exr", as_exr.tobytes().replace(b"Y\0\2\0\0\0", b"Z\0\2\0\0\0", 1))):
            shutil.rmtree(self.path("in"), ignore_errors=True)
            files.write_bytes(self.path("in", name), content)
            found, normals = self.import_one()
            np.testing.assert_array_equal(found, self.depth)
            self.assertLess(np.abs(normals - self.normals).max(), 2e-3)
            self.assertFalse(normals[:3].any())
            self.assertEqual(self.said, ["WARNING: 1 photographs have no file, such as rig/b.jpg"])
            self.said.clear()
        os.remove(self.path("in/a.exr"))
        np.save(self.path("in/a.npy"), np.asfortranarray(1000 * depth.astype(float)))
        found, _ = self.import_one("--depth_scale", "1000")
        np.testing.assert_allclose(found, self.depth, 1e-6)

    def test_scale_of_png(self):
        self.write_depth("a.jpg.png", np.full((HEIGHT, WIDTH), 2500))
        self.expect_error(self.import_words("in"), "with --depth_scale, such as 1000")
        self.assertEqual(self.import_one("--depth_scale", "1000")[0][0, 0], 2.5)
        self.write("in/maps.json", '{"depth_scale": 500}')
        self.assertEqual(self.import_one()[0][0, 0], 5)
        self.assertEqual(self.import_one("--depth_scale", "1000")[0][0, 0], 2.5)
        for content, part in (('{"depth_scale": 0}', "depth_scale"), ("{", "maps.json cannot")):
            self.write("in/maps.json", content)
            self.expect_error(self.import_words("in"), part)

    def test_sizes(self):
        for width, height in ((WIDTH // 2, HEIGHT // 2), (WIDTH // 2, HEIGHT // 2 + 1)):
            self.write_depth("a.exr", slanted_plane(CAMERA.resized(width, height))[0])
            depth, normals = self.import_one()
            self.assertEqual((depth.shape, normals.shape),
                             ((height, width), (height, width, 3)))
        self.assertLess(np.abs(normals - self.normals[-1, -1]).max(), 2e-3)
        self.write_depth("a.exr", slanted_plane(CAMERA.resized(4 * WIDTH, 4 * HEIGHT))[0])
        self.expect_error(self.import_words("in", workspace="w"),
                          "a.exr has 192x128 pixels, more than its photograph of 48x32; --resize")
        depth, normals = self.import_one("--resize")
        np.testing.assert_allclose(depth, slanted_plane(CAMERA)[0], 0.02)
        self.assertLess(np.abs(normals - self.normals[-1, -1]).max(), 0.05)
        for shape in ((HEIGHT, WIDTH // 2), (WIDTH, HEIGHT), (3 * HEIGHT, 2 * WIDTH)):
            self.write_depth("a.exr", np.ones(shape, np.float32))
            self.expect_error(self.import_words("in", "--resize"), "not the shape of its photo")

    def test_normals(self):
        def write(values):
            formats.write_normals(self.path("in/normals/a.jpg.npy"), np.float32(values))
        self.write_depth("depth/a.jpg.exr", self.depth)
        # One that is missing is computed, and one that is a little off gets unit length.
        write(np.where(np.indices((HEIGHT, WIDTH))[1][:, :, None] == 9, 0, self.normals * 1.01))
        self.assertLess(np.abs(self.import_one()[1] - self.normals).max(), 2e-3)
        for values, part in (
                (-self.normals, "point away from the camera"),
                (self.normals / 2 + 0.5, "point away from the camera"),
                (100 * self.normals, "not of unit length"),
                (self.normals[:-1], "has 48x31 pixels, but the depth of the view 48x32")):
            write(values)
            self.expect_error(self.import_words("in"), part)
        for values in (self.normals[:, :, 0], np.int32(self.normals)):
            np.save(self.path("in/normals/a.jpg.npy"), values)
            self.expect_error(self.import_words("in"), "in/normals/a.jpg.npy ")

    def test_maps_that_are_there(self):
        self.export("out", "--format", "exr")
        for _ in range(2):  # The same ones are no reason to stop.
            self.run_well(*self.import_words("out"))
        depth, normals = self.maps("v", "a.jpg")
        graph = self.path("v/stereo/consistency_graphs/a.jpg.geometric.bin")
        files.write_bytes(graph, b"")
        write_map(depth, np.ones((HEIGHT, WIDTH)))
        before = files.read_bytes(depth)
        self.expect_error(self.import_words("out"), f"{depth} is there, and another map; remove")
        self.assertEqual(files.read_bytes(depth), before)
        self.assertTrue(os.path.exists(graph))
        self.run_well(*self.import_words("out", "--overwrite"))
        np.testing.assert_array_equal(self.read_maps("v", "a.jpg")[0], self.depth)
        self.assertFalse(os.path.exists(graph))
        # Links to maps of another workspace give way, the maps stay.
        os.remove(normals)
        os.symlink(self.maps("w", "a.jpg")[1], normals)
        self.write_depth("a.exr", np.ones((HEIGHT, WIDTH), np.float32))
        self.run_well(*self.import_words("in", "--overwrite"))
        np.testing.assert_array_equal(self.read_maps("w", "a.jpg")[1], self.normals)
        np.testing.assert_array_equal(self.read_maps("v", "a.jpg")[1][0, 0], [0, 0, -1])

    def test_records_of_stereo(self):
        options, views = (self.path("w/stereo", f"{name}.geometric.txt")
                          for name in ("options", "views"))
        self.write("w/stereo/options.geometric.txt", "seed = 7\n")
        self.write("w/stereo/options.photometric.txt", "seed = 7\n")
        self.write("w/stereo/views.geometric.txt",
                   "# Comment\n1 2 3 4 5 a.jpg\n1 2 3 4 5 rig/b.jpg\n")
        self.write_depth("a.exr", np.ones((HEIGHT, WIDTH), np.float32))
        self.expect_error(self.import_words("in", workspace="w"), f"as {options} says; name")
        self.write("bad/a.exr")
        self.expect_error(self.import_words("bad", "--overwrite", workspace="w"), "bad/a.exr is")
        self.assertTrue(os.path.exists(options))
        self.run_well(*self.import_words("in", "--overwrite", workspace="w"))
        self.assertFalse(os.path.exists(options))
        self.assertEqual(self.read("w/stereo/options.photometric.txt"), "seed = 7\n")
        self.assertEqual(files.read_bytes(views), b"# Comment\n1 2 3 4 5 rig/b.jpg\n")
        # A record that is about no map any more is no obstacle.
        self.write("v/stereo/options.geometric.txt", "seed = 7\n")
        self.run_well(*self.import_words("in"))
        self.assertFalse(os.path.exists(self.path("v/stereo/options.geometric.txt")))

    def test_which_files(self):
        self.expect_error(self.import_words("none"), "no folder of maps at")
        self.write("in/stranger.exr")
        self.expect_error(self.import_words("in"), "has no depth of a photograph")
        self.write_depth("a.jpg.exr", self.depth)
        self.run_well(*self.import_words("in"))
        self.assertIn("1 files in", self.said[0])
        self.write_depth("a.npy", self.depth)
        self.expect_error(self.import_words("in"), "are both of a.jpg; remove one")
        self.expect_error(self.import_words("in", workspace="none"), "is no dense workspace")
        self.write_depth("a.npy", 0 * self.depth)
        os.remove(self.path("in/a.jpg.exr"))
        self.import_one()
        self.assertIn("no depth at all, such as", self.said[-2])

    def test_names_that_lead_out(self):
        self.write_depth("a.exr", self.depth)
        for name in ("../a.jpg", "/a.jpg", "rig/../../a.jpg"):
            self.write("v/sparse/images.txt", f"1 1 0 0 0 0 0 0 1 {name}\n\n")
            self.expect_error(self.import_words("in"), f"a photograph '{name}', which leads out")
        self.assertFalse(os.path.exists(self.path("v/stereo/a.jpg.geometric.bin")))

    def test_cameras_with_distortion(self):
        self.write("v/sparse/cameras.txt", f"1 THIN_PRISM_FISHEYE {WIDTH} {HEIGHT}" + 12 * " 1")
        self.write_depth("a.exr", self.depth)
        self.expect_error(self.import_words("in"), "run image_undistorter first")

    def test_names_that_are_no_text(self):
        for folder in "wv":
            sparse = self.path(folder, "sparse")
            files.write_bytes(os.path.join(sparse, "cameras.bin"), struct.pack(
                "<QiiQQ4d", 1, 1, 1, WIDTH, HEIGHT, *CAMERA.params))
            files.write_bytes(os.path.join(sparse, "images.bin"), struct.pack(
                "<Qi7di", 1, 1, 1, 0, 0, 0, 0, 0, 0, 1) + b"\xff.jpg\0" + bytes(8))
        for old, new in zip(self.maps("w", "a.jpg"), self.maps("w", "\udcff.jpg")):
            os.rename(old, new)
        self.export("out", "--format", "png")
        self.run_well(*self.import_words("out"))
        self.assertEqual(np.count_nonzero(self.read_maps("v", "\udcff.jpg")[0]),
                         np.count_nonzero(self.depth))


class DamagedFilesTest(ConvertMapsCase):
    def refuse(self, name, content, part=""):
        """An import that has just this file, which is wrong."""
        shutil.rmtree(self.path("in"), ignore_errors=True)
        files.write_bytes(self.path("in", name), content)
        self.expect_error(self.import_words("in", "--depth_scale", "1"),
                          self.path("in", name) + part)
        self.assertFalse(os.path.exists(self.maps("v", "a.jpg")[0]))

    def test_truncated_and_foreign(self):
        for name in FORMATS:
            self.export(name, "--format", name)
            whole = files.read_bytes(self.path(name, "depth", f"a.jpg.{name}"))
            for content in (b"", b"hello", whole[:9], whole[:len(whole) // 2], whole[:-4]):
                self.refuse(f"a.{name}", content)
        self.refuse("a.exr", files.read_bytes(self.path("png/depth/a.jpg.png")), " holds uint16")
        for name in FORMATS:
            normals = self.path(name, "normals", f"a.jpg.{name}")
            self.refuse(f"a.{name}", files.read_bytes(normals), " ")

    def test_what_means_something_else(self):
        pfm = b"Pf\n%d %d\n%s\n" + np.ones((HEIGHT, WIDTH), "<f4").tobytes()
        self.refuse("a.pfm", pfm % (WIDTH, HEIGHT, b"-0.5"), " has the scale -0.5")
        self.refuse("a.pfm", pfm % (9 * WIDTH, HEIGHT, b"-1"), " is not a readable image")
        self.refuse("a.pfm", b"Pf\n1000000 1000000\n-1\n", " is not a readable image")
        _, exr = cv2.imencode(".exr", self.depth)
        self.refuse("a.exr", exr.tobytes().replace(b"Y\0\2\0\0\0", b"\xc3\xa4\0\2\0\0\0", 1), " ")
        self.refuse("a.png", cv2.imencode(".png", np.uint8(self.depth))[1].tobytes(),
                    " is not a 16-bit")
        negative = -self.depth
        self.refuse("a.exr", cv2.imencode(".exr", negative)[1].tobytes(),
                    f" has {np.count_nonzero(negative)} negative depths")

    def test_arrays(self):
        def content(values):
            np.save(self.path("x.npy"), values, allow_pickle=True)
            return files.read_bytes(self.path("x.npy"))
        self.refuse("a.npy", content(np.array([{}])), " is not a readable NPY file")
        self.refuse("a.npy", content(np.ones((HEIGHT, WIDTH), int)), " holds int64")
        self.refuse("a.npy", content(np.ones((HEIGHT, WIDTH, 1))), " is of shape 32 x 48 x 1")
        self.refuse("a.npy", content(np.ones((0, WIDTH))), " ")
        whole = content(np.ones((HEIGHT, WIDTH), np.float32))
        self.refuse("a.npy", whole.replace(b"(32, 48)", b"(10**9,)"), " is not a readable")
        self.refuse("a.npy", whole.replace(b"(32, 48), }  ", b"(99999, 99999)}"), " is not a read")

    def test_any_damage(self):
        """Whatever stands in a file, there is a map or one line."""
        random = np.random.default_rng(3)
        for name in FORMATS:
            path = self.path(f"a.{name}")
            formats.write_numbers(path, self.depth, 1000)
            whole = files.read_bytes(path)
            for _ in range(40):
                content = bytearray(whole[:random.integers(1, len(whole) + 1)])
                for at in random.integers(0, min(len(content), 400), 3):
                    content[at] = random.integers(256)
                files.write_bytes(path, content)
                try:
                    self.assertEqual(formats.read_numbers(path, 1000).ndim, 2)
                except Failure as error:
                    self.assertIn(path, str(error))


class SlopesTest(TestCase):
    def test_planes(self):
        camera = colmap_model.Camera("PINHOLE", 60, 40, (70.0, 65.0, 25.0, 22.0))
        random = np.random.default_rng(1)
        for normal in ((0, 0, -1), (0.6, 0, -0.8), (-0.48, 0.6, -0.64)):
            depth, expected = slanted_plane(camera, normal)
            depth[random.uniform(size=depth.shape) < 0.3] = 0
            is_known = depth > 0
            for factor in (1, 1e-3, 1e5):
                found = slopes.normals_from_depth(factor * depth, camera)
                self.assertLess(np.abs(found - expected)[is_known].max(), 5e-3)
                self.assertFalse(found[~is_known].any())

    def test_edges_and_lonely_pixels(self):
        camera = colmap_model.Camera("PINHOLE", 40, 40, (400.0, 400.0, 20.0, 20.0))
        depth = np.full((40, 40), 2, np.float32)
        depth[:, 20:] = 3
        found = slopes.normals_from_depth(depth, camera)
        np.testing.assert_allclose(found, np.broadcast_to((0, 0, -1), found.shape), atol=1e-6)
        depth[:], depth[7, 7] = 0, 5
        self.assertEqual(slopes.normals_from_depth(depth, camera)[7, 7].tolist(), [0, 0, -1])
        # Two pixels side by side know the slope in one direction only.
        depth[7, 8] = 5.02
        normal = slopes.normals_from_depth(depth, camera)[7, 7]
        self.assertGreater(normal[0], 0.5)
        self.assertTrue(np.isfinite(normal).all())
