"""A run that was stopped goes on, and ends with the same files."""

import os
import random
import signal
import subprocess
import time
import unittest

import tiny_workspace as tiny


class StereoTestCase(tiny.TestCase):

    def setUp(self):
        super().setUp()
        self.names = tiny.make_workspace(self.folder)

    def undisturbed(self, **options):
        """Files of a run in a workspace of its own."""
        tiny.make_workspace(self.path("undisturbed"))
        self.assert_success(tiny.run_stereo(self.path("undisturbed"),
                                            **options))
        return tiny.snapshot(self.path("undisturbed"))

    def assert_same_files(self, expected, actual):
        self.assertEqual(sorted(expected), sorted(actual))
        different = [name for name in expected
                     if expected[name] != actual[name]]
        self.assertEqual(different, [])


class Resume(StereoTestCase):

    def start(self, **options):
        return subprocess.Popen(
            tiny.stereo_command(self.folder, **options),
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def wait_for_output(self, process, text):
        for line in process.stdout:
            if text in line:
                return
        self.fail("the program ended early")

    def test_killed_at_random_moments(self):
        options = {"num_iterations": 4, "write_consistency_graph": 1}
        expected = self.undisturbed(**options)
        rng = random.Random(5)
        for _ in range(12):
            process = self.start(**options)
            time.sleep(rng.uniform(0, 0.6))
            process.send_signal(rng.choice([signal.SIGKILL, signal.SIGINT,
                                            signal.SIGTERM]))
            process.communicate()
            # What is there under its name is whole.
            for name, content in tiny.snapshot(self.folder).items():
                if name.endswith(".bin"):
                    self.assertEqual(content, expected[name], name)
        self.assert_success(tiny.run_stereo(self.folder, **options))
        self.assert_same_files(expected, tiny.snapshot(self.folder))

    def test_interrupts_end_in_order_within_a_second(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(signal=number):
                # It would take minutes.
                process = self.start(num_iterations=1000, window_radius=15)
                self.wait_for_output(process, "Configuration has")
                time.sleep(1)
                begin = time.monotonic()
                process.send_signal(number)
                output, _ = process.communicate()
                self.assertLess(time.monotonic() - begin, 1)
                self.assertEqual(process.returncode, 128 + number)
                self.assertNotIn("ERROR", output)
                self.assertIn("start it again to go on", output)
                self.assertEqual(
                    os.listdir(self.path("stereo", "depth_maps")), [])

    def test_two_at_once(self):
        """The second one leaves the first alone, which ends as if it had been."""
        options = {"num_iterations": 30, "num_levels": 2}
        expected = self.undisturbed(**options)
        first = self.start(**options)
        self.wait_for_output(first, "Configuration has")
        for _ in range(3):
            self.assert_one_error(tiny.run_stereo(self.folder, **options),
                                  "Another run is at work in " + self.folder)
        self.assertIsNone(first.poll(), "it ended before the second one began")
        first.communicate()
        self.assertEqual(first.returncode, 0)
        self.assert_same_files(expected, tiny.snapshot(self.folder))
        # Killed, it keeps nobody out.
        tiny.make_workspace(self.path("other"))
        other = subprocess.Popen(tiny.stereo_command(self.path("other"), **options),
                                 stdout=subprocess.PIPE, text=True)
        self.wait_for_output(other, "Configuration has")
        other.kill()
        other.communicate()
        self.assert_success(tiny.run_stereo(self.path("other"), **options))

    def test_finished_run_is_not_repeated(self):
        self.assert_success(tiny.run_stereo(self.folder))
        times = [os.stat(tiny.map_path(self.folder, name)).st_mtime_ns
                 for name in self.names]
        result = tiny.run_stereo(self.folder)
        self.assert_success(result)
        self.assertNotIn("megapixels in", result.stdout)
        self.assertEqual(times, [
            os.stat(tiny.map_path(self.folder, name)).st_mtime_ns
            for name in self.names])

    def test_lost_maps_are_made_again(self):
        self.assert_success(tiny.run_stereo(self.folder))
        expected = tiny.snapshot(self.folder)
        os.remove(tiny.map_path(self.folder, self.names[1]))
        os.remove(tiny.map_path(self.folder, self.names[2], "normal_maps",
                                "photometric"))
        self.assert_success(tiny.run_stereo(self.folder))
        self.assert_same_files(expected, tiny.snapshot(self.folder))


class SameFiles(StereoTestCase):
    """What the maps do not depend on."""

    def test_number_of_threads(self):
        expected = self.undisturbed(num_iterations=2)
        for threads in (1, 2, 3):
            with self.subTest(threads=threads):
                workspace = self.path("threads%d" % threads)
                tiny.make_workspace(workspace)
                self.assert_success(tiny.run_stereo(
                    workspace, num_iterations=2, num_threads=threads))
                self.assert_same_files(expected, tiny.snapshot(workspace))

    def test_order_of_views_and_cache(self):
        expected = self.undisturbed()
        tiny.make_config(self.folder, self.names[::-1])
        expected.pop("patch-match.cfg")
        expected.pop("fusion.cfg")
        self.assert_success(tiny.run_stereo(self.folder, cache_size=1e-5))
        actual = tiny.snapshot(self.folder)
        actual.pop("patch-match.cfg")
        actual.pop("fusion.cfg")
        self.assert_same_files(expected, actual)

    def test_seed_matters(self):
        expected = self.undisturbed()
        self.assert_success(tiny.run_stereo(self.folder, seed=1))
        actual = tiny.snapshot(self.folder)
        name = "depth_maps/view0.png.photometric.bin"
        self.assertNotEqual(expected[name], actual[name])


if __name__ == "__main__":
    unittest.main()
