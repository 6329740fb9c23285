"""record.json, which says how the results in the folder of a run were made:

    set, method, seed    as in stereo_run.Run
    options              of patch_match_stereo, with those of the method
    fusion_options       of stereo_fusion, by cloud. null: not known
    sources, every       as in make_workspace.sh
    made_with            by step, a list of {"version", "machine"}: more than one
                         where a run was stopped and went on with another. See
                         machine.describe(); machine.gpu names the GPUs that the
                         step computed on. null in place of one: maps or points
                         that were there before, so who made them is not known
    views, image_size    number of depth maps; [width, height] of the first
    done                 steps that are complete: stereo and the names of fusions
    seconds, cpu_seconds, peak_memory_bytes
                         by step. Times add up over the parts of a run that was
                         stopped. null: not known, as another program did it
    failed               null, or {"step", "message"} of the last attempt
"""

import copy
import os

from . import files, processes, shapes

_MEASURES = ("seconds", "cpu_seconds", "peak_memory_bytes")

_MACHINE = {"cpu": str, "cores": int, "memory_bytes": (None, float),
            "gpu": (None, str)}
_ANY = {
    "set": str, "method": str, "seed": int, "options": [str],
    "fusion_options": {str: (None, [str])},
    "made_with": {str: [(None, {"version": str, "machine": _MACHINE})]},
    "views": (None, int), "image_size": (None, [int]), "done": [str],
    "failed": (None, {"step": str, "message": str}),
    **{measure: {str: (None, float)} for measure in _MEASURES}}
_RUN = {**_ANY, "sources": int, "every": int}
_COMPARISON = {**_ANY, "compare": [str], "photographs": int}


def load(folder):
    """The record of a run, None where there is none."""
    record = files.read_json(_path(folder), {})
    if record is not None:
        _modernize(record)
        shapes.check(_path(folder), record,
                     _COMPARISON if "compare" in record else _RUN)
    return record


def _modernize(record):
    """Records once had one version and machine for all steps, and no thresholds."""
    if "made_with" not in record and "version" in record:
        record["fusion_options"] = {}
        part = {"version": record.pop("version"),
                "machine": record.pop("machine", None)}
        record["made_with"] = {
            step: [copy.deepcopy(part) if part["version"] else None]
            for step in record.get("seconds", {})}


def save(folder, record):
    files.write_json(_path(folder), record)


def _path(folder):
    return os.path.join(folder, "record.json")


def forget(record, step):
    """As if a step had never begun."""
    for key in ("made_with", *_MEASURES):
        record[key].pop(step, None)


def set_unknown(record, step):
    """Of a step that was done before, nobody knows by whom."""
    record["made_with"][step] = [None]
    set_usage(record, step, None)


def begin_part(record, step, version, machine):
    """Notes with what a step begins or goes on."""
    record["made_with"].setdefault(step, []).append(
        {"version": version, "machine": machine})


def end_part(record, step, gpu):
    """Notes on which GPU the last part of a step was computed, None for the CPU.

    A part is not listed twice.
    """
    made = record["made_with"].get(step)
    if made and made[-1]:
        made[-1]["machine"]["gpu"] = gpu
        if made[-1] in made[:-1]:
            made.pop()


def parts(record):
    """All {"version", "machine"} of the steps of a run, None for what is not known."""
    return [part for made in record["made_with"].values() for part in made]


def stereo_gpus(record):
    """What stereo computed on: names of GPUs, and None for the CPU."""
    return {part["machine"]["gpu"]
            for part in record["made_with"].get("stereo", []) if part}


def is_mixed(record):
    """Whether parts of a run were made by other versions or on other machines."""
    # Fusion never uses a GPU.
    made = [part and {**part, "machine": {**part["machine"], "gpu": None}}
            for part in parts(record)]
    return (any(one != made[0] for one in made)
            or len(record["made_with"].get("stereo", [])) > 1)


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
    try:
        record = load(folder)
    except processes.Failure:  # A damaged record stays as it is.
        return
    if record is not None:
        record["failed"] = error and {"step": step, "message": error}
        save(folder, record)
