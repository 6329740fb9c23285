"""Lets file operations of a program fail, by a library that it is started with
(io_faults.cc)."""

import errno
import os

import programs
import trials

TITLE = "file operations that fail"
LIBRARIES = os.environ.get("TAPA_RELIABILITY_LIBRARIES") or os.path.join(
    os.path.dirname(os.path.abspath(__file__)), "../../build/tests/reliability")
LIBRARY = os.path.join(LIBRARIES, "libio_faults.so")


def environment(folder, kind, number, error, onward=False):
    return {"LD_PRELOAD": LIBRARY, "TAPA_IO_FOLDER": os.path.realpath(folder),
            "TAPA_IO_KIND": kind, "TAPA_IO_AT": str(number),
            "TAPA_IO_ERROR": str(error), "TAPA_IO_ONWARD": str(int(onward))}


def count(program, kind):
    """The number of operations in an undisturbed run; 0: there is no library."""
    if not os.path.exists(LIBRARY):
        return 0
    folder = program.fresh()
    path = os.path.join(program.folder, "count")
    status, output = programs.run(
        program.command, folder,
        {**environment(folder, kind, 0, 0), "TAPA_IO_COUNT": path})
    assert status == 0, output
    with open(path) as file:
        return int(file.read())


def spread(first, last, number):
    """Whole numbers from all over a range, each once."""
    if number <= 1 or last <= first:
        return [first]
    step = max((last - first) / (number - 1), 1)
    return sorted({round(first + step * i) for i in range(number)
                   if first + step * i <= last + 0.5})


def run(program, number, rng, report):
    """Tries `number` moments of each kind of error."""
    if not os.path.exists(LIBRARY):
        print(f"SKIPPED: there is no {LIBRARY}; scripts/build.sh all makes it")
        return
    kinds = [("change", errno.EIO, False), ("change", errno.ENOSPC, True),
             ("read", errno.EIO, False), ("read", errno.EIO, True)]
    for kind, error, onward in kinds:
        for at in spread(rng.randint(1, 3), count(program, kind), number):
            folder = program.fresh()
            status, output = programs.run(
                program.command, folder, environment(folder, kind, at, error, onward))
            trials.judge(program, folder, status, output, report,
                         f"{errno.errorcode[error]} at {kind} {at}"
                         f"{' and on' if onward else ''}")
