#!/usr/bin/python3
"""Makes up files for the readers of the evaluation, as the programs in this folder do for ours
in C++. Needs atheris, of the Python package index (scripts/fuzz.sh).

    tests/fuzz/readers_fuzz.py READER [WORD OF LIBFUZZER'S]...

A reader may refuse a file by a Failure of one line. Everything else is a finding.
"""

import os
import shutil
import sys
import tempfile

import atheris

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../.."))
with atheris.instrument_imports(include=["evaluation"]):
    from evaluation import (binary_model, cloud_scores, colmap_model, depth_maps, depth_scans,
                            depth_scores, files, meshlab_project, model_names, plan, point_clouds,
                            record)
    from evaluation.eth3d import scenes
    from evaluation.exchange import formats, layout
    from evaluation.page import confidence, left_out, logs
    from evaluation.processes import Failure

_MEMORY = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
_FOLDER = tempfile.mkdtemp(prefix="tapa-fuzz-", dir=_MEMORY)
_EXTENSIONS = formats.EXTENSIONS


def _write(name, data):
    path = os.path.join(_FOLDER, name)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(data)
    return path


def _one(name, read):
    """Of a reader of one file."""
    return lambda data: read(_write(name, data))


def _each(name, *readers):
    """Of several readers of one file, whatever the others think of it."""
    def read(data):
        path = _write(name, data)
        for reader in readers:
            _refusing(lambda: reader(path))
    return read


def _with_extension(read):
    """Of a reader that goes by the end of the name; the first byte chooses it."""
    def read_one(data):
        extension = _EXTENSIONS[data[0] % len(_EXTENSIONS)] if data else ".exr"
        read(_write("a" + extension, data[1:]))
    return read_one


def _model(extension, read):
    def read_parts(data):
        parts = [*data.split(b"----\n", 2), b"", b""]
        for name, part in zip(("cameras", "images", "points3D"), parts):
            _write(f"model{extension}/{name}{extension}", part)
        folder = os.path.join(_FOLDER, "model" + extension)
        views = read(folder)
        assert sorted(view.name for view in views) == sorted(model_names.read_names(folder))
        for view in views:
            colmap_model.project(view.camera, 0.1, 0.2)
    return read_parts


def _points(data):
    cloud = point_clouds.read_cloud(_write("a.ply", data))
    assert len(cloud.points) == cloud.kept.sum()


def _visibility(data):
    cloud = point_clouds.Cloud([], None, None, [True] * 2)
    _write("a.ply.vis", data)
    confidence.of_points(cloud, os.path.join(_FOLDER, "a.ply"))


def _json(data):
    for name in ("record.json", "depth_scores.json", "cloud_scores.json", "scans.json",
                 "maps.json", "a/set.json"):
        _write(name, data)
    for read in (record.load, depth_scores.load, cloud_scores.load, depth_scans.read_about,
                 layout.read_record, scenes.prepared_scenes):
        _refusing(lambda: read(_FOLDER))


_READERS = {
    "ply": _points,
    "visibility": _visibility,
    "meshlab_project": _one("a.mlp", meshlab_project.read),
    "evaluation_text_model": _model(".txt", colmap_model.read_views),
    "evaluation_binary_model": _model(".bin", binary_model.read_views),
    "evaluation_map": _each("a.bin", depth_maps.read_map,
                            lambda path: depth_maps.read_map(path, 3)),
    "graph": _one("a.bin", lambda path: confidence.read_graph(path, (2, 3))),
    "numbers": _with_extension(lambda path: formats.read_numbers(path, 1)),
    "normals": _with_extension(formats.read_normals),
    "json": _json,
    "plan": _one("plan.toml", lambda path: plan.Plan(path, "", _FOLDER)),
    "log": _one("a.log", lambda path: logs.Logs([_FOLDER])),
    "database": _one("database.db", left_out._read_database),
}


def _refusing(read):
    try:
        read()
    except Failure as error:
        assert "\n" not in str(error), error


def main():
    read = _READERS[sys.argv.pop(1)]
    atheris.Setup(sys.argv, lambda data: _refusing(lambda: read(data)))
    try:
        atheris.Fuzz()
    finally:
        shutil.rmtree(_FOLDER, ignore_errors=True)


if __name__ == "__main__":
    main()
