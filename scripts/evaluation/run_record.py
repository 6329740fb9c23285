"""record.json, which says how the results in the folder of a run were made:

    set, method, seed    as in stereo_run.Run
    options              of patch_match_stereo, with those of the method
    sources, every       as in make_workspace.sh
    version, machine     text; see machine.describe(). version is null where the
                         maps were there before: who made them is not known
    views, image_size    number of depth maps; [width, height] of the first
    done                 steps that are complete: stereo and the names of fusions
    seconds, cpu_seconds, peak_memory_bytes
                         by step. Times add up over the parts of a run that was
                         stopped. null: not known, as another program did it
    failed               null, or {"step", "message"} of the last attempt
"""

import os

from . import files, processes

_MEASURES = ("seconds", "cpu_seconds", "peak_memory_bytes")


def load(folder):
    """The record of a run, None where there is none."""
    return files.read_json(_path(folder))


def save(folder, record):
    files.write_json(_path(folder), record)


def _path(folder):
    return os.path.join(folder, "record.json")


def forget(record, step):
    """As if a step had never begun."""
    for measure in _MEASURES:
        record[measure].pop(step, None)


def known_usage(record, step):
    """What the parts of a step took so far, None if it is not known."""
    if step not in record["seconds"]:
        return processes.Usage(0, 0, 0)
    values = [record[measure][step] for measure in _MEASURES]
    return None if None in values else processes.Usage(*values)


def set_usage(record, step, usage):
    """usage: of all parts of a step; None: it is not known."""
    for measure in _MEASURES:
        record[measure][step] = usage and getattr(usage, measure)


def total_seconds(record, cloud="fused"):
    """The time of stereo and one fusion together; None if it is not known."""
    values = [record["seconds"].get(step) for step in ("stereo", cloud)]
    return None if None in values else sum(values)


def note_failure(folder, step, error):
    """Records why a later step failed, or with None that none did."""
    record = load(folder)
    if record is not None:
        record["failed"] = error and {"step": step, "message": error}
        save(folder, record)
