"""Names of the photographs that a sparse model of COLMAP has.

As a program it prints those of DATA/sparse that are in DATA/images, a line each.
"""

import os
import sys

from . import binary_model, colmap_model, files


def read_names(folder):
    """Names in the text or binary model in a folder, in any order; None where there is none."""
    binary, text = (os.path.join(folder, "images" + end) for end in (".bin", ".txt"))
    if os.path.exists(binary):
        return [name for *_, name in binary_model.read_images(binary)]
    if os.path.exists(text):
        lines = colmap_model.lines_in(
            files.read_bytes(text).decode("utf-8-sig", errors="surrogateescape"))
        # A line of observations follows each photograph's own.
        names = [colmap_model.name_in(line) for line in lines[0::2] if line.strip()]
        for name in names:
            colmap_model.check_name(name, text)
        return names
    return None


def photographs(data):
    """Names of the files in DATA/images that the model has; all, where there is no model."""
    names = files.names_below(os.path.join(data, "images"))
    known = read_names(os.path.join(data, "sparse"))
    known = None if known is None else set(known)
    return [name for name in names if known is None or name in known]


def main(words=None):
    data = (words or sys.argv[1:])[0]
    for name in photographs(data):
        sys.stdout.buffer.write(os.fsencode(name) + b"\n")
    return 0


if __name__ == "__main__":
    from . import command_line  # What reads names alone does without.
    sys.exit(command_line.run(main))
