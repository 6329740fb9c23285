"""What programs printed: times, and warnings about what they left out."""

import os
import re
from typing import NamedTuple

from .. import files

_ELAPSED = re.compile(r"Elapsed time: (\d{1,12}(?:\.\d+)?) \[minutes\]")
_VIEW = re.compile(r"\s*[\d.]+ %\s+\S+ to go  (?:level \d+ )?(?:photometric|draft|geometric) "
                   r"\d+/\d+ (.+): [\d.]+ megapixels in (\d{1,12}(?:\.\d+)?) s")

_PLAIN = {"Finding good initial image pair": "Camera poses"}  # Of what a heading begins.


class Step(NamedTuple):
    """Something that a program did and told the time of, in so many runs together."""
    name: str
    log: str
    seconds: float
    num_runs: int


class Logs:
    """All logs (*.log) in some folders. Lines that are not understood do not matter."""

    def __init__(self, folders):
        self.paths = [os.path.join(folder, name) for folder in dict.fromkeys(folders)
                      if os.path.isdir(folder) for name in sorted(os.listdir(folder))
                      if name.endswith(".log")]
        self.steps = []
        # Seconds that stereo took, by photograph.
        self.view_seconds = {}
        self._warnings = []
        for path in self.paths:
            self._read(path)

    def _read(self, path):
        lines = files.read_bytes(path).decode("utf-8", errors="surrogateescape").splitlines()
        command, heading = "", ""
        for before, line, after in zip(["", *lines], lines, [*lines[1:], ""]):
            if line.startswith("$ "):
                command = line[2:]
            elif before.startswith("=====") and after.startswith("====="):
                heading = heading or line  # What comes below it is a part of the step.
            elif match := _ELAPSED.match(line):
                name = command or _PLAIN.get(heading, heading) or os.path.basename(path)[:-4]
                self._add_step(name, os.path.basename(path), 60 * float(match[1]))
                heading = ""
            elif match := _VIEW.match(line):
                self.view_seconds[match[1]] = (self.view_seconds.get(match[1], 0)
                                               + float(match[2]))
            elif line.startswith("WARNING: "):
                self._warnings.append(line.removeprefix("WARNING: "))

    def _add_step(self, name, log, seconds):
        """A run that was stopped and started again has its steps again, too."""
        before = self.steps[-1] if self.steps else None
        if before and (before.name, before.log) == (name, log):
            self.steps[-1] = Step(name, log, before.seconds + seconds, before.num_runs + 1)
        else:
            self.steps.append(Step(name, log, seconds, 1))

    def why_left_out(self, name):
        """The last warning that a photograph was left out, "" if there is none."""
        of_name = re.compile(rf"(?:View |maps of |; ){re.escape(name)}(?: |;|$)")
        return next((line for line in reversed(self._warnings)
                     if "left out" in line and of_name.search(line)), "")
