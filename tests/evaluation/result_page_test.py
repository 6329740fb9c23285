"""scripts/result_page on small workspaces, whole and damaged; a browser shows the page."""

import html
import json
import os
import sqlite3
import struct
import unittest
from contextlib import closing
from html.parser import HTMLParser

import cv2
import numpy as np

import page_workspace
from helpers import ProgramTest, TestCase
from evaluation import files, images, point_clouds
from evaluation.page import browser, confidence, result_page
from evaluation.page.logs import Logs
from evaluation.page.thinning import thin
from evaluation.processes import Failure

NAMES = ["a.jpg", "b.jpg", "c.jpg"]
ODD = ["<b>&\"'.jpg", "</script><script>alert(1)</script>.jpg".replace("/", "_"), "ä {{ x }}.jpg"]


class Addresses(HTMLParser):
    """What a page loads or links, and the scripts that it has."""

    def __init__(self, text):
        super().__init__()
        self.found, self.scripts, self._is_script = [], [], False
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.found += [value for name, value in attrs
                       if name in ("src", "href", "srcset", "data", "action", "poster")]
        self._is_script = tag == "script"

    def handle_endtag(self, tag):
        self._is_script = False

    def handle_data(self, data):
        if self._is_script:
            self.scripts.append(data)


class ThinningTest(unittest.TestCase):
    def setUp(self):
        rng = np.random.default_rng(0)
        # Half of the points in a thousandth of the space.
        self.points = np.vstack((rng.uniform(0, 10, (5000, 3)), rng.uniform(0, 1, (5000, 3))))

    def test_count_and_order(self):
        for count in (0, 1, 7, 1000, 9999):
            chosen = thin(self.points, count)
            self.assertEqual(len(chosen), count)
            self.assertTrue((np.diff(chosen) > 0).all())
        np.testing.assert_array_equal(thin(self.points, 10000), np.arange(10000))

    def test_the_same_every_time(self):
        np.testing.assert_array_equal(thin(self.points, 500), thin(self.points.copy(), 500))

    def test_spread_evenly(self):
        chosen = self.points[thin(self.points, 512)]
        self.assertLess((chosen < 1).all(axis=1).mean(), 0.05)
        # Nearly every eighth of the space in each direction has one.
        self.assertGreater(len(np.unique((chosen / 1.25).astype(int), axis=0)), 400)

    def test_equal_points_and_such_on_a_line(self):
        self.assertEqual(len(thin(np.zeros((100, 3)), 10)), 10)
        line = np.zeros((1000, 3), np.float32)
        line[:, 1] = np.arange(1000)
        self.assertLess(np.diff(line[thin(line, 100), 1]).max(), 25)

    def test_far_from_the_origin(self):
        moved = self.points + (5e5, 5e6, 0)
        self.assertEqual(len(thin(moved, 300)), 300)


class CloudTest(TestCase):
    def test_colors_and_confidence(self):
        path = self.path("fused.ply")
        page_workspace.write_cloud(path, 50)
        cloud = point_clouds.read_cloud(path)
        np.testing.assert_array_equal(cloud.colors, np.tile(page_workspace.ORANGE, (50, 1)))
        self.assertTrue(((cloud.confidence >= 1) & (cloud.confidence <= 3)).all())
        np.testing.assert_array_equal(cloud.points, point_clouds.read_ply(path)[0])

    def test_without_them(self):
        point_clouds.write_ply(self.path("a.ply"), np.ones((3, 3), np.float32))
        cloud = point_clouds.read_cloud(self.path("a.ply"))
        self.assertIsNone(cloud.colors)
        self.assertIsNone(cloud.confidence)

    def test_numbers_of_views(self):
        path = self.path("a.ply")
        point_clouds.write_ply(path, np.ones((2, 3), np.float32))
        cloud = point_clouds.read_cloud(path)
        self.assertIsNone(confidence.of_points(cloud, path))
        whole = struct.pack("<Q6I", 2, 3, 0, 1, 2, 1, 0)
        files.write_bytes(path + ".vis", whole)
        self.assertEqual(confidence.of_points(cloud, path).tolist(), [3, 1])
        for damaged in (whole[:-4], whole[:-1], whole[:5], b"", whole + b"\0" * 4):
            files.write_bytes(path + ".vis", damaged)
            with self.assertRaisesRegex(Failure, "a.ply.vis"):
                confidence.of_points(cloud, path)

    def test_consistency_graphs(self):
        path = self.path("a.bin")
        files.write_bytes(path, b"3&2&1&" + struct.pack("<9i", 2, 1, 2, 7, 8, 0, 0, 1, 9))
        self.assertEqual(confidence.read_graph(path, (2, 3)).tolist(), [[1, 0, 0], [0, 0, 2]])
        for damaged in (b"", b"3&2&", b"3&2&1&" + struct.pack("<3i", 9, 9, 0), b"3&2&1&\0",
                        b"3&2&1&" + struct.pack("<3i", 1, 1, -1)):
            files.write_bytes(path, damaged)
            with self.assertRaisesRegex(Failure, "a.bin"):
                confidence.read_graph(path, (2, 3))
        # A header of next to no bytes that asks for all memory.
        files.write_bytes(path, b"999999&999999&1&")
        with self.assertRaisesRegex(Failure, "a.bin has 999999x999999 pixels, but the map 3x2"):
            confidence.read_graph(path, (2, 3))


class PageCase(ProgramTest):
    main = result_page.main

    def setUp(self):
        super().setUp()
        self.workspace = self.path("out/dense/0")
        self.page = self.path("page.html")

    def make(self, names=NAMES, **options):
        page_workspace.make(self.workspace, names, **options)

    def make_page(self, *words):
        """Its text, and the scene in it."""
        self.assertEqual(self.run_well(self.workspace, "--out", self.page, *words),
                         f"Page: {self.page}\n")
        text = self.read("page.html")
        return text, json.loads(Addresses(text).scripts[0])


class PageTest(PageCase):
    def test_nothing_is_loaded(self):
        self.make()
        text, _ = self.make_page()
        page = Addresses(text)
        self.assertGreater(len(page.found), 9)
        for address in page.found:
            self.assertRegex(address, "^data:image/(jpeg|png);base64,")
        self.assertNotRegex(text, r"@import|url\(|import\s*\(|<link|<iframe")

    def test_points_and_cameras(self):
        self.make()
        _, scene = self.make_page("--points", "500")
        (cloud,) = scene["clouds"]
        self.assertEqual((cloud["name"], cloud["total"], cloud["count"]), ("fused.ply", 2000, 500))
        self.assertEqual([camera["name"] for camera in scene["cameras"]], NAMES)
        self.assertEqual({camera["distance"] for camera in scene["cameras"]},
                         {page_workspace.DEPTH})

    def test_pictures_of_what_there_is(self):
        self.make()
        origin = cv2.imencode(".png", np.zeros((32, 48, 3), np.uint8))[1]
        files.write_bytes(os.path.join(self.workspace, "tapa_debug/b.jpg/11_origin.png"), origin)
        files.write_bytes(os.path.join(
            self.workspace, "stereo/consistency_graphs/c.jpg.geometric.bin"),
            b"48&32&1&" + struct.pack("<4i", 1, 1, 1, 0))
        text, _ = self.make_page()
        for name, titles in (("a.jpg", ""), ("b.jpg", "origin of depth"),
                             ("c.jpg", "photographs that agree")):
            for title in filter(None, ("photograph", "depth", "normals", "confidence of points",
                                       titles)):
                self.assertIn(f'alt="{title} of {name}"', text)
        self.assertNotIn('alt="origin of depth of a.jpg"', text)
        self.assertIn("depth at 88 % of 48 x 32 pixels", text)

    def test_odd_names(self):
        self.make(ODD)
        text, scene = self.make_page()
        self.assertEqual([camera["name"] for camera in scene["cameras"]], sorted(ODD))
        for name in ODD:
            self.assertNotIn(name, text if "<" in name else "")
            self.assertIn(name, html.unescape(text))
        self.assertNotIn("<b>", text)

    def test_what_is_missing_is_said(self):
        self.make(num_mapped=2)
        os.remove(os.path.join(self.workspace, "fused.ply"))
        os.remove(os.path.join(self.workspace, "stereo/normal_maps/a.jpg.geometric.bin"))
        os.remove(os.path.join(self.workspace, "images/b.jpg"))
        text, scene = self.make_page()
        self.assertEqual(scene["clouds"], [])
        for part in ("There are no points", "The confidence of points is not known",
                     "Where depths come from is not recorded", "there is no stereo/options",
                     "there is no log", "no pose at all is not known",
                     "3 photographs with a pose, 2 of them with geometric maps"):
            self.assertIn(part, text)
        self.assertNotIn('alt="normals of a.jpg"', text)
        self.assertNotIn('alt="photograph of b.jpg"', text)
        self.assertEqual([camera["used"] for camera in scene["cameras"]], [True, True, False])

    def test_only_a_model(self):
        self.make(num_mapped=0, points=0)
        text, scene = self.make_page()
        self.assertIn("none of them with maps", text)
        self.assertIn("run patch_match_stereo", text)
        self.assertEqual(scene["clouds"][0]["total"], 0)

    def test_photometric_maps(self):
        self.make(num_mapped=0)
        page_workspace.write_maps(self.workspace, "b.jpg", "photometric")
        self.assertIn("1 of them with photometric maps", self.make_page()[0])

    def test_left_out(self):
        self.make(num_mapped=1)
        self.write("out/dense/0/stereo/patch-match.cfg", "a.jpg\n__auto__, 2\nb.jpg\n__auto__, 2\n")
        self.write("out/dense/0/stereo.log",
                   "WARNING: Source image b.jpg of a.jpg cannot be used: x; it is left out\n"
                   "WARNING: View bb.jpg cannot be computed: it is another; it is left out\n"
                   "WARNING: View b.jpg cannot be computed: it is alone; it is left out\n")
        os.makedirs(self.path("out/sparse/1"))
        self.write("out/sparse/1/images.txt", "1 1 0 0 0 0 0 0 1 other.jpg\n\n")
        with closing(sqlite3.connect(self.path("out/database.db"))) as database:
            database.executescript("""
                CREATE TABLE images (image_id INTEGER, name TEXT);
                CREATE TABLE keypoints (image_id INTEGER, rows INTEGER);
                CREATE TABLE two_view_geometries (pair_id INTEGER, rows INTEGER);
                INSERT INTO images VALUES (1, 'a.jpg'), (2, 'dark.jpg'), (3, 'far.jpg'),
                    (4, 'lost.jpg'), (5, 'other.jpg');
                INSERT INTO keypoints VALUES (1, 900), (2, 0), (3, 70), (4, 80), (5, 90);
                INSERT INTO two_view_geometries VALUES (2147483651, 20), (2147483650, 0);""")
        text = html.unescape(self.make_page()[0])
        for name, reason in (("b.jpg", "it is alone"), ("c.jpg", "patch-match.cfg does not list"),
                             ("dark.jpg", "no features"), ("far.jpg", "none of its 70 features"),
                             ("lost.jpg", "it matches another photograph, but"),
                             ("other.jpg", "it is in another model, sparse/1")):
            self.assertRegex(text, f"<td>{name}</td><td>[^<]*{reason}")
        self.assertNotIn("<td>a.jpg</td>", text)
        files.write_bytes(self.path("out/database.db"), b"no database" * 99)
        self.expect_error([self.workspace, "--out", self.page], "out/database.db is not")

    def test_times_and_options(self):
        self.make()
        self.write("out/dense/0/stereo/options.geometric.txt",
                   "# Comment = 1\nseed = 7\ntapa = <1>\n")
        line = (" 50.0 %  0:00:31 to go  {} 1/4 a.jpg: 0.04 megapixels in {} s, 160.9 s per "
                "megapixel\n")
        self.write("out/dense/0/stereo.log", "$ colmap patch_match_stereo\n"
                   + line.format("level 1 photometric", "1.5") + line.format("geometric", "2.0")
                   + "Elapsed time: 61.5 [minutes]\n")
        text = self.make_page()[0]
        self.assertIn("stereo took 3.5 s", text)
        self.assertIn("<td>colmap patch_match_stereo</td><td>1:01:30</td>", text)
        self.assertIn("<td>seed</td><td>7</td>", text)
        self.assertIn("<td>tapa</td><td>&lt;1&gt;</td>", text)
        self.assertNotIn("Comment", text)

    def test_steps_of_a_log_with_headings(self):
        rule = "=" * 78 + "\n"
        self.write("a.log", "".join(
            rule + heading + "\n" + rule + "\n" + rest for heading, rest in (
                ("Feature extraction", "Elapsed time: 1.0 [minutes]\n"),
                ("Finding good initial image pair", ""), ("Registering image #4 (3)", ""),
                ("Global bundle adjustment", "Elapsed time: 2.0 [minutes]\n"))))
        self.write("b.log", "Elapsed time: 1.0 [minutes]\nElapsed time: 1.5 [minutes]\n")
        self.assertEqual(Logs([self.folder, self.folder]).steps, [
            ("Feature extraction", "a.log", 60, 1), ("Camera poses", "a.log", 120, 1),
            ("b", "b.log", 150, 2)])

    def test_damaged_files(self):
        self.make()
        whole = {}
        for name, content, part in (
                ("fused.ply", lambda data: data[:-9], "fused.ply is truncated"),
                ("fused.ply", lambda data: b"text", "fused.ply is not a PLY file"),
                ("stereo/depth_maps/b.jpg.geometric.bin", lambda data: data[:-9],
                 "depth_maps/b.jpg.geometric.bin is truncated"),
                ("stereo/normal_maps/b.jpg.geometric.bin", lambda data: b"",
                 "normal_maps/b.jpg.geometric.bin is not"),
                ("images/a.jpg", lambda data: data[:9], "images/a.jpg is not a readable image"),
                ("sparse/images.txt", lambda data: b"1 2 3\n", "sparse/images.txt: no photograph"),
                ("sparse/cameras.txt", lambda data: b"", "sparse/cameras.txt holds no camera")):
            path = os.path.join(self.workspace, name)
            whole.setdefault(path, files.read_bytes(path))
            files.write_bytes(path, content(whole[path]))
            self.expect_error([self.workspace, "--out", self.page], part)
            self.assertFalse(os.path.exists(self.page))
            files.write_bytes(path, whole[path])

    def test_damaged_binary_models(self):
        self.make()
        for name, content in (("cameras.bin", b"\1"), ("cameras.bin", struct.pack("<Q", 9)),
                              ("images.bin", struct.pack("<QiQ", 1, 1, 1))):
            files.write_bytes(os.path.join(self.workspace, "sparse/cameras.bin"),
                              struct.pack("<QiiQQ4d", 1, 1, 1, 48, 32, 40, 40, 24, 16))
            files.write_bytes(os.path.join(self.workspace, "sparse/images.bin"), b"")
            files.write_bytes(os.path.join(self.workspace, "sparse", name), content)
            self.expect_error([self.workspace, "--out", self.page], f"sparse/{name} is damaged")

    def test_a_binary_model(self):
        self.make()
        _, expected = self.make_page()
        sparse = os.path.join(self.workspace, "sparse")
        files.write_bytes(os.path.join(sparse, "cameras.bin"),
                          struct.pack("<QiiQQ4d", 1, 1, 1, 48, 32, 40, 40, 24, 16))
        views = b"".join(
            struct.pack("<i7di", i + 1, 1, 0, 0, 0, -0.3 * i, 0, 0, 1) + name.encode() + b"\0"
            + struct.pack("<Q2dq", 1, 5, 5, -1) for i, name in enumerate(NAMES))
        files.write_bytes(os.path.join(sparse, "images.bin"), struct.pack("<Q", 3) + views)
        os.remove(os.path.join(sparse, "images.txt"))
        self.assertEqual(self.make_page()[1], expected)

    def test_the_page_appears_when_it_is_complete(self):
        self.make()
        self.make_page()
        before = self.read("page.html")
        files.write_bytes(os.path.join(self.workspace, "stereo/depth_maps/c.jpg.geometric.bin"),
                          b"")
        self.expect_error([self.workspace, "--out", self.page], "c.jpg.geometric.bin")
        self.assertEqual(self.read("page.html"), before)
        self.assertEqual([name for name in os.listdir(self.folder) if "page" in name],
                         ["page.html"])

    def test_no_workspace(self):
        self.expect_error([self.path("nothing")], "is no dense workspace")
        self.expect_error([], "required: WORKSPACE")

    def test_libraries_that_are_missing(self):
        self.make()
        os.environ["TAPA_THREE_DIR"] = self.path("none")
        self.addCleanup(os.environ.pop, "TAPA_THREE_DIR")
        self.expect_error([self.workspace], "run scripts/install_deps.sh")


@unittest.skipUnless(browser.find(), "there is no browser: install chromium")
class BrowserTest(PageCase):
    """What a browser shows."""

    def show(self, script=""):
        """The page as pixels, after a script has used it."""
        if script:
            files.write_text(self.page, self.read("page.html").replace(
                "</body>", f"<script>{script}</script></body>"))
        console = browser.take_picture(self.page, self.path("page.png"), 1000, 700)
        self.assertEqual([line for line in console if "GL Driver Message" not in line], [])
        return images.read_color(self.path("page.png"))[:, :, ::-1].astype(int)

    def share_of_points(self, script=""):
        """Of the pixels, by the colour."""
        return (np.abs(self.show(script) - page_workspace.ORANGE) < 12).all(axis=2).mean()

    def test_points_are_drawn(self):
        self.make(ODD)
        self.make_page()
        self.assertGreater(self.share_of_points(), 0.05)
        os.remove(os.path.join(self.workspace, "fused.ply"))
        self.make_page()
        self.assertLess(self.share_of_points(), 0.001)

    def test_controls(self):
        self.make(ODD)
        self.make_page()
        before = self.share_of_points()
        self.assertGreater(self.share_of_points(
            "document.querySelectorAll('button[data-view]')[1].click(); scrollTo(0, 0)"),
            1.2 * before)
        use = "input = document.querySelector('{}'); {}; input.dispatchEvent(new Event('input'))"
        self.assertLess(self.share_of_points(
            "let " + use.format(".confidence input", "input.value = 250")), 0.6 * before)
        self.assertLess(self.share_of_points(use.format(".tint", "input.checked = true")), 0.001)

    def test_an_error_is_seen(self):
        files.write_text(self.page, "<script>nothing.here();</script>")
        with self.assertRaises(AssertionError):
            self.show()
