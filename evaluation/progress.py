"""Shows how far a program is: on a terminal in place, elsewhere by a line a minute."""

import os
import re
import sys
import threading
import time

from .texts import clock

# As patch_match_stereo writes it: " 58.3 %  0:04:03 to go  geometric 2/12 room_01.jpg ...".
_LINE = re.compile(rb"^ *\d+\.\d %  \d+:\d\d:\d\d to go  [^:\r\n]*", re.MULTILINE)
_INTERVAL, _TERMINAL_INTERVAL = 60, 1  # Seconds.


class Follower:
    """While it is entered, shows the last line of progress that another program adds to a log,
    if it is another one."""

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
        while not self._end.wait(_interval(terminal)):
            with open(self._log, "rb") as file:
                file.seek(self._begin)
                lines = _LINE.findall(file.read())
            if lines and (terminal or lines[-1] != shown):
                shown = lines[-1]
                _show(shown.decode(errors="replace"), terminal)
        if terminal and shown:
            _clear()


def each(items, what, name_of=str):
    """Yields the items of a list, and shows how far this program is with them.

    The time to go is that of as many items at the pace so far.
    """
    terminal = sys.stderr.isatty()
    begin = shown = time.monotonic()
    try:
        for done, item in enumerate(items):
            now = time.monotonic()
            if done and now - shown >= _interval(terminal):
                shown = now
                to_go = clock((now - begin) * (len(items) - done) / done)
                _show(f"{100 * done / len(items):5.1f} %  {to_go} to go  {what} "
                      f"{done + 1}/{len(items)} {name_of(item)}", terminal)
            yield item
    finally:
        if terminal and shown > begin:
            _clear()


def _interval(terminal):
    return _TERMINAL_INTERVAL if terminal else _INTERVAL


def _show(text, terminal):
    _write(f"\r\033[K{text}" if terminal else f"{text}\n")


def _clear():
    _write("\r\033[K")


def _write(text):
    sys.stderr.write(text)
    sys.stderr.flush()
