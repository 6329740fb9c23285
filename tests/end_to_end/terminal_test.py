"""On a terminal a line that is renewed in place tells how far the work is; in a log
there are plain lines only."""

import os
import pty
import re
import subprocess
import threading
import unittest

import tiny_workspace as tiny

ERASE = "\r\x1b[K"


def run_on_terminal(command, stdout=None):
    """Runs a command on a terminal of its own; stdout: what takes the output in its
    place. Returns the exit status, and what the terminal received."""
    terminal, end = pty.openpty()
    received = []

    def read():
        try:
            while data := os.read(terminal, 4096):
                received.append(data)
        except OSError:  # Nobody has the other end any more.
            pass

    process = subprocess.Popen(command, stdin=end, stderr=end,
                               stdout=end if stdout is None else stdout)
    os.close(end)
    reader = threading.Thread(target=read)
    reader.start()
    status = process.wait(timeout=300)
    reader.join()
    os.close(terminal)
    return status, b"".join(received).decode()


def left_lines(text):
    """The lines that stay on a terminal."""
    return [line.rpartition(ERASE)[2] for line in text.split("\n")]


class Terminal(tiny.TestCase):

    @unittest.skipIf("TSAN_OPTIONS" in os.environ, "ThreadSanitizer cannot follow OpenMP")
    def test_automatic_reconstructor(self):
        names = ["view%02d.png" % i for i in range(24)]
        tiny.make_images(self.path("photos"), names)
        tiny.make_model(self.path("out", "sparse", "0"), names)
        command = [tiny.COLMAP, "automatic_reconstructor", "--quality", "low",
                   "--image_path", self.path("photos"), "--workspace_path"]
        options = ["--use_gpu", "0"]

        status, shown = run_on_terminal(command + [self.path("out")] + options)
        self.assertEqual(status, 0, shown)
        for name in ("Finding features", "Matching features",
                     "Undistorting photographs"):
            for percent in ("25.0", "50.0", "75.0"):
                self.assertRegex(shown, re.escape(ERASE) + r"\[#+ +\]  " + percent +
                                 r" %  \d:\d\d:\d\d to go  " + name)
        self.assertEqual([], [line for line in left_lines(shown) if "[#" in line])
        lines = [line.rstrip("\r") for line in left_lines(shown)]
        self.assertIn("Processed file [2/24]", lines)
        self.assertIn("Undistorting image [3/24]", lines)

        tiny.make_model(self.path("plain", "sparse", "0"), names)
        result = tiny.run(command + [self.path("plain")] + options)
        self.assert_success(result)
        self.assertNotIn("\x1b", result.stdout)
        self.assertNotIn("\r", result.stdout)
        self.assertIn("\nProcessed file [2/24]\n", result.stdout)

    def test_an_error_stands_on_a_line_of_its_own(self):
        os.mkdir(self.path("photos"))
        for i in range(3):  # In which there is nothing to see.
            tiny.write_png(self.path("photos", "%d.png" % i), 96, 64, bytes(96 * 64))
        status, shown = run_on_terminal(
            [tiny.COLMAP, "automatic_reconstructor", "--image_path", self.path("photos"),
             "--workspace_path", self.folder, "--use_gpu", "0"])
        self.assertEqual(status, 1, shown)
        self.assertIn("Finding features", shown)
        self.assertTrue(any(line.startswith("ERROR: ") for line in left_lines(shown)),
                        shown)

    def test_stereo_into_a_log(self):
        tiny.make_workspace(self.path("workspace"), 3)
        with open(self.path("log"), "wb") as log:
            status, shown = run_on_terminal(
                tiny.stereo_command(self.path("workspace"), num_iterations=60,
                                    window_radius=9, num_threads=1), log)
        self.assertEqual(status, 0, shown)
        self.assertRegex(shown, re.escape(ERASE) + r" *\d+\.\d %  \d:\d\d:\d\d to go  "
                                                   r"photometric \d/3 view\d\.png: \d+ %")
        self.assertEqual("".join(left_lines(shown)), "")
        with open(self.path("log")) as file:
            text = file.read()
        self.assertNotIn("\x1b", text)
        self.assertEqual(text.count(" megapixels in "), 6)


if __name__ == "__main__":
    unittest.main()
