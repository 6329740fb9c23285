"""Fetches ETH3D's archives: resumes, verifies, unpacks.

An archive is fetched by curl to NAME.part, and is called NAME when it has the size that
the site tells and 7z finds no fault in it. NAME.unpacked says that it was unpacked.
"""

import os
import shutil
import sys
import urllib.request

from .. import files, processes
from ..processes import Failure
from ..steps import Step
from .scenes import BASE_URL

TIMEOUT = 60  # Seconds without an answer.


class Unpack(Step):
    """An archive, fetched, verified and unpacked. size: bytes, None while not asked."""

    def __init__(self, archive, base_url, folder, out, remove_archive=False):
        self.name = archive
        self.url = f"{base_url}/{archive}"
        self.size = None
        self.path = os.path.join(folder, archive)
        self._part = self.path + ".part"
        self._marker = self.path + ".unpacked"
        self._out = out
        self._remove_archive = remove_archive

    def is_done(self):
        return os.path.exists(self._marker)

    def bytes_left(self):
        return max(0, self.size - max(_size_of(self.path), _size_of(self._part)))

    def ask_size(self):
        """Asks the site how large the archive is."""
        request = urllib.request.Request(self.url, method="HEAD")
        try:
            with urllib.request.urlopen(request, timeout=TIMEOUT) as answer:
                length = answer.headers.get("Content-Length")
        except (OSError, ValueError) as error:
            # An HTTPError is an OSError, too; its text has the status.
            raise Failure(f"{self.url} cannot be had: {error}; see the address or try again "
                          "later") from error
        if length is None:
            raise Failure(f"{self.url}: the site does not say how large it is")
        self.size = int(length)

    def commands(self):
        """Fetch and test what is not there yet, and unpack it."""
        fetch = [["curl", "--fail", "--location", "--silent", "--show-error", "--retry", "5",
                  "--speed-limit", "1", "--speed-time", str(TIMEOUT), "--continue-at", "-",
                  "--output", self._part, self.url],
                 [seven_zip(), "t", "-bd", self._part]]
        return [*([] if os.path.exists(self.path) else fetch),
                [seven_zip(), "x", "-bd", "-y", "-aoa", "-o" + self._out, self.path]]

    def run(self):
        os.makedirs(os.path.dirname(self.path), exist_ok=True)
        os.makedirs(self._out, exist_ok=True)
        log = self.path + ".log"
        *fetch, unpack = self.commands()
        if fetch:
            self._fetch(*fetch, log)
        processes.run(unpack, log)
        files.write_text(self._marker, f"{self.size}\n")
        os.remove(log)
        if self._remove_archive:
            os.remove(self.path)

    def _fetch(self, fetch, test, log):
        if _size_of(self._part) > self.size:  # Of another version of the archive.
            os.remove(self._part)
        if _size_of(self._part) < self.size:
            processes.run(fetch, log)
        if _size_of(self._part) != self.size:
            raise Failure(f"{self._part} has {_size_of(self._part)} bytes, but the archive "
                          f"{self.size}; try again, or remove it to begin anew")
        try:
            processes.run(test, log)
        except processes.ProgramFailed as error:
            os.remove(self._part)
            raise Failure(f"{self.name} did not arrive whole and was removed; try again "
                          f"({error})") from error
        os.replace(self._part, self.path)


def _size_of(path):
    return os.path.getsize(path) if os.path.exists(path) else 0


def archives_of(scenes, folder, out, base_url=None, with_depth=True, remove_archives=False):
    """Archives of scenes, each once."""
    base = (base_url or BASE_URL).rstrip("/")
    names = dict.fromkeys(name for scene in scenes for name in scene.archives(with_depth))
    return [Unpack(name, base, folder, out, remove_archives) for name in names]


def seven_zip():
    """The name under which 7-Zip is installed."""
    for name in ("7z", "7zz", "7za"):
        if shutil.which(name):
            return name
    raise Failure("7z is not installed; run scripts/install_deps.sh (Debian: apt-get install "
                  "p7zip-full)")


def _gigabytes(size):
    return f"{size / 1e9:.2f} GB" if size >= 1e7 else f"{size / 1e6:.2f} MB"


def confirm(archives, out, yes):
    """Says what would come, and asks. Raises Failure if the answer is no."""
    left = sum(archive.bytes_left() for archive in archives)
    for archive in archives:
        processes.say(f"{archive.name}: {_gigabytes(archive.size)}, "
                      f"{_gigabytes(archive.bytes_left())} to fetch")
    above = os.path.abspath(out)
    while not os.path.isdir(above):
        above = os.path.dirname(above)
    free = shutil.disk_usage(above).free
    processes.say(f"{len(archives)} archives, {_gigabytes(left)} to fetch; depth maps unpack to "
                  f"about ten times as much. {out} has {_gigabytes(free)} free.")
    if left > free:
        raise Failure(f"{out} has only {_gigabytes(free)} free, but {_gigabytes(left)} are to be "
                      "fetched; choose fewer scenes or another folder")
    if yes or left == 0:
        return
    if not sys.stdin.isatty():
        raise Failure(f"{_gigabytes(left)} would be fetched; say --yes to do it")
    sys.stderr.write("Fetch them? [y/N] ")
    sys.stderr.flush()
    if sys.stdin.readline().strip().lower() not in ("y", "yes"):
        raise Failure("nothing was fetched")
