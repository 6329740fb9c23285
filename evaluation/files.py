"""Files that appear under their name only when they are complete."""

import contextlib
import fcntl
import json
import os
import shutil
import zlib

from .processes import Failure


@contextlib.contextmanager
def replacing(path):
    """Gives a name to write to, which becomes path unless something fails."""
    new = path + ".new"
    try:
        os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
        try:
            yield new
            os.replace(new, path)
        finally:
            if os.path.lexists(new):
                os.remove(new)
    except OSError as error:
        raise Failure(f"{path} cannot be written: {error.strerror}") from error


@contextlib.contextmanager
def replacing_folder(path):
    """The same for a folder, to be filled under another name. Nothing but an empty one is
    replaced."""
    path = os.path.realpath(path)
    new = path + ".new"
    try:
        if os.path.lexists(path) and os.listdir(path):
            raise Failure(f"{path} is not empty; name another folder, or remove it")
        os.makedirs(os.path.dirname(path), exist_ok=True)
        try:
            os.mkdir(new)
        except FileExistsError as error:
            raise Failure(f"{new} is there: another program makes it, or was stopped; remove it "
                          "if none does") from error
        try:
            yield new
            os.replace(new, path)
        finally:
            shutil.rmtree(new, ignore_errors=True)
    except OSError as error:
        raise Failure(f"{path} cannot be written: {error.strerror}") from error


def read_bytes(path):
    """All of a file. Raises Failure if it cannot be read."""
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError as error:
        raise Failure(f"{path} cannot be read: {error.strerror}") from error


def write_bytes(path, *parts):
    """Writes the parts one after the other. Raises Failure if it cannot."""
    with replacing(path) as new, open(new, "wb") as file:
        for part in parts:
            file.write(part)


def write_text(path, text):
    write_bytes(path, text.encode("utf-8", errors="surrogateescape"))


def write_json(path, value):
    """value: plain data, with numbers of numpy, or a model (schemas.py)."""
    if not isinstance(value, (dict, list)):
        value = value.dict()
    # numpy 2 counts in numbers of its own.
    text = json.dumps(value, indent=2, ensure_ascii=False, default=lambda number: number.item())
    write_text(path, text + "\n")


def read_json(path, model=None):
    """The content of a file as a model (schemas.py) or plain; None where there is none.

    Raises Failure if it cannot be read or is not of the model.
    """
    try:
        with open(path, encoding="utf-8", errors="surrogateescape") as file:
            content = json.load(file)
    except (FileNotFoundError, NotADirectoryError):
        return None
    except (OSError, RecursionError, ValueError) as error:
        raise Failure(f"{path} cannot be read ({error}); remove it to make it anew") from error
    if model is None:
        return content
    from . import schemas  # Takes a while, and programs that only write need it not.
    return schemas.check(content, model, path)


def lock(folder, name):
    """Keeps other processes of a name out of a folder, by FOLDER/.NAME.lock.

    Until the file that is returned is closed, or this process ends in any way.
    Raises Failure if another process is at work there.
    """
    try:
        os.makedirs(folder, exist_ok=True)
        file = open(os.path.join(folder, f".{name}.lock"), "wb")
    except OSError as error:
        raise Failure(f"{folder} cannot be written: {error.strerror}") from error
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        file.close()
        raise Failure(f"another {name} is at work in {folder}; wait until it ends, or name "
                      "another folder") from error
    return file


def fingerprint(*paths):
    """Text that changes with the files at these paths, or in these folders.

    "" if there are none. It is made of names, sizes and samples of the content:
    all of a file of gigabytes would take too long, and times are lost in copies.
    """
    known = 0
    for path in paths:
        for name in _files_in(path):
            known = zlib.crc32(_sample(path, name), known)
    return f"{known:08x}" if known else ""


def is_newer(path, *sources):
    """Whether a file exists and is newer than its sources; "" is none."""
    return os.path.exists(path) and all(
        not source or os.path.getmtime(source) < os.path.getmtime(path) for source in sources)


def names_below(folder):
    """Names of the files in a folder and below, relative to it, in order."""
    return sorted((os.path.relpath(os.path.join(parent, name), folder)
                   for parent, _, names in os.walk(folder, followlinks=True)
                   for name in names), key=os.fsencode)


def _files_in(path):
    return [""] if os.path.isfile(path) else names_below(path)


def _sample(path, name, count=8, block=4096):
    path = os.path.join(path, name) if name else path
    if not os.path.exists(path):  # A link to nothing.
        return b""
    with open(path, "rb") as file:
        size = file.seek(0, os.SEEK_END)
        parts = [os.fsencode(name), str(size).encode()]
        for i in range(count):
            file.seek(max(0, size - block) * i // (count - 1))
            parts.append(file.read(block))
    return b"\n".join(parts)
