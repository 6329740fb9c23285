"""Workspaces of links: some maps of a workspace, or those of another tool."""

import os

from .processes import Failure

_KINDS = ("geometric", "photometric")


def photographs(data, every=1):
    """Names of the photographs that take part, as in make_workspace.sh."""
    root = os.path.join(data, "images")
    names = []
    for folder, _, entries in os.walk(root, followlinks=True):
        names += [os.path.relpath(os.path.join(folder, entry), root)
                  for entry in entries]
    return sorted(names, key=os.fsencode)[::every]


def link(source, target):
    """Makes a link, in place of what was there."""
    os.makedirs(os.path.dirname(target), exist_ok=True)
    if os.path.lexists(target):
        os.remove(target)
    os.symlink(os.path.abspath(source), target)


def map_folder(path):
    """The folder of depth maps in a workspace, or the folder itself."""
    inside = os.path.join(path, "stereo", "depth_maps")
    return inside if os.path.isdir(inside) else path


def find_kind(path, names):
    """Which maps there are: geometric, photometric, or "" for NAME.bin.

    Raises Failure if there are none of these photographs.
    """
    folder = map_folder(path)
    for kind in (*_KINDS, ""):
        if any(os.path.exists(_map_path(folder, name, kind))
               for name in names):
            return kind
    name = names[0] if names else "PHOTOGRAPH"
    raise Failure(f"{path} has no depth map of {name}: it should be called "
                  f"{name}.geometric.bin")


def find_map(path, name):
    """Path of a photograph's map in a workspace or folder of maps, "" if none."""
    for kind in (*_KINDS, ""):
        found = _map_path(map_folder(path), name, kind)
        if os.path.exists(found):
            return found
    return ""


def _map_path(folder, name, kind):
    return os.path.join(folder, f"{name}.{kind}.bin" if kind else f"{name}.bin")


def make_view_workspace(data, maps, folder, names):
    """Links the photographs of data and the maps of these names into folder.

    maps: a COLMAP workspace, or a folder of depth maps. What they are called,
    they become geometric ones. Returns the number of maps.
    """
    kind = find_kind(maps, names)
    depth_maps = map_folder(maps)
    normal_maps = os.path.join(os.path.dirname(depth_maps), "normal_maps")
    count = 0
    for name in names:
        for source, target in ((depth_maps, "depth_maps"),
                               (normal_maps, "normal_maps")):
            path = _map_path(source, name, kind)
            if os.path.exists(path):
                link(path, os.path.join(folder, "stereo", target,
                                         f"{name}.geometric.bin"))
                count += target == "depth_maps"
        link(os.path.join(data, "images", name),
              os.path.join(folder, "images", name))
    return count
