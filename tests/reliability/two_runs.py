"""Starts a program, and at any moment of its run itself once more, or another one that
works in the same folder."""

import programs
import trials

TITLE = "two runs at once"


def is_told(line):
    return "Another run" in line and "/" in line or "no geometric maps" in line


def _both(first, second, folder, delay):
    """Returns how both ended."""
    one = programs.start(first, folder)
    programs.time.sleep(delay)
    other = programs.run(second, folder)
    output, _ = one.communicate()
    return [(one.returncode, output), other]


def run(program, number, rng, report):
    for _ in range(number):
        folder = program.fresh()
        delay = rng.uniform(0, 0.9 * program.duration)
        endings = _both(program.command, program.command, folder, delay)
        faults = [fault for status, output in endings
                  for fault in trials.faults_of_ending(status, output, is_told)]
        if all(status != 0 for status, _ in endings):
            faults.append("neither came to its end")
        report.num_trials += 1
        report.num_ended += any(status != 0 for status, _ in endings)
        report.add(f"{program.name}, twice, the second one after {delay:.3f} s",
                   trials.finish(program, folder, faults))
