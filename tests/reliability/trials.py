"""A disturbed run, the run after it, and what is wrong with either."""

import re

import programs
import snapshots


class Report:
    """Counts trials, and keeps what went wrong in them."""

    def __init__(self):
        self.num_trials = 0
        self.num_ended = 0  # With an error, as it should.
        self.faults = []

    def add(self, what, faults):
        for fault in faults:
            self.faults.append(f"{what}: {fault}")
            print("FAULT: " + self.faults[-1], flush=True)


def errors_of(output):
    return [line for line in output.splitlines()
            if "ERROR" in line or "Check failed" in line or "***" in line]


def faults_of_ending(status, output, is_told=None):
    """Lines on how a program ended that something kept from its work.

    is_told(line): whether its error says enough.
    """
    if status < 0 or status >= 128:
        return [f"it crashed with status {status}: {output[-300:]!r}"]
    errors = errors_of(output)
    if status == 0:
        return [f"it calls this a success: {errors[0]}"] if errors else []
    if len(errors) != 1 or not errors[0].startswith("ERROR: "):
        return [f"{len(errors)} errors in place of one: {errors}, {output[-300:]!r}"]
    if is_told is not None and not is_told(errors[0]):
        return [f"this says too little: {errors[0]}"]
    return []


def names_a_file(line):
    """Whether an error says where it was; there is one database only."""
    return re.search(r"/|\.(bin|cfg|ply|png|txt|vis)\b|database", line) is not None


def finish(program, folder, faults):
    """The trouble is gone: the program goes on, and makes what it makes undisturbed."""
    status, output = programs.run(program.command, folder)
    if status != 0:
        faults.append(f"it does not go on: {output[-300:]!r}")
    return faults + snapshots.faults_at_end(folder, program.expected)


def judge(program, folder, status, output, report, what,
          is_told=names_a_file):
    """Looks at what a disturbed run has left, and runs the program once more."""
    faults = faults_of_ending(status, output, is_told)
    faults += snapshots.faults_at_names(folder, program.start, program.expected)
    if status == 0:
        # What the system did not let be removed may be there until the next run.
        faults += [fault for fault in snapshots.faults_at_end(folder, program.expected)
                   if not fault.endswith("is left over")]
    report.num_trials += 1
    report.num_ended += status != 0
    report.add(f"{program.name}, {what}", finish(program, folder, faults))
