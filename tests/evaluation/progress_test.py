"""What a user sees while a program is at work."""

import contextlib
import io
import time
import unittest
from unittest import mock

from helpers import TestCase
from evaluation import progress

_LINE = " 58.3 %  0:04:03 to go  geometric 2/12 room_01.jpg"


class Terminal(io.StringIO):
    def isatty(self):
        return True


class FollowerTest(TestCase):
    def shown(self, text, stream):
        """What is shown of a log to which text is added."""
        log = self.path("log")
        with open(log, "w", encoding="utf-8") as file:
            file.write(" 99.0 %  0:00:01 to go  of the command before\n")
        with mock.patch.multiple(progress, _INTERVAL=0.01, _TERMINAL_INTERVAL=0.01), \
                contextlib.redirect_stderr(stream), progress.Follower(log):
            with open(log, "a", encoding="utf-8") as file:
                file.write(text)
            deadline = time.monotonic() + 10
            while "to go" in text and not stream.getvalue() and time.monotonic() < deadline:
                time.sleep(0.01)
            time.sleep(0.1)  # Would show it again.
        return stream.getvalue()

    def test_lines_elsewhere(self):
        text = f" 50.0 %  0:05:00 to go  before\n{_LINE}: 0.35 megapixels in 29.7 s\nWARNING: x\n"
        self.assertEqual(_LINE + "\n", self.shown(text, io.StringIO()))

    def test_one_line_on_a_terminal(self):
        text = self.shown(f"{_LINE}: 1 %", Terminal())
        self.assertTrue(text.startswith(f"\r\033[K{_LINE}\r"), text)
        self.assertTrue(text.endswith("\r\033[K"), text)

    def test_other_output_is_not_shown(self):
        self.assertEqual("", self.shown("Loading scan: 50 % of it\n", io.StringIO()))


class EachTest(unittest.TestCase):
    def shown(self, stream, interval):
        with mock.patch.multiple(progress, _INTERVAL=interval, _TERMINAL_INTERVAL=interval), \
                contextlib.redirect_stderr(stream):
            self.assertEqual([1, 2, 3], list(progress.each([1, 2, 3], "counting",
                                                           lambda item: f"view {item}")))
        return stream.getvalue()

    def test_lines_elsewhere(self):
        self.assertEqual(" 33.3 %  0:00:00 to go  counting 2/3 view 2\n"
                         " 66.7 %  0:00:00 to go  counting 3/3 view 3\n",
                         self.shown(io.StringIO(), 0))

    def test_one_line_on_a_terminal(self):
        text = self.shown(Terminal(), 0)
        self.assertEqual(2, text.count("\r\033[K "), text)
        self.assertTrue(text.endswith("\r\033[K"), text)

    def test_nothing_where_it_is_fast(self):
        self.assertEqual("", self.shown(io.StringIO(), 60) + self.shown(Terminal(), 60))


if __name__ == "__main__":
    unittest.main()
