"""Runs of dense stereo and fusion, which can be watched and stopped."""

import logging
import os

from . import _engine, options as option_lists
from .errors import Error

_LOGGER = logging.getLogger("tapa_mvs")
_INTERVAL = 0.05  # Seconds between looks at how far a run is, and at Ctrl-C.
_WARNING = "WARNING: "


def patch_match_stereo(workspace, options=None, progress=None, *, workspace_format="COLMAP",
                       pmvs_option_name="option-all", config_path=""):
    """Computes the depth and normal maps of a workspace, as `colmap patch_match_stereo` does.

    workspace: folder with undistorted photographs and their sparse model.
    options: those to change, by the names of stereo_options().
    progress: called with the share of the work that is done, 0 to 1, and a text, by the calling
        thread and a few times per second. The share never falls, and ends with 1.

    What the program would print goes to the logger "tapa_mvs". Ctrl-C, or any exception of
    progress, ends the run within a second; another one goes on from there. Raises Error with the
    program's message if anything goes wrong.
    """
    _follow(lambda: _engine.start_stereo(
        workspace_path=os.fsencode(workspace),
        workspace_format=_one_of("workspace_format", workspace_format, "colmap", "pmvs"),
        pmvs_option_name=pmvs_option_name, config_path=os.fsencode(config_path),
        options=option_lists.checked(options, option_lists.stereo_options())), progress)


def stereo_fusion(workspace, output_path, options=None, *, input_type="geometric",
                  workspace_format="COLMAP", pmvs_option_name="option-all", bbox_path=""):
    """Makes points of the maps of a workspace, as `colmap stereo_fusion` does.

    output_path: the PLY file to write. options: those to change, by the names of
    fusion_options(). input_type: "geometric" or "photometric", the maps to take. For all else see
    patch_match_stereo; a fusion that was stopped begins anew.
    """
    _follow(lambda: _engine.start_fusion(
        workspace_path=os.fsencode(workspace),
        workspace_format=_one_of("workspace_format", workspace_format, "colmap", "pmvs"),
        pmvs_option_name=pmvs_option_name,
        input_type=_one_of("input_type", input_type, "geometric", "photometric"),
        bbox_path=os.fsencode(bbox_path), output_path=os.fsencode(output_path),
        options=option_lists.checked(options, option_lists.fusion_options())))


def _one_of(name, value, *values):
    if str(value).lower() not in values:
        raise ValueError(f"{name} is {value!r}, but must be {' or '.join(map(repr, values))}")
    return str(value).lower()


def _follow(start, progress=None):
    """Starts a run and waits until it has ended. Raises Error if it failed."""
    try:
        job = start()
    except RuntimeError as error:  # Another one is running.
        raise Error(str(error)) from None
    teller = progress and _Teller(progress)
    try:
        has_ended = False
        while not has_ended:
            has_ended = job.wait(_INTERVAL)
            _log(job)
            if teller and (not has_ended or job.is_done()):
                teller.tell(*job.progress())
    except BaseException:  # Ctrl-C is one.
        job.stop()
        _log(job)
        raise
    errors = [os.fsdecode(line) for line in job.errors()]
    if not job.is_done():
        raise Error("\n".join(errors) or "The run ended without a result.")
    for error in errors:
        _LOGGER.warning(error)
    if teller:
        teller.end()


class _Teller:
    """Tells what is new."""

    def __init__(self, progress):
        self._progress = progress
        self._share, self._text = 0.0, ""

    def tell(self, share, text):
        text = os.fsdecode(text)
        # A view that a GPU could not compute begins anew.
        share = max(share, self._share)
        if (share, text) != (self._share, self._text):
            self._share, self._text = share, text
            self._progress(share, text)

    def end(self):
        if self._share < 1:
            self.tell(1.0, b"complete")


def _log(job):
    for line in map(os.fsdecode, job.take_lines()):
        if line.startswith(_WARNING):
            _LOGGER.warning(line.removeprefix(_WARNING))
        else:
            _LOGGER.info(line)
