"""Runs a program while the clock of the day jumps (clock_jumps.cc)."""

import os
import re

import io_errors
import programs
import trials

TITLE = "a clock that jumps"
LIBRARY = os.path.join(io_errors.LIBRARIES, "libclock_jumps.so")
# What a program says of times that it measures by a clock that jumps.
NONSENSE = re.compile(r"-\d[\d.]* *(s|min|h|\[minutes\])\b|\d{4,}[\d.]* *(s to go|\[minutes\])")


def run(program, number, rng, report):
    if not os.path.exists(LIBRARY):
        print(f"SKIPPED: there is no {LIBRARY}; scripts/build.sh all makes it")
        return
    for _ in range(number):
        folder = program.fresh()
        status, output = programs.run(program.command, folder, {"LD_PRELOAD": LIBRARY})
        faults = [] if status == 0 else [f"it fails: {output[-300:]!r}"]
        faults += [f"it tells a time that makes no sense: {line}"
                   for line in output.splitlines() if NONSENSE.search(line)]
        report.num_trials += 1
        report.add(f"{program.name}, while the clock jumps",
                   trials.finish(program, folder, faults))
