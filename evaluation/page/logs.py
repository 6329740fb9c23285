"""What programs printed: times, and warnings about what they left out."""

import os
import re
from typing import NamedTuple

from .. import files

_ELAPSED = re.compile(r"Elapsed time: ([\d.]+) \[minutes\]")
_VIEW = re.compile(r"\s*[\d.]+ %\s+\S+ to go  (?:level \d+ )?(?:photometric|geometric) "
                   r"\d+/\d+ (.+): [\d.]+ megapixels in ([\d.]+) s")


class Step(NamedTuple):
    """Something that a program did and told the time of."""
    name: str
    seconds: float
    log: str


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
        name = os.path.basename(path)
        for before, line, after in zip(["", *lines], lines, [*lines[1:], ""]):
            if line.startswith("$ "):
                name = line[2:]
            elif before.startswith("=====") and after.startswith("====="):
                name = line
            elif match := _ELAPSED.match(line):
                self._add_step(name, 60 * float(match[1]), path)
            elif match := _VIEW.match(line):
                self.view_seconds[match[1]] = (self.view_seconds.get(match[1], 0)
                                               + float(match[2]))
            elif line.startswith("WARNING: "):
                self._warnings.append(line.removeprefix("WARNING: "))

    def _add_step(self, name, seconds, path):
        """Parts with one heading, of which there may be hundreds, count as one step."""
        if self.steps and self.steps[-1].name == name and self.steps[-1].log == path:
            seconds += self.steps.pop().seconds
        self.steps.append(Step(name, seconds, path))

    def why_left_out(self, name):
        """The last warning that a photograph was left out, "" if there is none."""
        of_name = re.compile(rf"(?:View |maps of |; ){re.escape(name)}(?: |;|$)")
        return next((line for line in reversed(self._warnings)
                     if "left out" in line and of_name.search(line)), "")
