"""COLMAP's dense workspaces, and such of links to some maps or to those of another tool."""

import os
from typing import NamedTuple

from . import files, model_names
from .processes import Failure

_KINDS = (".geometric", ".photometric", "")


class View(NamedTuple):
    """A view with a depth map. name: of the photograph; other files may not be there."""
    name: str
    photograph: str
    depth: str
    normals: str


def list_views(workspace, input_type):
    """Views with a map of a type, geometric or photometric, in the order of their names."""
    maps = os.path.join(workspace, "stereo", "depth_maps")
    for what, folder in (("workspace", workspace), ("folder of depth maps", maps)):
        if not os.path.isdir(folder):
            raise Failure(f"no {what} at {folder}")
    end = f".{input_type}.bin"
    names = [name.removesuffix(end) for name in files.names_below(maps)
             if name.endswith(end) and name != end]
    if not names:
        raise Failure(f"no {input_type} depth map in {maps}")
    return [View(name, os.path.join(workspace, "images", name), os.path.join(maps, name + end),
                 os.path.join(workspace, "stereo", "normal_maps", name + end))
            for name in sorted(names)]


def photographs(data, every=1):
    """Names of the photographs of the model that take part, as in make_workspace.sh."""
    return model_names.photographs(data)[::every]


def link(source, target):
    """Makes a link, in place of what was there."""
    os.makedirs(os.path.dirname(target), exist_ok=True)
    if os.path.lexists(target):
        os.remove(target)
    os.symlink(os.path.abspath(source), target)


def _map_folders(path):
    """The folders of depth and of normal maps of a workspace or, for its own, of a folder of
    depth maps."""
    inside = os.path.join(path, "stereo", "depth_maps")
    depth_maps = inside if os.path.isdir(inside) else path
    return depth_maps, os.path.join(os.path.dirname(depth_maps), "normal_maps")


def _find_kind(path, names):
    """Which maps there are of photographs, None for none."""
    folder, _ = _map_folders(path)
    return next((kind for kind in _KINDS for name in names
                 if os.path.exists(os.path.join(folder, f"{name}{kind}.bin"))), None)


def find_view(data, maps, name):
    """A photograph of data with its map in a workspace or folder of maps, None for none."""
    kind = _find_kind(maps, [name])
    return None if kind is None else View(
        name, os.path.join(data, "images", name),
        *(os.path.join(folder, f"{name}{kind}.bin") for folder in _map_folders(maps)))


def make_view_workspace(data, maps, folder, names):
    """Links the photographs of data and the maps of these names into folder.

    maps: a COLMAP workspace, or a folder of depth maps. What they are called,
    they become geometric ones. Raises Failure if there are none.
    """
    kind = _find_kind(maps, names)
    if kind is None:
        name = names[0] if names else "PHOTOGRAPH"
        raise Failure(f"{maps} has no depth map of {name}: it should be called "
                      f"{name}.geometric.bin")
    for name in names:
        for source, target in zip(_map_folders(maps), ("depth_maps", "normal_maps")):
            path = os.path.join(source, f"{name}{kind}.bin")
            if os.path.exists(path):
                link(path, os.path.join(folder, "stereo", target, f"{name}.geometric.bin"))
        link(os.path.join(data, "images", name), os.path.join(folder, "images", name))
