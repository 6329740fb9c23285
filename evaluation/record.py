"""record.json, which says how the results in the folder of a run were made.

It is written while a run is made, and read by what goes on with it and by reports.
"""

import os
from typing import Dict, List, Optional

from . import files, processes, schemas
from .schemas import Integer, Number, Text

_MEASURES = ("seconds", "cpu_seconds", "peak_memory_bytes")


class Machine(schemas.Model):
    """cores: those that the process may use; gpu: names of those that a step computed on."""
    cpu: Text
    cores: Integer
    memory_bytes: Optional[Number] = ...
    gpu: Optional[Text] = ...


class Maker(schemas.Model):
    """What made a part of a step: a version of the program on a machine."""
    version: Text
    machine: Machine


class Failed(schemas.Model):
    """Why the last attempt failed."""
    step: Text
    message: Text


class Record(schemas.Model):
    """What runs and other tools' results have in common. None: not known."""
    set: Text
    method: Text
    seed: Integer
    # Of patch_match_stereo, with those of the method.
    options: List[Text]
    # Of stereo_fusion, by cloud.
    fusion_options: Dict[Text, Optional[List[Text]]]
    # By step. More than one where a run was stopped and went on with another; None
    # in place of one for maps or points that were there before.
    made_with: Dict[Text, List[Optional[Maker]]]
    # Number of depth maps, and width and height of the first.
    views: Optional[Integer] = ...
    image_size: Optional[List[Integer]] = ...
    # Steps that are complete: stereo and the names of fusions.
    done: List[Text]
    failed: Optional[Failed] = ...
    # By step. Times add up over the parts of a run that was stopped.
    seconds: Dict[Text, Optional[Number]]
    cpu_seconds: Dict[Text, Optional[Number]]
    peak_memory_bytes: Dict[Text, Optional[Number]]

    def forget(self, step):
        """As if a step had never begun."""
        for key in ("made_with", *_MEASURES):
            getattr(self, key).pop(step, None)

    def set_unknown(self, step):
        """Of a step that was done before, nobody knows by whom."""
        self.made_with[step] = [None]
        self.set_usage(step, None)

    def begin_part(self, step, version, machine):
        """Notes with what a step begins or goes on."""
        self.made_with.setdefault(step, []).append(Maker(version=version, machine=machine))

    def end_part(self, step, gpu):
        """Notes on which GPU the last part of a step was computed, None for the CPU.

        A part is not listed twice.
        """
        makers = self.made_with.get(step)
        if makers and makers[-1]:
            makers[-1].machine.gpu = gpu
            if makers[-1] in makers[:-1]:
                makers.pop()

    def makers(self):
        """Of all parts of all steps, None for what is not known."""
        return [maker for parts in self.made_with.values() for maker in parts]

    def stereo_gpus(self):
        """What stereo computed on: names of GPUs, and None for the CPU."""
        return {maker.machine.gpu for maker in self.made_with.get("stereo", []) if maker}

    def is_mixed(self):
        """Whether parts of a run were made by other versions or on other machines."""
        # Fusion never uses a GPU.
        makers = [maker and (maker.version, maker.machine.dict(exclude={"gpu"}))
                  for maker in self.makers()]
        return (any(maker != makers[0] for maker in makers)
                or len(self.made_with.get("stereo", [])) > 1)

    def usage(self, step):
        """What the parts of a step took so far, None if it is not known."""
        if step not in self.seconds:
            return processes.Usage(0, 0, 0)
        values = [getattr(self, measure)[step] for measure in _MEASURES]
        return None if None in values else processes.Usage(*values)

    def set_usage(self, step, usage):
        """usage: of all parts of a step; None: it is not known."""
        for measure in _MEASURES:
            getattr(self, measure)[step] = usage and getattr(usage, measure)

    def total_seconds(self, cloud="fused"):
        """The time of stereo and one fusion together; None if it is not known."""
        values = [self.seconds.get(step) for step in ("stereo", cloud)]
        return None if None in values else sum(values)


class RunRecord(Record):
    """Of a run of this program. sources, every: as in make_workspace.sh."""
    sources: Integer
    every: Integer


class ComparisonRecord(Record):
    """Of results of another tool: where they are, and of how many photographs there might be."""
    compare: List[Text]
    photographs: Integer


def empty(kind, **values):
    """A record in which nothing has been done."""
    return kind(**{"fusion_options": {}, "made_with": {}, "views": None, "image_size": None,
                   "done": [], "failed": None, **{measure: {} for measure in _MEASURES},
                   **values})


def _path(folder):
    return os.path.join(folder, "record.json")


def load(folder):
    """The record in a folder, None where there is none."""
    content = files.read_json(_path(folder))
    if content is None and not os.path.exists(_path(folder)):
        return None
    is_comparison = isinstance(content, dict) and "compare" in content
    return schemas.check(content, ComparisonRecord if is_comparison else RunRecord, _path(folder))


def save(folder, record):
    files.write_json(_path(folder), record)


def note_failure(folder, step, message):
    """Records why a step failed, or with None that none did."""
    try:
        record = load(folder)
    except processes.Failure:  # A damaged record stays as it is.
        return
    failed = message and Failed(step=step, message=message)
    if record is not None and record.failed != failed:
        record.failed = failed
        save(folder, record)
