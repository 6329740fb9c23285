"""What is in a folder, and how it differs from what should be there."""

import os
import re
import sqlite3
import stat

# What runs may leave behind as long as they are not complete: files on their way
# to their names, maps of coarse levels, and journals of databases.
UNFINISHED = re.compile(r"\.part(-|/|\.|$)|(^|/)levels(/|$)|\.db-(journal|wal|shm)$")
# Rows of a database have their numbers from when they were written.
DATABASE = ".db"


def take(folder):
    """The content of all files by relative path; None: of a folder."""
    contents = {}
    for parent, folders, names in os.walk(folder):
        for name in folders:
            contents[os.path.relpath(os.path.join(parent, name), folder)] = None
        for name in names:
            path = os.path.join(parent, name)
            # Neither a link nor a device.
            assert stat.S_ISREG(os.lstat(path).st_mode), path
            with open(path, "rb") as file:
                contents[os.path.relpath(path, folder)] = file.read()
    return contents


def _is_whole_map(content):
    fields = content.split(b"&", 3)
    if len(fields) < 4 or not all(field.isdigit() for field in fields[:3]):
        return False
    width, height, channels = map(int, fields[:3])
    return len(fields[3]) == 4 * width * height * channels


def _is_whole_database(path):
    # Immutable: without files of its own beside it.
    database = sqlite3.connect(f"file:{path}?immutable=1", uri=True)
    try:
        return database.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    except sqlite3.DatabaseError:
        return False
    finally:
        database.close()


def faults_at_names(folder, start, expected):
    """Lines on what stands under its final name, in a run that was disturbed, and is
    neither what was there before nor what an undisturbed run makes."""
    faults = []
    for path, content in take(folder).items():
        if content is None or path.endswith(DATABASE):
            continue
        if path in expected:
            if content not in (expected[path], start.get(path)):
                faults.append(f"{path} is there, but is another file "
                              f"({len(content)} bytes for {len(expected[path])})")
        elif not UNFINISHED.search(path):
            faults.append(f"{path} should not be there")
        elif path.endswith(".bin") and "/levels/" in path and "maps/" in path:
            if not _is_whole_map(content):
                faults.append(f"{path} is not whole")
    return faults


def faults_at_end(folder, expected):
    """Lines on how the result of a run differs from an undisturbed one's."""
    actual = take(folder)
    faults = [f"{path} is missing" for path in expected if path not in actual]
    faults += [f"{path} is left over" for path in actual if path not in expected]
    for path in set(actual) & set(expected):
        if path.endswith(DATABASE):
            if not _is_whole_database(os.path.join(folder, path)):
                faults.append(f"{path} is damaged")
        elif actual[path] != expected[path]:
            faults.append(f"{path} differs")
    return faults
