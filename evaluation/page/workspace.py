"""What stands in a dense workspace of COLMAP, as far as the page shows it."""

import functools
import glob
import os

from .. import binary_model, files, workspaces
from ..processes import Failure

_PASSES = ("geometric", "photometric")


class Workspace:
    """Read from a folder; raises Failure if it is no dense workspace or is damaged."""

    def __init__(self, folder):
        self.folder = folder
        model = self.path("sparse")
        if not os.path.isdir(model):
            raise Failure(f"{folder} is no dense workspace: it has no folder sparse; name a "
                          "folder such as DIR/dense or DIR/dense/0")
        # By name.
        self.views = {view.name: view for view in binary_model.read_any(model)}
        # Which maps there are, and those (workspaces.View).
        self.kind, self.maps = self._find_maps()
        self.clouds = sorted(path for path in self._files("fused*.ply")
                             if not path.endswith(".new.ply"))
        self.project = self._find_project()
        self.database = self.project and os.path.join(self.project, "database.db")

    def path(self, *parts):
        return os.path.join(self.folder, *parts)

    def _files(self, pattern):
        return glob.glob(os.path.join(glob.escape(self.folder), pattern))

    def _find_maps(self):
        for kind in _PASSES:
            try:
                maps = workspaces.list_views(self.folder, kind)
            except Failure:  # None of this kind.
                continue
            return kind, [view for view in maps if view.name in self.views]
        return "", []

    def _find_project(self):
        """The folder with the features of all photographs, as demo.sh and the automatic
        reconstructor lay it out; "" if there is none."""
        parent = os.path.dirname(os.path.abspath(self.folder))
        return next((folder for folder in (parent, os.path.dirname(parent))
                     if os.path.isfile(os.path.join(folder, "database.db"))), "")

    @functools.cached_property
    def listed(self):
        """Names of the photographs that stereo is to compute; None where no file says it."""
        path = self.path("stereo", "patch-match.cfg")
        if not os.path.exists(path):
            return None
        lines = files.read_bytes(path).decode("utf-8", errors="surrogateescape").splitlines()
        lines = [line.strip() for line in lines]
        return {line for line in [line for line in lines if line and line[0] != "#"][0::2]}

    def options(self):
        """Rows (option, value in each pass) of what made the maps, and the names of the passes."""
        passes = {kind: _read_options(self.path("stereo", f"options.{kind}.txt"))
                  for kind in reversed(_PASSES)}
        passes = {kind: values for kind, values in passes.items() if values}
        names = sorted({name for values in passes.values() for name in values})
        return list(passes), [(name, [values.get(name, "") for values in passes.values()])
                              for name in names]


def _read_options(path):
    """Values by name, of lines "name = value"; none where there is no file."""
    if not os.path.exists(path):
        return {}
    lines = files.read_bytes(path).decode("utf-8", errors="replace").splitlines()
    parts = [line.partition(" = ") for line in lines if not line.startswith("#")]
    return {name: value for name, equals, value in parts if equals}
