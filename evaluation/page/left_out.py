"""Photographs that a reconstruction began with and that have no maps in the end, and why."""

import os
import sqlite3
import urllib.parse
from contextlib import closing

from .. import model_names
from ..processes import Failure

_PAIR = 2147483647  # COLMAP's number of a pair is this times one photograph's plus the other's.


def find(workspace, logs):
    """(photograph, reason) in the order of names; workspace: of workspace.py."""
    mapped = {view.name for view in workspace.maps}
    found = [(name, _why_without_maps(workspace, logs, name))
             for name in workspace.views if name not in mapped]
    if workspace.database:
        elsewhere = _other_models(workspace)
        found += [(name, elsewhere.get(name) or _why_unregistered(*counts))
                  for name, counts in _read_database(workspace.database).items()
                  if name not in workspace.views]
    return sorted(found)


def _why_without_maps(workspace, logs, name):
    """Of a photograph with a pose."""
    if reason := logs.why_left_out(name):
        return reason
    if not os.path.exists(workspace.path("images", name)):
        return "its file is not in the folder images"
    if workspace.listed is not None and name not in workspace.listed:
        return "stereo/patch-match.cfg does not list it"
    return "stereo has made no maps of it: it was stopped before, or left it out"


def _why_unregistered(num_features, num_matched):
    """Of a photograph that no model has."""
    if num_features == 0:
        return "no features were found in it"
    if num_matched == 0:
        return f"none of its {num_features} features could be matched with another photograph"
    others = "another photograph" if num_matched == 1 else f"{num_matched} other photographs"
    return f"it matches {others}, but no pose could be found for it"


def _other_models(workspace):
    """Reasons, by name, of photographs that other models of the same reconstruction have."""
    folder, reasons = os.path.join(workspace.project, "sparse"), {}
    for number in sorted(os.listdir(folder)) if os.path.isdir(folder) else []:
        for name in model_names.read_names(os.path.join(folder, number)) or []:
            reasons[name] = (f"it is in another model, sparse/{number}, whose place relative to "
                             "this one is not known")
    return reasons


def _check_tables(database):
    """A view in the place of a table is a program, which need not end."""
    found = {name for (name,) in database.execute(
        "SELECT name FROM sqlite_master WHERE type = 'table'")}
    missing = {"images", "keypoints", "two_view_geometries"} - found
    if missing:
        raise sqlite3.DatabaseError(f"there is no table {min(missing)}")


def _read_database(path):
    """By name: how many features a photograph has, and how many others it matches."""
    # Reading leaves files of its own beside a database that may change meanwhile.
    how = "mode=ro" if os.path.exists(path + "-wal") else "immutable=1"
    address = f"file:{urllib.parse.quote(os.path.abspath(path))}?{how}"
    try:
        with closing(sqlite3.connect(address, uri=True)) as database:
            database.text_factory = os.fsdecode  # Names of files may be no text.
            _check_tables(database)
            # A column may hold values of any type, and none.
            names = dict(database.execute(
                "SELECT image_id, CAST(name AS TEXT) FROM images "
                "WHERE typeof(image_id) = 'integer' AND name NOT NULL"))
            features = dict(database.execute(
                "SELECT image_id, rows FROM keypoints WHERE typeof(rows) = 'integer'"))
            pairs = list(database.execute(
                "SELECT pair_id FROM two_view_geometries "
                "WHERE typeof(pair_id) = 'integer' AND rows > 0"))
    # A message may quote what is no text; a damaged file may say that it takes all memory.
    except (sqlite3.Error, UnicodeDecodeError, MemoryError) as error:
        raise Failure(f"{path} is not a readable database of COLMAP ({error}); move it away to "
                      "make the page without it") from error
    matched = dict.fromkeys(names, 0)
    for (pair,) in pairs:
        for number in divmod(pair, _PAIR):
            matched[number] = matched.get(number, 0) + 1
    return {name: (features.get(number, 0), matched[number]) for number, name in names.items()}
