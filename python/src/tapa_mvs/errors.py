"""What the package raises."""

import contextlib

from .evaluation.processes import Failure


class Error(RuntimeError):
    """Something went wrong. The text is what the program colmap would print."""


@contextlib.contextmanager
def failures_as_errors():
    try:
        yield
    except Failure as failure:
        raise Error(str(failure)) from failure
