"""Which channels an EXR file has.

OpenCV knows those called Y, or R, G and B, and makes zeros of a depth called Z, without a word.
"""

from ..processes import Failure

_LIST = b"channels\0chlist\0"
_KNOWN = ([b"Y"], [b"B", b"G", b"R"], [b"A", b"B", b"G", b"R"])  # In the order of the file.
_HEADER = 1 << 16  # No header begins its list of channels behind this.


def for_opencv(data, path):
    """The content of a file such that OpenCV reads it. Raises Failure if that is impossible."""
    begin, names = _channels(data)
    if names in _KNOWN or not names:  # Without a list it is damaged, as OpenCV will find.
        return data
    if len(names) == 1 and len(names[0]) == 1:  # Z, or V of some programs.
        return data[:begin] + b"Y" + data[begin + 1:]
    text = ", ".join(name.decode("latin-1") for name in names)
    raise Failure(f"{path} has the channels {text}; write one with a single letter (Y, Z), or for "
                  "normals R, G and B")


def _channels(data):
    """Where the first name stands in the file, and all names."""
    found = data.find(_LIST, 0, _HEADER)
    if found < 0:
        return 0, []
    begin = at = found + len(_LIST) + 4  # Behind the size of the list.
    names = []
    while data[at:at + 1] not in (b"", b"\0"):
        end = data.find(b"\0", at)
        if end < 0:
            return 0, []
        names.append(data[at:end])
        at = end + 1 + 16  # Type, and how it is sampled.
    return begin, names
