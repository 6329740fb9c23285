"""Depth maps and normals of any program become geometric maps of a workspace.

They are never taken for maps that patch_match_stereo made: the record of its options goes, as that
is about all maps beside it.
"""

import os

from .. import depth_maps, files, progress
from ..page.workspace import Workspace
from ..processes import Failure
from . import layout


class Target:
    """The geometric maps of a workspace."""

    def __init__(self, folder, overwrites=False):
        self._workspace = Workspace(folder)
        self._overwrites = overwrites
        self.views = list(self._workspace.views.values())
        for view in self.views:
            if "PINHOLE" not in view.camera.model:
                raise Failure(f"{folder} is no dense workspace: the camera of {view.name} has "
                              "distortion; run image_undistorter first")

    def check(self):
        """Raises Failure if patch_match_stereo made maps, which must not be mixed unawares."""
        record = self._record_path("options")
        if (os.path.lexists(record) and self._workspace.kind == "geometric"
                and not self._overwrites):
            raise Failure(
                f"patch_match_stereo made geometric maps of {self._workspace.folder}, as {record} "
                "says; name another workspace, or take --overwrite, which removes that record, as "
                "imported maps do not come from its options")

    def write(self, name, depth, normals):
        """Writes the maps of a photograph, unless just these are there."""
        contents = {self._path("normal_maps", name): depth_maps.encode_bin(normals),
                    self._path("depth_maps", name): depth_maps.encode_bin(depth)}
        others = [path for path, content in contents.items()
                  if os.path.exists(path) and files.read_bytes(path) != content]
        if others and not self._overwrites:
            raise Failure(f"{others[0]} is there, and another map; remove it, or take --overwrite")
        if not others and all(map(os.path.exists, contents)):
            return
        self._forget(name)
        for path, content in contents.items():
            files.write_bytes(path, content)

    def _forget(self, name):
        """Removes what is known of the maps that a photograph has had so far."""
        for path in (self._record_path("options"), self._path("consistency_graphs", name)):
            if os.path.lexists(path):
                os.remove(path)
        record = self._record_path("views")
        if os.path.lexists(record):
            lines = files.read_bytes(record).split(b"\n")
            # The name of the photograph stands behind five other words.
            kept = [line for line in lines if line.startswith(b"#")
                    or line.split(b" ", 5)[-1] != os.fsencode(name)]
            if kept != lines:
                files.write_bytes(record, b"\n".join(kept))

    def _record_path(self, what):
        return self._workspace.path("stereo", f"{what}.geometric.txt")

    def _path(self, folder, name):
        return self._workspace.path("stereo", folder, f"{name}.geometric.bin")


def import_maps(source, target):
    """Returns what was done, in words."""
    tasks = source.find(target.views)
    target.check()
    empty, computed = [], 0
    for task in progress.each(tasks, "importing", lambda task: task.view.name):
        depth, normals, from_file = source.read(task)
        target.write(task.view.name, depth, normals)
        computed += not from_file
        if not depth.any():
            empty.append(task.depth)
    layout.warn(empty, "files have no depth at all")
    imported = {task.view.name for task in tasks}
    layout.warn([view.name for view in target.views if view.name not in imported],
                "photographs have no file")
    return (f"maps of {len(tasks)} of {len(target.views)} photographs"
            + (f", {computed} of them with normals computed from depth" if computed else ""))
