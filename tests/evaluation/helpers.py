"""What the tests of the package evaluation share; importing this finds it."""

import contextlib
import io
import os
import stat
import sys
import tempfile
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
sys.path.insert(0, ROOT)
import numpy as np  # noqa: E402
from evaluation import command_line, processes, record  # noqa: E402
from evaluation.methods import METHODS  # noqa: E402


class TestCase(unittest.TestCase):
    """A test with a folder of its own, self.folder, in which nothing is said."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="tapa-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.addCleanup(setattr, processes, "say", processes.say)
        processes.say = lambda text: None

    def path(self, *parts):
        return os.path.join(self.folder, *parts)

    def read(self, *parts):
        with open(self.path(*parts), encoding="utf-8") as file:
            return file.read()

    def write(self, name, text="", executable=False):
        """Writes a file, makes the folders above it and returns its path."""
        path = self.path(name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        if executable:
            os.chmod(path, stat.S_IRWXU)
        return path


class ProgramTest(TestCase):
    """Drives the main() of a program, in this process, with the words that it is given."""
    main = None

    def run_main(self, *words):
        """Returns the exit status, and what it printed on both streams."""
        with contextlib.redirect_stdout(io.StringIO()) as out, \
                contextlib.redirect_stderr(io.StringIO()) as errors:
            try:
                status = command_line.run(lambda: type(self).main(list(words)))
            except SystemExit as stop:
                status = stop.code if isinstance(stop.code, int) else 1
                if isinstance(stop.code, str):
                    print(stop.code, file=sys.stderr)
        return status, out.getvalue(), errors.getvalue()

    def run_well(self, *words):
        """Returns what it printed on standard output."""
        status, out, errors = self.run_main(*words)
        self.assertEqual((status, errors), (0, ""))
        return out

    def expect_error(self, words, part, status=1):
        with self.subTest(words=words, part=part):
            result = self.run_main(*words)
            self.assertEqual(result[0], status, result)
            self.assertRegex(result[2], "^ERROR: [^\n]*\n$")
            self.assertIn(part, result[2])


def write_map(path, values):
    """values: (height, width) or (channels, height, width), as they stand in COLMAP's files."""
    values = np.array(values, "<f4")
    channels, height, width = values.shape if values.ndim == 3 else (1, *values.shape)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(b"%d&%d&%d&" % (width, height, channels) + values.tobytes())


def run_step(step):
    """As steps.perform() does, but what fails is raised."""
    if not step.is_done():
        step.run()


def made_with(version="COLMAP 3.8", gpu=None):
    """How a step of a run was made that nobody has run."""
    return {"version": version, "machine": {
        "cpu": "abacus", "cores": 2, "memory_bytes": 8e9, "gpu": gpu}}


def make_record(name="s", method="plain", seed=0, options=(), **values):
    """The record of such a run. values: in place of those here."""
    kind = record.ComparisonRecord if "compare" in values else record.RunRecord
    return kind(**{
        "set": name, "method": method, "seed": seed,
        **({} if "compare" in values else {"sources": 10, "every": 1}),
        "options": ["--PatchMatchStereo.seed", str(seed), *METHODS.get(method, []), *options],
        "fusion_options": {}, "made_with": {"stereo": [made_with()]},
        "views": 4, "image_size": [500, 500], "done": ["stereo"], "failed": None,
        "seconds": {"stereo": 70.0}, "cpu_seconds": {"stereo": 120.0},
        "peak_memory_bytes": {"stereo": 300e6}, **values})
