"""Runs a program with too little memory: a limit on its address space."""

import resource

import io_errors
import programs
import trials

TITLE = "too little memory"
MEGABYTE = 1 << 20
# The libraries alone take that much; below it the system does not start the program.
LEAST = 8 * MEGABYTE


def _run(command, folder, limit):
    return programs.run(command, folder, preexec_fn=lambda: resource.setrlimit(
        resource.RLIMIT_AS, (limit, limit)))


def _least_limit(works, low, high):
    """Where what works begins, to 16 megabytes."""
    while high - low > 16 * MEGABYTE:
        middle = (low + high) // 2
        low, high = (low, middle) if works(middle) else (middle, high)
    return high


def is_told(line):
    return "memory" in line


def run(program, number, rng, report):
    """Tries limits between that for starting the program and that for all of its work."""
    if program.name == "automatic":
        print("SKIPPED: the Delaunay mesher may wait for ever where memory ends "
              "(docs/reliability.md)")
        return
    help_command = [program.command[0], program.command[1], "--help"]
    least = _least_limit(
        lambda limit: _run(help_command, program.origin, limit)[0] == 0,
        LEAST, 2048 * MEGABYTE)
    enough = _least_limit(
        lambda limit: _run(program.command, program.fresh(), limit)[0] == 0,
        least, 4096 * MEGABYTE)
    for limit in io_errors.spread(least + rng.randint(0, MEGABYTE), enough, number):
        folder = program.fresh()
        status, output = _run(program.command, folder, limit)
        trials.judge(program, folder, status, output, report,
                     f"with {limit / MEGABYTE:.1f} MB of address space "
                     f"({least // MEGABYTE} to start, {enough // MEGABYTE} for all)",
                     is_told)
