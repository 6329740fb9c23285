"""Shows how far a program is, from the log that its output goes into."""

import os
import re
import sys
import threading

# As patch_match_stereo writes it: " 58.3 %  0:04:03 to go  geometric 2/12 room_01.jpg ...".
_LINE = re.compile(rb"^ *\d+\.\d %  \d+:\d\d:\d\d to go  [^:\r\n]*", re.MULTILINE)
_INTERVAL, _TERMINAL_INTERVAL = 60, 1  # Seconds.


class Follower:
    """While it is entered, shows the last line of progress that is added to a log: on a
    terminal in place, elsewhere once a minute, if it is another one."""

    def __init__(self, log):
        self._log = log
        self._begin = 0
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._follow, daemon=True)

    def __enter__(self):
        self._begin = os.path.getsize(self._log)
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._end.set()
        self._thread.join()

    def _follow(self):
        terminal = sys.stderr.isatty()
        shown = b""
        while not self._end.wait(_TERMINAL_INTERVAL if terminal else _INTERVAL):
            with open(self._log, "rb") as file:
                file.seek(self._begin)
                lines = _LINE.findall(file.read())
            if lines and (terminal or lines[-1] != shown):
                shown = lines[-1]
                text = shown.decode(errors="replace")
                _write(f"\r\033[K{text}" if terminal else f"{text}\n")
        if terminal and shown:
            _write("\r\033[K")


def _write(text):
    sys.stderr.write(text)
    sys.stderr.flush()
