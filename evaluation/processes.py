"""Runs programs and measures what they take."""

import dataclasses
import os
import re
import shlex
import signal
import subprocess
import sys
import time

from . import progress


class Failure(Exception):
    """Something went wrong. Its text is one line for the user.

    What it quotes of a file may have line breaks, and characters that command a terminal.
    """
    exit_status = 1

    def __str__(self):
        return re.sub(r"[\0-\x1f\x7f]", "?", super().__str__())


class Interrupted(Exception):
    """The user wants to stop; number is the signal."""

    def __init__(self, number, usage=None):
        super().__init__(f"stopped by {signal.Signals(number).name}")
        self.number = number
        self.usage = usage


@dataclasses.dataclass
class Usage:
    """Wall and CPU seconds, and the largest resident memory in bytes."""
    seconds: float
    cpu_seconds: float
    peak_memory_bytes: int

    def __add__(self, other):
        return Usage(self.seconds + other.seconds, self.cpu_seconds + other.cpu_seconds,
                     max(self.peak_memory_bytes, other.peak_memory_bytes))


class ProgramFailed(Failure):
    """A program did not end well. It took usage."""

    def __init__(self, message, usage):
        super().__init__(message)
        self.usage = usage


def reason(error):
    """Why something failed, in one line."""
    text = str(error)
    return (text if isinstance(error, (Failure, OSError))
            else f"{type(error).__name__}: {' '.join(text.split())}")


def command_text(command):
    """A command as one can type it."""
    return " ".join(shlex.quote(word) for word in command)


def number_text(value):
    """A number for a command, which reads it back exactly."""
    return repr(value).removesuffix(".0")


def list_text(values):
    """Numbers or texts for a command."""
    return ",".join(value if isinstance(value, str) else number_text(value) for value in values)


def say(text):
    """Tells the user what happens; results go to standard output instead."""
    print(text, file=sys.stderr, flush=True)


def run(command, log):
    """Runs a command, whose output is added to the file log. Returns Usage.

    Raises ProgramFailed if it cannot be started or fails. SIGINT and SIGTERM
    are handed on to the program, which ends in order; then Interrupted is
    raised, with what it took.
    """
    received = []
    os.makedirs(os.path.dirname(log) or ".", exist_ok=True)
    with open(log, "ab") as file:
        file.write(os.fsencode(f"$ {command_text(command)}\n"))
        file.flush()
        start = time.monotonic()
        try:
            # In a group of its own, lest the terminal interrupt it twice.
            process = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=file,
                stderr=subprocess.STDOUT, process_group=0)
        except OSError as error:
            raise ProgramFailed(f"{command[0]} cannot be started: "
                                f"{error.strerror}", Usage(0, 0, 0)) from error

        def hand_on(number, _):
            received.append(number)
            process.send_signal(number)

        before = {number: signal.signal(number, hand_on)
                  for number in (signal.SIGINT, signal.SIGTERM)}
        try:
            with progress.Follower(log):
                _, status, resources = os.wait4(process.pid, 0)
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)
        process.returncode = os.waitstatus_to_exitcode(status)
    usage = Usage(time.monotonic() - start,
                  resources.ru_utime + resources.ru_stime,
                  1024 * resources.ru_maxrss)
    if received:
        raise Interrupted(received[0], usage)
    if process.returncode != 0:
        raise ProgramFailed(_why(command, process.returncode, log), usage)
    return usage


def last_output(log):
    """What the last command of a log printed, also if it was killed."""
    try:
        with open(log, encoding="utf-8", errors="replace") as file:
            lines = file.read().splitlines()
    except FileNotFoundError:
        return []
    begin = max((i for i, line in enumerate(lines) if line.startswith("$ ")), default=-1)
    return lines[begin + 1:]


def _why(command, code, log):
    """What a program that failed said last, in one line."""
    lines = last_output(log)
    name = os.path.basename(command[0])
    if name == "colmap" and len(command) > 1:
        name = command[1]
    if code < 0:
        return f"{name} was ended by {signal.Signals(-code).name}; see {log}"
    errors = [line for line in lines if line.startswith("ERROR")]
    text = (errors or [line for line in lines if line.strip()] or [""])[-1]
    return f"{name}: {text.removeprefix('ERROR: ')} (see {log})"
