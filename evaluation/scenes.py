"""Scenes of examples/ that come without photographs: these are rendered before they are
evaluated, into OUT/scenes."""

import os

from . import machine, processes


PROGRAM = os.path.join(machine.ROOT, "examples", "generate.py")


def is_scene(data):
    """Whether a folder says how photographs are rendered, and has none."""
    return (os.path.isfile(os.path.join(data, "scene.pov"))
            and not os.path.isdir(os.path.join(data, "images")))


def rendered(data, out):
    """Where the data set of a folder is or will be: the folder itself unless it is a scene."""
    return os.path.join(out, "scenes", os.path.basename(data)) if is_scene(data) else data


def command(data, out):
    """What renders a scene, or finds that this has been done from the same files."""
    return [PROGRAM, os.path.basename(data), "--out", os.path.join(out, "scenes")]


def render(data, out):
    """Renders a scene unless it is there. Raises Failure."""
    if not os.path.isdir(rendered(data, out)):
        processes.say(f"{rendered(data, out)}: rendering, which takes minutes ...")
    processes.run(command(data, out), os.path.join(out, "scenes", "generate.log"))
