"""Fetches ETH3D's archives: resumes, verifies, unpacks.

An archive is fetched by curl to NAME.part, and is called NAME when it has the size that
the site tells and 7z finds no fault in it. NAME.unpacked says that it was unpacked.
"""

import os
import shutil
import sys
import urllib.request
from dataclasses import dataclass

from .. import files, processes
from . import scenes as eth3d_scenes
from ..processes import Failure

TIMEOUT = 60  # Seconds without an answer.


@dataclass
class Archive:
    """size: bytes that the site tells, None while it was not asked."""
    name: str
    url: str
    folder: str
    size: int | None = None

    @property
    def path(self):
        return os.path.join(self.folder, self.name)

    @property
    def part(self):
        return self.path + ".part"

    @property
    def marker(self):
        return self.path + ".unpacked"

    @property
    def bytes_left(self):
        for path in (self.path, self.part):
            if os.path.exists(path):
                return max(0, self.size - os.path.getsize(path))
        return self.size


def archives_of(scenes, folder, base_url=None, with_depth=True):
    """Archives of scenes, each once."""
    base = (base_url or eth3d_scenes.BASE_URL).rstrip("/")
    names = dict.fromkeys(name for scene in scenes for name in scene.archives(with_depth))
    return [Archive(name, f"{base}/{name}", folder) for name in names]


def ask_size(archive):
    """Asks the site how large an archive is."""
    request = urllib.request.Request(archive.url, method="HEAD")
    try:
        with urllib.request.urlopen(request, timeout=TIMEOUT) as answer:
            length = answer.headers.get("Content-Length")
    except (OSError, ValueError) as error:
        # An HTTPError is an OSError, too; its text has the status.
        raise Failure(f"{archive.url} cannot be had: {error}; see the address or try again "
                      "later") from error
    if length is None:
        raise Failure(f"{archive.url}: the site does not say how large it is")
    archive.size = int(length)


def seven_zip():
    """The name under which 7-Zip is installed."""
    for name in ("7z", "7zz", "7za"):
        if shutil.which(name):
            return name
    raise Failure("7z is not installed; run scripts/install_deps.sh (Debian: apt-get install "
                  "p7zip-full)")


def gigabytes(size):
    return f"{size / 1e9:.2f} GB" if size >= 1e7 else f"{size / 1e6:.2f} MB"


def fetch_command(archive):
    return ["curl", "--fail", "--location", "--silent", "--show-error", "--retry", "5",
            "--speed-limit", "1", "--speed-time", str(TIMEOUT), "--continue-at", "-",
            "--output", archive.part, archive.url]


def test_command(path):
    return [seven_zip(), "t", "-bd", path]


def unpack_command(archive, out):
    return [seven_zip(), "x", "-bd", "-y", "-aoa", "-o" + out, archive.path]


def commands(archive, out):
    """What get() would run, in order."""
    if os.path.exists(archive.marker):
        return []
    there = os.path.exists(archive.path)
    return [*([] if there else [fetch_command(archive), test_command(archive.part)]),
            unpack_command(archive, out)]


def confirm(archives, out, yes):
    """Says what would come, and asks. Raises Failure if the answer is no."""
    left = sum(archive.bytes_left for archive in archives)
    for archive in archives:
        processes.say(f"{archive.name}: {gigabytes(archive.size)}, "
                      f"{gigabytes(archive.bytes_left)} to fetch")
    free = shutil.disk_usage(_existing(out)).free
    processes.say(f"{len(archives)} archives, {gigabytes(left)} to fetch; depth maps unpack to "
                  f"about ten times as much. {out} has {gigabytes(free)} free.")
    if left > free:
        raise Failure(f"{out} has only {gigabytes(free)} free, but {gigabytes(left)} are to be "
                      "fetched; choose fewer scenes or another folder")
    if yes or left == 0:
        return
    if not sys.stdin.isatty():
        raise Failure(f"{gigabytes(left)} would be fetched; say --yes to do it")
    sys.stderr.write("Fetch them? [y/N] ")
    sys.stderr.flush()
    if sys.stdin.readline().strip().lower() not in ("y", "yes"):
        raise Failure("nothing was fetched")


def _existing(path):
    while not os.path.isdir(path):
        path = os.path.dirname(os.path.abspath(path))
    return path


def _fetch(archive, log):
    size = os.path.getsize(archive.part) if os.path.exists(archive.part) else 0
    if size > archive.size:  # Of another version of the archive.
        os.remove(archive.part)
        size = 0
    if size < archive.size:
        processes.run(fetch_command(archive), log)
    size = os.path.getsize(archive.part)
    if size != archive.size:
        raise Failure(f"{archive.part} has {size} bytes, but the archive {archive.size}; try "
                      "again, or remove it to begin anew")


def get(archive, out, remove_archive=False):
    """Fetches, verifies and unpacks an archive, as far as that is not done yet."""
    if os.path.exists(archive.marker):
        return
    os.makedirs(archive.folder, exist_ok=True)
    os.makedirs(out, exist_ok=True)
    log = archive.path + ".log"
    if not os.path.exists(archive.path):
        processes.say(f"{archive.name}: fetching {gigabytes(archive.bytes_left)} ...")
        _fetch(archive, log)
        try:
            processes.run(test_command(archive.part), log)
        except processes.ProgramFailed as error:
            os.remove(archive.part)
            raise Failure(f"{archive.name} did not arrive whole and was removed; try again "
                          f"({error})") from error
        os.replace(archive.part, archive.path)
    processes.say(f"{archive.name}: unpacking ...")
    processes.run(unpack_command(archive, out), log)
    files.write_text(archive.marker, f"{archive.size}\n")
    os.remove(log)
    if remove_archive:
        os.remove(archive.path)
