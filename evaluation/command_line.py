"""What the command lines of the scripts share."""

import argparse
import io
import math
import signal
import sys

from . import processes
from .methods import check_method


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
    """A parser of values that are separated by commas."""
    def parse(text):
        try:
            values = [kind(word) for word in text.split(",")]
        except ValueError:
            values = []
        if not values or not all(map(accepts, values)):
            raise argparse.ArgumentTypeError(
                f"'{text}' is not a list of {name}, separated by commas")
        return values
    return parse


def once(parse):
    """A parser of the same values, of which each counts once."""
    return lambda text: list(dict.fromkeys(parse(text)))


texts = once(list_of(str, "names", bool))
whole_numbers = once(list_of(int, "whole numbers", lambda value: 0 <= value < 1e9))
positive_numbers = list_of(float, "positive numbers", lambda value: 0 < value < 1e9)


def number(what, accepts):
    """A parser of one finite number; what: which ones are accepted, in words."""
    def parse(text):
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not (math.isfinite(value) and accepts(value)):
            raise argparse.ArgumentTypeError(f"it must be {what}, not {text}")
        return value
    return parse


positive_number = number("a positive number", lambda value: value > 0)


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


def run(main, advice="the same command goes on from here"):
    """The exit status of a program: what main() returns, unless it fails.

    advice: what to do where the program was stopped.
    """
    # As by Ctrl-C, so that running programs end in order.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    # Ends in silence where nobody reads on, as in "scripts/evaluate ... | head".
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    if isinstance(sys.stdout, io.TextIOWrapper):  # Names of files may be no text.
        sys.stdout.reconfigure(errors="surrogateescape")
    status = 1
    try:
        return main()
    except processes.Failure as error:
        status, text = error.exit_status, error
    except OSError as error:
        text = error
    except MemoryError:
        text = "there is not enough memory (docs/evaluation.md says how much it takes)"
    except (KeyboardInterrupt, processes.Interrupted):
        status, text = 130, f"stopped; {advice}"
    print(f"ERROR: {text}", file=sys.stderr)
    return status
