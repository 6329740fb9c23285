"""What the command lines of scripts/evaluate and scripts/eth3d share."""

import argparse
import signal
import sys

from . import processes
from .experiment import check_method


class Parser(argparse.ArgumentParser):
    """Tells errors in one line, and takes options of patch_match_stereo behind --."""

    def __init__(self, **options):
        super().__init__(**options, allow_abbrev=False)

    def error(self, message):
        sys.exit(f"ERROR: {message}; {self.prog} --help explains the options")

    def parse(self, words):
        """What stands behind -- becomes the list options."""
        # argparse cannot tell it from other words.
        end = words.index("--") if "--" in words else len(words)
        arguments = self.parse_args(words[:end])
        arguments.options = words[end + 1:]
        return arguments


def list_of(kind, name, accepts=lambda value: True):
    """A parser of values that are separated by commas; each counts once."""
    def parse(text):
        try:
            values = [kind(word) for word in text.split(",")]
        except ValueError:
            values = []
        if not values or not all(map(accepts, values)):
            raise argparse.ArgumentTypeError(
                f"'{text}' is not a list of {name}, separated by commas")
        return list(dict.fromkeys(values))
    return parse


texts = list_of(str, "names", bool)
whole_numbers = list_of(int, "whole numbers", lambda value: 0 <= value < 1e9)
positive_numbers = list_of(float, "positive numbers", lambda value: 0 < value < 1e9)


def whole_number(least):
    """A parser of one whole number that is not smaller."""
    def parse(text):
        if not (text.isdecimal() and least <= int(text) < 1e9):
            raise argparse.ArgumentTypeError(f"'{text}' is not a whole number from {least} on")
        return int(text)
    return parse


def method(text):
    """A parser of the name of a method."""
    try:
        return check_method(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def methods(text):
    """A parser of the names of methods."""
    return list(map(method, texts(text)))


def run(main):
    """The exit status of a program: what main() returns, unless it fails."""
    # As by Ctrl-C, so that running programs end in order.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    # Ends in silence where nobody reads on, as in "scripts/evaluate ... | head".
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    try:
        return main()
    except (processes.Failure, OSError) as error:
        print(f"ERROR: {error}", file=sys.stderr)
        return 1
    except (KeyboardInterrupt, processes.Interrupted):
        print("ERROR: stopped; the same command goes on from here", file=sys.stderr)
        return 130
