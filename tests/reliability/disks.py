"""Runs a program on a disk that is too small, and in a folder that becomes read-only
on the way. Mounts exist in a name space of their own, which ends with the run."""

import os
import subprocess

import programs
import trials

TITLE = "full and read-only disks"
# As root, and with a name space of users without.
UNSHARE = ["unshare", "--mount"] if os.getuid() == 0 else [
    "unshare", "--map-root-user", "--mount"]
# $0: folder, $1: size, $2: where what is there at the end is copied; the command.
FULL = """
mkdir -p "$0.disk" && mount -t tmpfs -o size="$1" none "$0.disk" &&
cp -a "$0/." "$0.disk" && cd "$0.disk" || exit 99
target=$2
shift 2
"$@"
status=$?
cd /
rm -rf "$target" && cp -a "$0.disk" "$target" && exit $status
exit 99
"""
# $0: folder, $1: seconds; the command. Busy: a file is open for writing.
READ_ONLY = """
mount --bind "$0" "$0" && cd "$0" || exit 99
seconds=$1
shift
"$@" &
sleep "$seconds"
while kill -0 $! 2>/dev/null && ! mount -o remount,bind,ro "$0" 2>/dev/null; do
  sleep 0.005
done
wait $!
"""


def can_mount():
    try:
        return subprocess.run([*UNSHARE, "mount", "-t", "tmpfs", "none", "/mnt"],
                              stderr=subprocess.DEVNULL).returncode == 0
    except OSError:
        return False


def _size_on_disk(contents):
    """In bytes, by pages and with one for each name."""
    page = os.sysconf("SC_PAGE_SIZE")
    return sum(page * (1 + -(-len(content or b"") // page))
               for content in contents.values())


def _fill(program, share):
    """Runs it on a disk with room for a share of what it makes."""
    folder = program.fresh()
    before = _size_on_disk(program.start)
    size = before + share * (_size_on_disk(program.expected) - before)
    target = os.path.join(program.folder, "filled")
    status, output = programs.run(
        [*UNSHARE, "sh", "-c", FULL, folder, f"{int(size / 1024)}k", target,
         *program.command], "/")
    return target, status, output


def _close(program, moment):
    """Makes its folder read-only at a moment."""
    folder = program.fresh()
    status, output = programs.run([*UNSHARE, "sh", "-c", READ_ONLY, folder,
                                   f"{moment:.3f}", *program.command], "/")
    return folder, status, output


def run(program, number, rng, report):
    if not can_mount():
        print("SKIPPED: nothing can be mounted here; that takes root, or name spaces "
              "of users")
        return
    for _ in range(number):
        share = rng.uniform(0, 1.2)
        folder, status, output = _fill(program, share)
        trials.judge(program, folder, status, output, report,
                     f"with room for {share:.2f} of its files")
        moment = rng.uniform(0, program.duration)
        folder, status, output = _close(program, moment)
        trials.judge(program, folder, status, output, report,
                     f"read-only after {moment:.3f} s")
