"""Every sub-command of scripts/eth3d on a miniature in ETH3D's own layout.

A server on this machine stands in for the benchmark's site.
"""

import csv
import http.server
import json
import os
import re
import shutil
import stat
import subprocess
import sys
import tempfile
import threading
import unittest

import cv2
import numpy as np

import tiny_workspace as tiny

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "../.."))
sys.path.insert(0, ROOT)
from evaluation import depth_maps, files, meshlab_project, point_clouds  # noqa: E402
from evaluation.point_cloud_score import LaserScan, merge_scans  # noqa: E402

SCRIPTS = os.path.join(ROOT, "scripts")
BIN_DIR = os.path.dirname(os.path.abspath(tiny.COLMAP))
# Enough for points that can be scored, and fast.
FAST = ["--image_sizes", "144", "--", "--PatchMatchStereo.num_iterations", "2",
        "--PatchMatchStereo.window_radius", "3", "--PatchMatchStereo.num_samples", "6"]
METHODS = ["--methods", "colmap,tapa"]
SEVEN_ZIP = next((name for name in ("7z", "7zz", "7za") if shutil.which(name)), None)


def run_script(name, *arguments, **options):
    """Runs a script; its result has all output as text in stdout."""
    return subprocess.run(
        [os.path.join(SCRIPTS, name), *arguments], stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=600,
        env=dict(os.environ, TAPA_BIN_DIR=BIN_DIR), **options)


def pack(archive, above, *members):
    subprocess.run([SEVEN_ZIP, "a", "-mx=1", archive, *members], cwd=above, check=True,
                   stdout=subprocess.DEVNULL)


class Site:
    """Serves files, by name, and remembers what was asked of it.

    A file in `cut` ends after so many bytes, as if the line broke.
    """

    def __init__(self):
        self.files = {}
        self.cut = {}
        self.requests = []
        site = self

        class Handler(http.server.BaseHTTPRequestHandler):

            def log_message(self, *_):
                pass

            def answer(self):
                name = self.path.removeprefix("/data/")
                wanted = re.fullmatch(r"bytes=(\d+)-", self.headers.get("Range") or "")
                begin = int(wanted[1]) if wanted else 0
                site.requests.append((self.command, name, begin))
                if name not in site.files:
                    self.send_error(404)
                    return
                data = site.files[name]
                self.send_response(206 if wanted else 200)
                self.send_header("Content-Length", str(len(data) - begin))
                if wanted:
                    self.send_header("Content-Range", f"bytes {begin}-{len(data) - 1}/{len(data)}")
                self.end_headers()
                if self.command == "GET":
                    self.wfile.write(data[begin:site.cut.get(name, len(data))])

            do_GET = do_HEAD = answer

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        self.url = f"http://127.0.0.1:{self.server.server_port}/data"

    def close(self):
        self.server.shutdown()
        self.server.server_close()


class Case(unittest.TestCase):

    def assert_failed(self, result, *texts):
        """One line begins with ERROR; the texts are in the output."""
        self.assertEqual(result.returncode, 1, result.stdout)
        errors = [line for line in result.stdout.splitlines() if line.startswith("ERROR")]
        self.assertEqual(len(errors), 1, result.stdout)
        self.assertNotIn("Traceback", result.stdout)
        for text in texts:
            self.assertIn(text, result.stdout)

    def assert_done(self, result):
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertNotIn("ERROR", result.stdout)

    @classmethod
    def make_folder(cls, add_cleanup):
        folder = tempfile.mkdtemp(prefix="tapa-")
        add_cleanup(shutil.rmtree, folder, True)
        return folder

    def read(self, *parts):
        with open(os.path.join(*parts), encoding="utf-8") as file:
            return file.read()

    def read_json(self, *parts):
        return json.loads(self.read(*parts))


@unittest.skipIf(SEVEN_ZIP is None or shutil.which("curl") is None, "needs 7z and curl")
class Download(Case):
    """Archives of the rig's scene "tunnel", which has just one, and of "office"."""

    @classmethod
    def setUpClass(cls):
        cls.made = cls.make_folder(cls.addClassCleanup)
        cls.archives = {}
        for scene, kinds in (("tunnel", ["rig_undistorted"]),
                             ("office", ["dslr_undistorted", "dslr_scan_eval"])):
            for kind in kinds:
                member = os.path.join(scene, kind)
                os.makedirs(os.path.join(cls.made, member))
                with open(os.path.join(cls.made, member, "content"), "wb") as file:
                    file.write(os.urandom(50000))
                name = f"{scene}_{kind}.7z"
                pack(name, cls.made, member)
                with open(os.path.join(cls.made, name), "rb") as file:
                    cls.archives[name] = file.read()

    def setUp(self):
        self.folder = self.make_folder(self.addCleanup)
        self.site = Site()
        self.addCleanup(self.site.close)
        self.site.files = dict(self.archives)

    def download(self, *arguments, scene="tunnel"):
        choice = (["--resolution", "low", "--split", "test"] if scene == "tunnel"
                  else ["--without_depth"])
        return run_script("eth3d", "download", self.folder, "--base_url", self.site.url,
                          "--scenes", scene, *choice, *arguments)

    def content(self, member, root=None):
        with open(os.path.join(root or self.folder, member, "content"), "rb") as file:
            return file.read()

    def assert_unpacked(self, member):
        self.assertEqual(self.content(os.path.join("scenes", member)),
                         self.content(member, self.made))

    def test_fetches_verifies_and_unpacks(self):
        self.assert_done(self.download("--yes", scene="office"))
        self.assert_unpacked("office/dslr_undistorted")
        self.assert_unpacked("office/dslr_scan_eval")
        # Nothing is asked of the site again.
        del self.site.requests[:]
        self.assert_done(self.download("--yes", scene="office"))
        self.assertEqual(self.site.requests, [])

    def test_resumes(self):
        name = "tunnel_rig_undistorted.7z"
        self.site.cut[name] = 20000
        result = self.download("--yes")
        self.assert_failed(result, name, "1 of 1 failed")
        self.assertFalse(os.path.exists(os.path.join(self.folder, "scenes", "tunnel")))
        part = os.path.join(self.folder, "archives", name + ".part")
        self.assertEqual(os.path.getsize(part), 20000)
        self.site.cut.clear()
        self.assert_done(self.download("--yes"))
        self.assertIn(("GET", name, 20000), self.site.requests)
        self.assert_unpacked("tunnel/rig_undistorted")
        self.assertFalse(os.path.exists(part))

    def test_damaged_on_its_way(self):
        name = "tunnel_rig_undistorted.7z"
        whole = self.site.files[name]
        self.site.files[name] = whole[:30000] + bytes(100) + whole[30100:]
        self.assert_failed(self.download("--yes"), name, "did not arrive whole")
        self.assertFalse(os.path.exists(os.path.join(self.folder, "scenes", "tunnel")))
        self.site.files[name] = whole
        self.assert_done(self.download("--yes"))
        self.assert_unpacked("tunnel/rig_undistorted")

    def test_part_of_a_larger_archive(self):
        name = "tunnel_rig_undistorted.7z"
        os.makedirs(os.path.join(self.folder, "archives"))
        with open(os.path.join(self.folder, "archives", name + ".part"), "wb") as file:
            file.write(bytes(90000))
        self.assert_done(self.download("--yes"))
        self.assert_unpacked("tunnel/rig_undistorted")

    def test_missing_archive_does_not_stop_the_others(self):
        del self.site.files["office_dslr_undistorted.7z"]
        result = self.download("--yes", scene="office")
        self.assert_failed(result, "404", "1 of 2 failed", "office_dslr_undistorted.7z")
        self.assert_unpacked("office/dslr_scan_eval")

    def test_asks(self):
        result = self.download(scene="office")
        self.assert_failed(result, "0.10 MB would be fetched", "--yes")
        self.assertNotIn("GET", [request[0] for request in self.site.requests])

    def test_removes_archives(self):
        self.assert_done(self.download("--yes", "--remove_archives"))
        self.assert_unpacked("tunnel/rig_undistorted")
        self.assertEqual(os.listdir(os.path.join(self.folder, "archives")),
                         ["tunnel_rig_undistorted.7z.unpacked"])
        self.assert_done(self.download("--yes", "--remove_archives"))

    def test_dry_run(self):
        result = self.download("--dry_run")
        self.assert_done(result)
        self.assertRegex(result.stdout, r"(?s)^curl .*/data/tunnel_rig_undistorted\.7z\n"
                                        r"7z\S* t .*\.part\n7z\S* x .*\n$")
        self.assertEqual(self.site.requests, [])
        self.assertEqual(os.listdir(self.folder), [])

    def test_whole_benchmark(self):
        result = run_script("eth3d", "download", self.folder, "--dry_run", "--resolution", "both",
                            "--split", "both")
        self.assert_done(result)
        fetched = [line.split()[-1] for line in result.stdout.splitlines()
                   if line.startswith("curl")]
        self.assertEqual(len(fetched), 4 * 18 + 17)
        self.assertEqual({os.path.dirname(url) for url in fetched}, {"https://www.eth3d.net/data"})


class Prepare(Case):

    @classmethod
    def setUpClass(cls):
        cls.made = cls.make_folder(cls.addClassCleanup)
        result = run_script("eth3d", "miniature", cls.made, "--scene", "attic", "--image_size",
                            "96", "--views", "4", "--voxel_size", "0.1")
        assert result.returncode == 0, result.stdout

    def setUp(self):
        self.folder = self.make_folder(self.addCleanup)
        shutil.copytree(os.path.join(self.made, "scenes"), os.path.join(self.folder, "scenes"))

    def prepare(self, *arguments):
        return run_script("eth3d", "prepare", self.folder, *arguments)

    def scene(self, *parts):
        return os.path.join(self.folder, "scenes", "attic", *parts)

    def set(self, *parts):
        return os.path.join(self.folder, "sets", *parts)

    def test_sets(self):
        self.assert_done(self.prepare())
        content = self.read_json(self.set("attic_rig", "set.json"))
        self.assertEqual(
            (content["scene"], content["resolution"], content["split"], content["photographs"],
             content["depth_maps"], content["scans"]),
            ("attic", "low", "training", 4, 4, True))
        self.assertAlmostEqual(content["depth_over_points"], 1, delta=0.005)
        # Links are relative: the whole folder can be moved.
        moved = self.folder + "-moved"
        os.rename(self.folder, moved)
        self.addCleanup(shutil.rmtree, moved, True)
        for name in ("images/dslr_images_undistorted/DSC_0101.JPG", "sparse/points3D.txt",
                     "scans/scan_alignment.mlp"):
            self.assertTrue(os.path.isfile(os.path.join(moved, "sets/attic_dslr", name)), name)
        # The photographs as taken do not take part.
        self.assertEqual(os.listdir(os.path.join(moved, "sets/attic_dslr/images")),
                         ["dslr_images_undistorted"])

    def test_depth_is_that_of_the_undistorted_photograph(self):
        self.assert_done(self.prepare("--resolution", "high"))
        depth = depth_maps.read(self.set(
            "attic_dslr/gt_depth/dslr_images_undistorted/DSC_0104.bin"))
        self.assertEqual(depth.shape, (64, 96))
        truth = depth_maps.read(os.path.join(ROOT, "examples/room/gt_depth/room_05.png"))
        truth = cv2.resize(truth, (96, 64), interpolation=cv2.INTER_NEAREST_EXACT)
        errors = np.abs(depth / truth - 1)[depth > 0]
        # Three of ten have no measurement, and a border was not photographed.
        self.assertGreater(len(errors), 0.55 * depth.size)
        self.assertLess(len(errors), 0.75 * depth.size)
        self.assertLess(np.median(errors), 0.004)
        self.assertLess(np.percentile(errors, 90), 0.02)

    def test_depth_size(self):
        self.assert_done(self.prepare("--depth_size", "48"))
        path = self.set("attic_dslr/gt_depth/dslr_images_undistorted/DSC_0101.bin")
        self.assertEqual(depth_maps.read(path).shape, (32, 48))
        # Maps of two sizes are not mixed.
        self.assert_failed(self.prepare(), "--depth_size 48", "2 of 2 failed")
        self.assertEqual(depth_maps.read(path).shape, (32, 48))

    def test_again_makes_only_what_is_missing(self):
        self.assert_done(self.prepare())
        folder = self.set("attic_dslr/gt_depth/dslr_images_undistorted")
        paths = [os.path.join(folder, name) for name in sorted(os.listdir(folder))]
        times = [os.stat(path).st_mtime_ns for path in paths]
        os.remove(paths[0])
        self.assert_done(self.prepare())
        self.assertEqual([os.stat(path).st_mtime_ns for path in paths[1:]], times[1:])
        self.assertTrue(os.path.exists(paths[0]))

    def test_test_scene(self):
        result = run_script("eth3d", "miniature", self.folder, "--scene",
                            "door", "--image_size", "96", "--views", "4", "--split", "test")
        self.assert_done(result)
        self.assert_done(self.prepare("--scenes", "door"))
        content = self.read_json(self.set("door_dslr", "set.json"))
        self.assertEqual((content["split"], content["depth_maps"], content["scans"]),
                         ("test", 0, False))

    def test_dry_run(self):
        result = self.prepare("--dry_run")
        self.assert_done(result)
        self.assertIn("attic_rig", result.stdout)
        self.assertFalse(os.path.exists(self.set()))

    def expect_failure(self, *texts):
        """The rig's set, of which nothing is broken, is made."""
        self.assert_failed(self.prepare(), "1 of 2 failed", "attic_dslr", *texts)
        self.assertTrue(os.path.exists(self.set("attic_rig", "set.json")))
        self.assertFalse(os.path.exists(self.set("attic_dslr", "set.json")))

    def test_missing_model(self):
        os.remove(self.scene("dslr_calibration_undistorted", "points3D.txt"))
        self.expect_failure("has no points3D.txt", "attic_dslr_undistorted.7z")

    def test_missing_photograph(self):
        os.remove(self.scene("images/dslr_images_undistorted/DSC_0107.JPG"))
        self.expect_failure("DSC_0107.JPG is missing")

    def test_depth_of_another_size(self):
        with open(self.scene("ground_truth_depth/dslr_images/DSC_0104.JPG"), "ab") as file:
            file.write(b"more")
        self.expect_failure("ground_truth_depth/dslr_images/DSC_0104.JPG", "96x64 depths need")

    def test_depth_of_another_unit(self):
        folder = self.scene("ground_truth_depth/dslr_images")
        for name in os.listdir(folder):
            path = os.path.join(folder, name)
            (np.float32(1.1) * np.fromfile(path, np.float32)).tofile(path)
        self.expect_failure("times as deep as the points of the model")

    def test_depth_somewhere_else(self):
        os.rename(self.scene("ground_truth_depth/dslr_images"),
                  self.scene("ground_truth_depth/elsewhere"))
        result = self.prepare()
        self.assert_done(result)
        self.assertIn("WARNING: attic_dslr: no depth map is at", result.stdout)
        self.assertIn("ground_truth_depth/dslr_images/DSC_0101.JPG", result.stdout)

    def test_calibration_of_other_poses(self):
        path = self.scene("dslr_calibration_jpg", "images.txt")
        lines = self.read(path).split("\n")
        words = lines[1].split()
        words[5] = str(float(words[5]) + 0.1)
        lines[1] = " ".join(words)
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(lines))
        self.expect_failure("the pose of dslr_images/DSC_0101.JPG is another")

    def test_nothing_unpacked(self):
        shutil.rmtree(self.scene())
        self.assert_failed(self.prepare(), "no unpacked scene", "download")

    def test_lens_is_that_of_colmap(self):
        # COLMAP finds the miniature's points where we projected them.
        for calibration in ("dslr_calibration_jpg", "dslr_calibration_undistorted"):
            out = os.path.join(self.folder, calibration)
            os.makedirs(out)
            result = tiny.run([tiny.COLMAP, "bundle_adjuster", "--input_path",
                               self.scene(calibration), "--output_path", out,
                               "--BundleAdjustment.max_num_iterations", "1"])
            self.assertEqual(result.returncode, 0, result.stdout)
            cost = re.search(r"Initial cost : ([0-9.e-]+)", result.stdout)
            self.assertIsNotNone(cost, result.stdout)
            self.assertLess(float(cost[1]), 0.1)  # Pixels; the photographs are small.


class Pipeline(Case):
    """From sets to a report and a submission, with two scenes of both tracks."""

    @classmethod
    def setUpClass(cls):
        cls.folder = cls.make_folder(cls.addClassCleanup)
        cls.commands = [
            ("eth3d", "miniature", cls.folder, "--scene", "office",
             "--image_size", "144", "--views", "4", "--voxel_size", "0.02"),
            ("eth3d", "prepare", cls.folder),
            ("eth3d", "run", cls.folder, "--resolution", "both", *METHODS, *FAST)]
        for command in cls.commands:
            result = run_script(*command)
            assert result.returncode == 0, result.stdout

    def path(self, *parts):
        return os.path.join(self.folder, *parts)

    def run_path(self, name, method, *parts):
        return self.path("runs", "144", name, method + "-0", *parts)

    def eth3d(self, command, *arguments, fast=FAST[:2]):
        return run_script("eth3d", command, self.folder, *arguments, *fast)

    def test_1_runs_are_complete_and_recorded(self):
        for name, error in (("office_dslr", "1"), ("office_rig", "0.5")):
            for method in ("colmap", "tapa"):
                record = self.read_json(self.run_path(name, method, "record.json"))
                self.assertEqual((record["set"], record["method"]), (name, method))
                self.assertEqual(record["views"], 4)
                self.assertGreater(record["seconds"]["stereo"], 0)
                self.assertGreater(record["peak_memory_bytes"]["stereo"], 1e6)
                options = " ".join(record["options"])
                self.assertEqual("tapa_plane_distance 0.1" in options, method == "tapa")
                self.assertIn("max_image_size 144", options)
                fusions = [line for line in self.read(self.run_path(
                    name, method, "fusion.log")).splitlines() if line.startswith("$")]
                self.assertIn(f"max_reproj_error {error} --StereoFusion.max_normal_error 20",
                              fusions[0])
                self.assertNotIn("max_reproj_error", fusions[1])
        points, _ = point_clouds.read_ply(self.run_path("office_dslr", "tapa", "fused.ply"))
        self.assertGreater(len(points), 100)

    def test_3_evaluator_of_eth3d(self):
        # It stands in for ETH3D's program, and prints its lines.
        evaluator = self.path("evaluator")
        with open(evaluator, "w", encoding="utf-8") as file:
            file.write("#!/bin/sh\necho \"$@\" >> " + self.path("calls") + "\n"
                       "echo Tolerances: 0.01 0.02 0.05 0.1 0.2 0.5\n"
                       "echo Completenesses: 0.1 0.2 0.3 0.4 0.5 0.6\n"
                       "echo Accuracies: 0.2 0.3 0.4 0.5 0.6 0.7\n"
                       "echo F1-scores: 0.15 0.25 0.35 0.45 0.55 0.65\n")
        os.chmod(evaluator, stat.S_IRWXU)
        result = self.eth3d("evaluate", "--resolution", "both", *METHODS, "--eth3d_evaluator",
                            evaluator)
        self.assert_done(result)
        calls = self.read(self.path("calls")).splitlines()
        self.assertEqual(len(calls), 12)  # Two scenes, methods; three clouds.
        self.assertIn("--tolerances 0.01,0.02,0.05,0.1,0.2,0.5", calls[0])
        self.assertIn("scans/scan_alignment.mlp", calls[0])
        for name in ("office_dslr", "office_rig"):
            for method in ("colmap", "tapa"):
                path = self.run_path(name, method, "cloud_scores.json")
                scores = self.read_json(path)
                self.assertEqual(scores["fused_default"]["f1"][1], 0.25)
                os.remove(path)
                depth = self.read_json(self.run_path(name, method, "depth_scores.json"))
                self.assertEqual(depth["overall"]["num_maps"], 4)
                self.assertGreater(depth["overall"]["num_measurements"], 1000)

    def test_4_scores(self):
        self.assert_done(self.eth3d("evaluate", *METHODS))
        for method in ("colmap", "tapa"):
            scores = self.read_json(self.run_path("office_dslr", method, "cloud_scores.json"))
            for name in ("fused", "fused_default"):
                f1 = scores[name]["f1"]
                self.assertEqual(f1, sorted(f1))
                # Rough depth maps, but in the right place and of the right size.
                self.assertGreater(scores[name]["accuracy"][-1], 0.8)
                self.assertGreater(f1[-1], 0.3)

    def test_4_scans_are_a_perfect_reconstruction(self):
        # In the photographs' frame, by the poses in the MeshLab project.
        project = self.path("scenes", "office", "dslr_scan_eval", "scan_alignment.mlp")
        scans = meshlab_project.read(project)
        self.assertEqual([os.path.basename(path) for path, _ in scans],
                         ["scan1.ply", "scan2.ply", "scan3.ply"])
        cloud = self.path("perfect.ply")
        point_clouds.write_ply(cloud, merge_scans(
            [LaserScan(point_clouds.read_ply(path)[0], pose) for path, pose in scans]))
        result = run_script("evaluate_point_cloud", "--tolerances", "0.001,0.02",
                            "--reconstruction_ply_path", cloud, "--ground_truth_mlp_path", project)
        self.assert_done(result)
        values = re.search(r"F1-scores: ([0-9.]+) ([0-9.]+)", result.stdout)
        self.assertGreater(float(values[1]), 0.999, result.stdout)
        self.assertGreater(float(values[2]), 0.999, result.stdout)

    def test_5_submission(self):
        result = self.eth3d("submit", "--method", "tapa")
        self.assert_done(result)
        folder = self.path("submission", "tapa-144", "high_res_multi_view")
        self.assertIn(folder + ".7z", result.stdout.splitlines())
        self.assertIn("without 24 of the benchmark's scenes", result.stdout)
        self.assertEqual(sorted(os.listdir(folder)), ["office.ply", "office.txt"])
        record = self.read_json(self.run_path("office_dslr", "tapa", "record.json"))
        seconds = record["seconds"]["stereo"] + record["seconds"]["fused"]
        self.assertEqual(self.read(folder, "office.txt"), f"runtime {seconds:.3f}\n")
        self.assertTrue(os.path.exists(folder + ".7z"))
        # A run that is not there: no archive.
        result = self.eth3d("submit", "--method", "paper")
        self.assert_failed(result, "office_dslr", "has no run")
        self.assertFalse(os.path.exists(
            self.path("submission", "paper-144", "high_res_multi_view.7z")))

    def test_6_report(self):
        result = self.eth3d("report", "--resolution", "both", *METHODS)
        self.assert_done(result)
        folder = self.path("report", "144")
        pages = [self.read(folder, name) for name in ("report.md", "office_dslr.md",
                                                      "office_rig.md")]
        for name in ("office_dslr.md", "office_rig.md"):
            self.assertIn(f"({name})", pages[0])
        for page in pages:
            links = re.findall(r"\]\(([^)]*)\)", page)
            self.assertGreater(len(links), 2)
            for link in links:
                self.assertTrue(os.path.isfile(os.path.join(folder, link)), link)
        # The same to open in a browser, with the points of the scene to turn.
        html = [self.read(folder, name) for name in ("report.html", "office_dslr.html")]
        self.assertIn('href="office_dslr.html"', html[0])
        self.assertIn("THREE", html[1])
        # A photograph with the maps of both methods.
        self.assertIn("**dslr_images_undistorted/DSC_", pages[1])
        # The mean over this one scene, of which the other methods have not been run.
        rows = csv.DictReader(self.read(folder, "tables", "table2_paper_fused.csv").splitlines())
        own = {(row["method"], row["tolerance"]): row["f1"] for row in rows
               if row["figures"] == "own"}
        scores = self.read_json(self.run_path("office_dslr", "colmap", "cloud_scores.json"))
        self.assertAlmostEqual(float(own["colmap", "0.02"]), scores["fused"]["f1"][1])
        self.assertEqual(own["paper", "0.02"], "")

    def test_7_a_scene_that_fails_does_not_stop_the_others(self):
        result = run_script("eth3d", "miniature", self.folder, "--scene", "broken",
                            "--image_size", "96", "--views", "3")
        self.assert_done(result)
        photograph = self.path("scenes/broken/images/dslr_images_undistorted/DSC_0101.JPG")
        with open(photograph, "wb") as file:
            file.write(b"no photograph")
        self.assert_done(run_script("eth3d", "prepare", self.folder, "--scenes", "broken"))
        shutil.rmtree(self.run_path("office_dslr", "colmap"))
        result = run_script("eth3d", "run", self.folder, "--methods", "colmap", *FAST)
        self.assert_failed(result, "1 of 2 failed", "144/broken_dslr/colmap-0")
        # "broken" comes first in the alphabet.
        self.assertTrue(os.path.exists(self.run_path("office_dslr", "colmap", "fused.ply")))
        record = self.read_json(self.run_path("broken_dslr", "colmap", "record.json"))
        self.assertIsNotNone(record["failed"])
        result = self.eth3d("evaluate", "--methods", "colmap", "--scenes", "broken")
        self.assert_failed(result, "it is not complete", "scripts/eth3d run")
        shutil.rmtree(self.path("sets", "broken_dslr"))

    def test_8_wrong_words(self):
        for words, text in ((("run", "--methods", "plane"), "no method plane"),
                            (("run", "--scenes", "attic"), "no scene attic"),
                            (("evaluate", "--eth3d_evaluator", "/nowhere"), "is no program"),
                            (("submit", "--seeds", "0,1"), "one seed"),
                            (("submit", "--method", "plane"), "no method plane")):
            with self.subTest(words=words):
                self.assert_failed(self.eth3d(*words), text)

    def test_9_others_are_kept_out(self):
        with files.lock(self.folder, "eth3d-run"):
            self.assert_failed(self.eth3d("run", "--methods", "colmap"),
                               f"another eth3d-run is at work in {self.folder};")
            self.assert_done(self.eth3d("run", "--methods", "colmap", "--dry_run", fast=FAST))


if __name__ == "__main__":
    unittest.main()
