"""A picture of a page, as a browser without a screen shows it."""

import os
import re
import shutil
import subprocess
import tempfile
import urllib.parse

from ..processes import Failure

_NAMES = ("chromium", "chromium-browser", "google-chrome")
_CONSOLE = re.compile(r":CONSOLE[(:]\d+\)?\] (.*)")


def find():
    """Path of a browser, None if there is none."""
    return next(filter(None, map(shutil.which, _NAMES)), None)


def take_picture(page, picture, width=1300, height=900):
    """Writes a PNG of the top of a page. Returns the lines of the browser's console.

    It takes long without a GPU, but waits until the page has drawn.
    """
    program = find()
    if program is None:
        raise Failure("there is no browser; as root, run: apt-get install chromium")
    with tempfile.TemporaryDirectory(prefix="tapa-browser-") as profile:
        options = ["--headless", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                   f"--user-data-dir={profile}", "--enable-logging=stderr", "--hide-scrollbars",
                   f"--window-size={width},{height}", "--virtual-time-budget=10000",
                   f"--screenshot={os.path.abspath(picture)}"]
        if os.geteuid() == 0:
            options.append("--no-sandbox")  # It refuses to run as root with one.
        try:
            result = subprocess.run(
                [program, *options, "file://" + urllib.parse.quote(os.path.abspath(page))],
                stdin=subprocess.DEVNULL, capture_output=True, timeout=300, check=False,
                text=True, errors="replace")
        except subprocess.TimeoutExpired as error:
            raise Failure(f"{program} has not shown {page} within 5 minutes") from error
    if result.returncode != 0 or not os.path.exists(picture):
        raise Failure(f"{program} could not show {page}")
    return [match[1] for match in map(_CONSOLE.search, result.stderr.splitlines()) if match]
