"""The Python package against the program, on small workspaces."""

import logging
import os
import re
import shutil
import signal
import subprocess
import sys
import textwrap
import threading
import time
import unittest

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../end_to_end"))
import tiny_workspace as tiny  # noqa: E402

import tapa_mvs  # noqa: E402

FAST = tiny.FAST
# It would take minutes.
SLOW = {"num_iterations": 1000, "window_radius": 15}


def program_error(result):
    """The line of the program's that says what is wrong, without its beginning."""
    lines = [line for line in result.stdout.splitlines() if line.startswith("ERROR: ")]
    return lines[0].removeprefix("ERROR: ")


def run_fusion(workspace, output_path, **options):
    """With the program."""
    command = [tiny.COLMAP, "stereo_fusion", "--workspace_path", workspace, "--output_path",
               output_path]
    for name, value in options.items():
        command += ["--StereoFusion." + name, str(value)]
    return tiny.run(command)


class TestCase(tiny.TestCase):

    def setUp(self):
        super().setUp()
        self.names = tiny.make_workspace(self.folder)

    def copy(self):
        """Another workspace with the same photographs."""
        tiny.make_workspace(self.path("copy"))
        return self.path("copy")

    def run_elsewhere(self, code):
        """Starts Python code in a process of its own."""
        return subprocess.Popen(
            [sys.executable, "-B", "-u", "-c", textwrap.dedent(code), self.folder],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


class Stereo(TestCase):

    def test_files_are_those_of_the_program(self):
        for options in ({}, {"tapa": True, "write_consistency_graph": True},
                        {"geom_consistency": False, "seed": 3}):
            with self.subTest(**options):
                copy = self.copy()
                self.assert_success(tiny.run_stereo(copy, **{
                    name: int(value) for name, value in options.items()}))
                tapa_mvs.patch_match_stereo(self.folder, {**FAST, **options})
                self.assert_same_files(tiny.snapshot(copy), tiny.snapshot(self.folder))
                shutil.rmtree(copy)
                shutil.rmtree(self.path("stereo"))
                tiny.make_config(self.folder, self.names)

    def test_progress_never_falls_and_ends_with_all(self):
        news = []
        tapa_mvs.patch_match_stereo(self.folder, FAST, lambda *args: news.append(args))
        shares = [share for share, _ in news]
        self.assertEqual(shares, sorted(shares))
        self.assertEqual(shares[-1], 1)
        self.assertTrue(all(0 <= share <= 1 and isinstance(text, str) and text
                            for share, text in news))
        self.assertTrue(any("geometric" in text for _, text in news), news)
        # With nothing to do.
        news.clear()
        tapa_mvs.patch_match_stereo(self.folder, FAST, lambda *args: news.append(args))
        self.assertEqual(news, [(1.0, "complete")])

    def test_what_the_program_prints_is_logged(self):
        with self.assertLogs("tapa_mvs", logging.INFO) as logs:
            tapa_mvs.patch_match_stereo(self.folder, FAST)
        text = "\n".join(logs.output)
        self.assertIn("Configuration has 4 views", text)
        self.assertIn("Seconds per megapixel and view", text)

    def test_other_threads_go_on(self):
        ticks = []
        end = threading.Event()

        def tick():
            while not end.wait(0.001):
                ticks.append(True)

        ticker = threading.Thread(target=tick)
        ticker.start()
        tapa_mvs.patch_match_stereo(self.folder, {**FAST, "num_iterations": 8})
        end.set()
        ticker.join()
        self.assertGreater(len(ticks), 20)

    def test_one_run_at_a_time(self):
        refused = []

        def start_another(share, _):
            if share == 1:
                return  # It has ended.
            with self.assertRaisesRegex(tapa_mvs.Error, "Another run is going on"):
                tapa_mvs.patch_match_stereo(self.folder, FAST)
            refused.append(True)

        tapa_mvs.patch_match_stereo(self.folder, {**FAST, "num_iterations": 50}, start_another)
        self.assertTrue(refused)


class Stopping(TestCase):

    def undisturbed(self):
        copy = self.copy()
        self.assert_success(tiny.run_stereo(copy, num_iterations=8))
        files = tiny.snapshot(copy)
        shutil.rmtree(copy)
        return files

    def check_goes_on(self, exception, stop):
        expected = self.undisturbed()
        options = {**FAST, "num_iterations": 8}

        def progress(share, _):
            if share > 0.4:
                stop()

        with self.assertRaises(exception):
            tapa_mvs.patch_match_stereo(self.folder, options, progress)
        # What is there is whole, and is kept.
        maps = {name: content for name, content in tiny.snapshot(self.folder).items()
                if name.endswith(".photometric.bin")}
        self.assertTrue(maps)
        for name, content in maps.items():
            self.assertEqual(content, expected[name], name)
        path = self.path("stereo", min(maps))
        age = os.stat(path).st_mtime_ns
        tapa_mvs.patch_match_stereo(self.folder, options)
        self.assertEqual(os.stat(path).st_mtime_ns, age)
        self.assert_same_files(expected, tiny.snapshot(self.folder))

    def test_goes_on_after_interrupt(self):
        self.check_goes_on(KeyboardInterrupt, lambda: os.kill(os.getpid(), signal.SIGINT))

    def test_goes_on_after_exception_of_progress(self):
        def stop():
            raise LookupError("enough")
        self.check_goes_on(LookupError, stop)

    def test_interrupt_ends_within_a_second(self):
        for during in ("start", "sweep"):
            with self.subTest(during=during):
                process = self.run_elsewhere(f"""
                    import sys, tapa_mvs
                    print("at start")
                    try:
                        tapa_mvs.patch_match_stereo(
                            sys.argv[1], {SLOW}, lambda share, text: print("at sweep"))
                    except KeyboardInterrupt:
                        print("interrupted")
                    """)
                while f"at {during}" not in process.stdout.readline():
                    self.assertIsNone(process.poll())
                time.sleep(0.1)
                begin = time.monotonic()
                process.send_signal(signal.SIGINT)
                while process.stdout.readline() != "interrupted\n":
                    self.assertIsNone(process.poll())
                self.assertLess(time.monotonic() - begin, 1)
                process.communicate()
                self.assertEqual(process.returncode, 0)
                self.assertEqual(os.listdir(self.path("stereo", "depth_maps")), [])

    def test_own_handler_of_signals_stays(self):
        received = []
        old = signal.signal(signal.SIGINT, lambda number, _: received.append(number))
        self.addCleanup(signal.signal, signal.SIGINT, old)

        def progress(*_):
            if not received:
                os.kill(os.getpid(), signal.SIGINT)

        tapa_mvs.patch_match_stereo(self.folder, FAST, progress)
        self.assertEqual(received, [signal.SIGINT])
        self.assertTrue(os.path.exists(tiny.map_path(self.folder, self.names[-1])))

    def test_fusion_can_be_stopped(self):
        process = self.run_elsewhere(f"""
            import sys, tapa_mvs
            tapa_mvs.patch_match_stereo(sys.argv[1], {FAST})
            print("at fusion")
            try:
                while True:
                    tapa_mvs.stereo_fusion(sys.argv[1], sys.argv[1] + "/fused.ply")
            except KeyboardInterrupt:
                print("interrupted")
            """)
        while "at fusion" not in process.stdout.readline():
            self.assertIsNone(process.poll())
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        output, _ = process.communicate(timeout=10)
        self.assertEqual((process.returncode, output), (0, "interrupted\n"))


class Errors(TestCase):

    def assert_same_error(self, result, function, *arguments):
        """The program's one line is the text of the exception."""
        with self.assertRaises(tapa_mvs.Error) as caught:
            function(*arguments)
        self.assertEqual(str(caught.exception), program_error(result))
        self.assertIsInstance(caught.exception, RuntimeError)

    def test_errors_are_those_of_the_program(self):
        nowhere = self.path("nowhere")
        self.assert_same_error(tiny.run_stereo(nowhere), tapa_mvs.patch_match_stereo, nowhere)
        self.assert_same_error(
            tiny.run_stereo(self.folder, window_radius=100), tapa_mvs.patch_match_stereo,
            self.folder, {"window_radius": 100})
        points = self.path("fused.ply")
        self.assert_same_error(run_fusion(self.folder, points), tapa_mvs.stereo_fusion,
                               self.folder, points)
        self.assertFalse(os.path.exists(points))

    def test_failed_check_does_not_end_python(self):
        tapa_mvs.patch_match_stereo(self.folder, FAST)
        good = self.path("fused.ply")
        tapa_mvs.stereo_fusion(self.folder, good)
        photograph = self.path("images", self.names[1])
        with open(photograph, "rb") as file:
            content = file.read()
        with open(photograph, "wb") as file:
            file.write(content[:len(content) // 2])
        points = self.path("points.ply")
        result = run_fusion(self.folder, points, agreement=0)
        self.assertEqual(result.returncode, 1, result.stdout)
        for options in ({"agreement": False}, {"agreement": False, "use_cache": True},
                        {"agreement": False, "min_num_pixels": -1}):
            with self.subTest(**options):
                with self.assertRaisesRegex(tapa_mvs.Error, "Fusion failed"):
                    tapa_mvs.stereo_fusion(self.folder, points, options)
                self.assertFalse(os.path.exists(points))
        # All goes on.
        with open(photograph, "wb") as file:
            file.write(content)
        tapa_mvs.stereo_fusion(self.folder, points)
        with open(good, "rb") as expected, open(points, "rb") as actual:
            self.assertEqual(expected.read(), actual.read())

    def test_options_that_cannot_be_used(self):
        for options, error, text in (
                ({"max_image_sise": 100}, ValueError, "did you mean 'max_image_size'"),
                ({"PatchMatchStereo.tapa": True}, ValueError, "did you mean 'tapa'"),
                ({"max_image_size": "100"}, TypeError, "'max_image_size' is '100', but must be a "
                                                       "whole number"),
                ({"max_image_size": 1e3}, TypeError, "a whole number"),
                ({"max_image_size": True}, TypeError, "a whole number"),
                ({"max_image_size": 2**40}, TypeError, "a whole number"),
                ({"depth_min": "1"}, TypeError, "a number"),
                ({"tapa": 2}, TypeError, "True or False"),
                ({"tapa": "yes"}, TypeError, "True or False"),
                ({"gpu_index": 0}, TypeError, "text")):
            with self.subTest(**options):
                with self.assertRaisesRegex(error, text):
                    tapa_mvs.patch_match_stereo(self.folder, options)
        for keyword in ("workspace_format", "input_type"):
            with self.assertRaisesRegex(ValueError, keyword):
                tapa_mvs.stereo_fusion(self.folder, self.path("p.ply"), **{keyword: "other"})

    def test_numbers_of_numpy_are_numbers(self):
        tapa_mvs.patch_match_stereo(self.folder, {
            **FAST, "max_image_size": np.int64(60), "depth_min": np.float32(1),
            "depth_max": 20, "geom_consistency": np.bool_(False)})
        depth = tapa_mvs.read_depth_map(self.folder, self.names[0], "photometric")
        self.assertEqual(depth.shape, (40, 60))


class Options(unittest.TestCase):

    def test_options_are_those_of_the_command_line(self):
        for command, options in (
                ("patch_match_stereo", tapa_mvs.stereo_options()),
                ("stereo_fusion", tapa_mvs.fusion_options())):
            with self.subTest(command=command):
                text = tiny.run([tiny.COLMAP, command, "--help"]).stdout
                names = re.findall(r"--(?:PatchMatchStereo|StereoFusion)\.(\w+)", text)
                self.assertEqual(sorted(options), sorted(set(names)))
        self.assertIs(tapa_mvs.stereo_options()["tapa"], False)
        self.assertEqual(tapa_mvs.stereo_options()["gpu_index"], "-1")
        self.assertIs(type(tapa_mvs.fusion_options()["cache_size"]), float)


class Fusion(TestCase):

    def test_points_are_those_of_the_program(self):
        tapa_mvs.patch_match_stereo(self.folder, {**FAST, "num_iterations": 4})
        with open(self.path("box.txt"), "w") as file:
            file.write("-1 -1 0\n0.5 1 10\n")
        sizes = set()
        for options, more in (({}, {}), ({"agreement_threshold": 0.5}, {}),
                              ({}, {"bbox_path": self.path("box.txt")})):
            with self.subTest(**options, **more):
                there, here = self.path("there.ply"), self.path("here.ply")
                command = [tiny.COLMAP, "stereo_fusion", "--workspace_path", self.folder,
                           "--output_path", there]
                for name, value in options.items():
                    command += ["--StereoFusion." + name, str(value)]
                for name, value in more.items():
                    command += ["--" + name, value]
                self.assert_success(tiny.run(command))
                tapa_mvs.stereo_fusion(self.folder, here, options, **more)
                for end in ("", ".vis"):
                    with open(there + end, "rb") as expected, open(here + end, "rb") as actual:
                        self.assertEqual(expected.read(), actual.read())
                sizes.add(os.path.getsize(here))
        self.assertEqual(len(sizes), 3)


class Maps(TestCase):

    def setUp(self):
        super().setUp()
        tapa_mvs.patch_match_stereo(self.folder, {
            **FAST, "max_image_size": 60, "write_consistency_graph": True})
        tapa_mvs.stereo_fusion(self.folder, self.path("fused.ply"))
        self.name = self.names[1]

    def test_values_are_those_of_the_files(self):
        for kind in (None, "geometric", "photometric"):
            which = kind or "geometric"
            depth = tapa_mvs.read_depth_map(self.folder, self.name, kind)
            normals = tapa_mvs.read_normal_map(self.folder, self.name, kind)
            width, height, values = tiny.read_map(
                tiny.map_path(self.folder, self.name, which=which))
            self.assertEqual(depth.shape, (height, width))
            self.assertEqual(depth.ravel().tolist(), list(values))
            *_, values = tiny.read_map(
                tiny.map_path(self.folder, self.name, "normal_maps", which))
            self.assertEqual(normals.shape, (height, width, 3))
            self.assertEqual(np.moveaxis(normals, 2, 0).ravel().tolist(), list(values))
            for array in (depth, normals):
                self.assertEqual(array.dtype, np.float32)
                self.assertTrue(array.flags.writeable and array.flags.c_contiguous)

    def test_confidence(self):
        depth = tapa_mvs.read_depth_map(self.folder, self.name)
        points = tapa_mvs.read_confidence_map(self.folder, self.name)
        graphs = tapa_mvs.read_confidence_map(self.folder, self.name, source="graphs")
        for confidence in (points, graphs):
            self.assertEqual((confidence.shape, confidence.dtype), (depth.shape, np.float32))
            self.assertTrue((confidence[depth == 0] == 0).all())
            self.assertGreater(np.median(confidence[depth > 0]), 0.5)
        self.assertTrue((graphs[depth > 0] >= 1).all())
        self.assertFalse(np.array_equal(points, graphs))
        # Not what it was when the points have changed.
        os.remove(self.path("fused.ply"))
        self.assertTrue(np.array_equal(
            tapa_mvs.read_confidence_map(self.folder, self.name), graphs))
        shutil.rmtree(self.path("stereo", "consistency_graphs"))
        with self.assertRaisesRegex(tapa_mvs.Error, "neither fused points"):
            tapa_mvs.read_confidence_map(self.folder, self.name)

    def test_maps_that_are_not_there(self):
        for function in (tapa_mvs.read_depth_map, tapa_mvs.read_normal_map,
                         tapa_mvs.read_confidence_map):
            with self.assertRaisesRegex(tapa_mvs.Error, "other.png.geometric.bin cannot be read"):
                function(self.folder, "other.png")
            with self.assertRaisesRegex(ValueError, "input_type"):
                function(self.folder, self.name, "other")
        with open(tiny.map_path(self.folder, self.name), "r+b") as file:
            file.truncate(100)
        with self.assertRaisesRegex(tapa_mvs.Error, "truncated"):
            tapa_mvs.read_depth_map(self.folder, self.name)


if __name__ == "__main__":
    unittest.main()
