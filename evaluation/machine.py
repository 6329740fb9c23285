"""What machine a run is made on, and with which version of the program."""

import collections
import os
import platform
import re
import subprocess

from .processes import Failure
from .record import Machine

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def default_bin_dir():
    """Where the programs are: TAPA_BIN_DIR, or build/bin."""
    return os.environ.get("TAPA_BIN_DIR") or os.path.join(ROOT, "build", "bin")


def find_program(bin_dir, name):
    path = os.path.join(bin_dir, name)
    if not os.access(path, os.X_OK):
        raise Failure(f"{bin_dir} has no {name}; run scripts/build.sh first")
    return path


def _first(path, pattern):
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            match = re.search(pattern, file.read(), re.MULTILINE)
    except OSError:
        return None
    return match.group(1).strip() if match else None


def describe():
    """This machine. Which GPU a program computes on is known when it has said so: gpus_in()."""
    memory = _first("/proc/meminfo", r"^MemTotal:\s*(\d+) kB")
    return Machine(
        cpu=(_first("/proc/cpuinfo", r"^model name\s*:\s*(.*)$")
             or platform.processor() or platform.machine()),
        cores=len(os.sched_getaffinity(0)),
        memory_bytes=1024 * int(memory) if memory else None, gpu=None,
        system=_first("/etc/os-release", r'^PRETTY_NAME="?([^"\n]*)') or platform.system())


def gpus_in(lines):
    """Names of the GPUs on which colmap said that it computes, None for the CPU.

    It says "Computing on GPU 0 (NAME), 1 (NAME)."; a GPU that computes two views
    at a time stands there twice.
    """
    names = {}
    for line in lines:
        if line.startswith("Computing on GPU "):
            names.update(re.findall(r"(\d+) \((.*?)\)(?=, \d+ \(|\.$)", line))
    counts = collections.Counter(names.values())
    return ", ".join(name if count == 1 else f"{count} x {name}"
                     for name, count in counts.items()) or None


def _output(command):
    try:
        result = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.DEVNULL, text=True, check=False)
    except OSError:
        return ""
    return result.stdout if result.returncode == 0 else ""


def program_version(bin_dir):
    """COLMAP's own line, and the commit of the checkout that it was built in."""
    lines = _output([find_program(bin_dir, "colmap"), "help"]).splitlines()
    words = [line.strip() for line in lines[:2]]
    version = words[0].split(" -- ")[0] if words else "COLMAP"
    if len(words) > 1 and words[1].startswith("("):
        version += " " + words[1]
    if os.path.realpath(bin_dir).startswith(os.path.realpath(ROOT) + os.sep):
        commit = _output(["git", "-C", ROOT, "describe", "--always", "--dirty",
                          "--abbrev=12"]).strip()
        if commit:
            version += f", commit {commit}"
    return version
