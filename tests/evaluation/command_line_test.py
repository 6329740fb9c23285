"""What the command lines of the evaluation share."""

import argparse
import contextlib
import io
import unittest

import helpers  # noqa: F401 (it finds the package)
from evaluation import command_line, processes


class ParserTest(unittest.TestCase):
    def parser(self):
        parser = command_line.Parser(prog="program")
        commands = parser.add_subparsers()
        commands.add_parser("run").add_argument("--views")
        return parser

    def test_options_of_stereo(self):
        for words, options in ((["run"], []), (["run", "--"], []),
                               (["run", "--views", "1", "--", "--x", "--", "y"],
                                ["--x", "--", "y"])):
            self.assertEqual(self.parser().parse(words).options, options)

    def test_errors_are_one_line(self):
        for words, text in ((["run", "--view", "1"], "--view 1; program --help"),
                            (["run", "--views"], "argument; program run --help"),
                            (["go"], "'go' (choose from 'run'); program --help")):
            with self.assertRaises(SystemExit) as caught:
                self.parser().parse(words)
            self.assertRegex(caught.exception.code, "^ERROR: [^\n]*$")
            self.assertIn(text + " explains the options", caught.exception.code)


class ValuesTest(unittest.TestCase):
    def test_values(self):
        for parse, text, value in (
                (command_line.whole_numbers, "3,0,3", [3, 0]),
                (command_line.positive_numbers, "0.5,1e-3", [0.5, 0.001]),
                (command_line.texts, "b,a", ["b", "a"]),
                (command_line.methods, "tapa,plain", ["tapa", "plain"]),
                (command_line.whole_number(0), "0", 0)):
            self.assertEqual(parse(text), value)

    def test_what_is_none(self):
        for parse, texts in ((command_line.whole_numbers, ("", "1,", "-1", "0.5", "x")),
                             (command_line.positive_numbers, ("0", "nan", "inf", "1,,2")),
                             (command_line.texts, ("", "a,,b")),
                             (command_line.methods, ("", "plain,plane")),
                             (command_line.whole_number(1), ("0", "-1", "", "1.5"))):
            for text in texts:
                with self.assertRaises(argparse.ArgumentTypeError):
                    parse(text)


class RunTest(unittest.TestCase):
    def test_exit_status(self):
        def fails(error):
            def main():
                raise error
            return main

        for main, status, text in (
                (lambda: 3, 3, ""),
                (fails(processes.Failure("no luck")), 1, "ERROR: no luck\n"),
                (fails(PermissionError("not yours")), 1, "ERROR: not yours\n"),
                (fails(KeyboardInterrupt()), 130, "ERROR: stopped; the same command "
                                                  "goes on from here\n")):
            with contextlib.redirect_stderr(io.StringIO()) as errors:
                self.assertEqual(command_line.run(main), status)
            self.assertEqual(errors.getvalue(), text)
