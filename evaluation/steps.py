"""Steps that a command plans, and what runs them.

A step makes one thing out of others. Steps that need each other form a job, such as
all of one run. perform() does what is not done yet, or prints the commands for it, so
that a command that was stopped goes on where it was when it is given again.
"""

import dataclasses
import sys
import time
from typing import Callable

from . import processes
from .texts import clock


class Step:
    """One thing to make. name: what, in messages and records.

    is_quick: it is not worth a message.
    """
    name = ""
    is_quick = False

    def is_done(self):
        """Whether what it makes is there and not stale. Raises Failure if what is
        there is of something else and must not be replaced."""
        return False

    def commands(self):
        """What run() executes, in order: commands, or texts for what is none."""
        raise NotImplementedError

    def run(self):
        """Makes it. Raises Failure, or processes.Interrupted."""
        raise NotImplementedError


class Call(Step):
    """A function that is called at once, and always; text: what it does, for a dry run."""
    is_quick = True

    def __init__(self, name, run, text=""):
        self.name = name
        self.run = run
        self._text = text

    def commands(self):
        return [self._text] if self._text else []


@dataclasses.dataclass
class Job:
    """Steps, each of which needs those before it."""
    name: str  # For the user; a folder in most cases.
    steps: list
    # Is told of the step that failed and why, or None twice.
    note: Callable = lambda step, message: None


def perform(jobs, dry_run=False):
    """Runs what is not done, job after job. What fails does not stop other jobs.

    dry_run: prints the commands instead. Returns (name, message) of jobs that failed.
    """
    jobs, failures, begin = list(jobs), [], time.monotonic()
    for number, job in enumerate(jobs, 1):
        step, message = None, None
        try:
            for step in job.steps:
                if step.is_done():
                    continue
                if dry_run:
                    _print(step.commands())
                    continue
                if not step.is_quick:
                    processes.say(f"[{number}/{len(jobs)}] {clock(time.monotonic() - begin)}  "
                                  f"{job.name}: {step.name} ...")
                step.run()
        except processes.Interrupted:
            raise
        except Exception as error:  # pylint: disable=broad-except
            # Whatever it is, the nights of the others are not lost to it.
            message = processes.reason(error)
            processes.say(f"FAILED {job.name}: {message}")
            failures.append((job.name, message))
        if not dry_run:
            job.note(message and step.name, message)
    return failures


def _print(commands):
    for command in commands:
        print(command if isinstance(command, str) else processes.command_text(command), flush=True)


def exit_status(failures, count):
    """Lists what failed, of so many jobs. Returns the exit status of the program."""
    if not failures:
        return 0
    print(f"ERROR: {len(failures)} of {count} failed:", file=sys.stderr)
    for name, message in failures:
        print(f"  {name}: {message}", file=sys.stderr)
    return 1
