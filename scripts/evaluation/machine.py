"""What machine a run is made on, and with which version of the program."""

import os
import platform
import re
import subprocess

from .processes import Failure

_ROOT = os.path.dirname(os.path.dirname(os.path.dirname(
    os.path.abspath(__file__))))


def default_bin_dir():
    """Where the programs are: TAPA_BIN_DIR, or build/bin."""
    return os.environ.get("TAPA_BIN_DIR") or os.path.join(_ROOT, "build", "bin")


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
    """{"cpu", "cores", "memory_bytes", "gpu", "system"}.

    cores are those that this process may use. gpu is None: the program computes
    on the CPU.
    """
    memory = _first("/proc/meminfo", r"^MemTotal:\s*(\d+) kB")
    return {
        "cpu": (_first("/proc/cpuinfo", r"^model name\s*:\s*(.*)$")
                or platform.processor() or platform.machine()),
        "cores": len(os.sched_getaffinity(0)),
        "memory_bytes": 1024 * int(memory) if memory else None,
        "gpu": None,
        "system": (_first("/etc/os-release", r'^PRETTY_NAME="?([^"\n]*)')
                   or platform.system()),
    }


def _output(command):
    try:
        result = subprocess.run(command, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE,
                                stderr=subprocess.DEVNULL, text=True,
                                check=False)
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
    if os.path.realpath(bin_dir).startswith(os.path.realpath(_ROOT) + os.sep):
        commit = _output(["git", "-C", _ROOT, "describe", "--always", "--dirty",
                          "--abbrev=12"]).strip()
        if commit:
            version += f", commit {commit}"
    return version
