"""The layout in which ETH3D takes results.

One folder per track, high_res_multi_view or low_res_many_view, with SCENE.ply and
SCENE.txt for every scene of the training and the test split; the text file has the line
"runtime SECONDS". The folder is uploaded as a 7z archive.
"""

import os
import re
import shutil

from .. import files, processes, run_record
from .download import seven_zip
from ..processes import Failure


def check_cloud(path):
    """Raises Failure unless a file is a binary little-endian PLY with points."""
    try:
        with open(path, "rb") as file:
            head = file.read(4096)
    except OSError as error:
        raise Failure(f"{path} cannot be read: {error.strerror}") from error
    count = re.search(rb"\nelement vertex (\d+)\s", head)
    if not head.startswith(b"ply") or b"format binary_little_endian 1.0" not in head:
        raise Failure(f"{path} is no binary little-endian PLY, which ETH3D asks for")
    if count is None or int(count[1]) == 0:
        raise Failure(f"{path} holds no points")


def runtime_text(record, cloud):
    """The content of a scene's text file."""
    seconds = run_record.total_seconds(record, cloud)
    if seconds is None:
        raise Failure("it is not known how long the run took, as part of it was killed or made "
                      "by another program; remove the run and make it again")
    return f"runtime {seconds:.3f}\n"


def add_scene(folder, scene_name, run_folder, cloud):
    """Puts a scene's cloud and time into the folder of its track."""
    record = run_record.load(run_folder)
    if record is None:
        raise Failure(f"{run_folder} has no run; make it with scripts/eth3d run")
    source = os.path.join(run_folder, cloud + ".ply")
    check_cloud(source)
    text = runtime_text(record, cloud)
    os.makedirs(folder, exist_ok=True)
    target = os.path.join(folder, scene_name + ".ply")
    if os.path.exists(target):
        os.remove(target)
    try:
        os.link(source, target)  # Clouds are large.
    except OSError:
        shutil.copyfile(source, target)
    files.write_text(os.path.join(folder, scene_name + ".txt"), text)


def pack_command(folder):
    """The command, to be run in the folder above, that packs a track's folder."""
    name = os.path.basename(folder)
    return [seven_zip(), "a", "-t7z", "-bd", name + ".new.7z", name]


def pack(folder):
    """Makes FOLDER.7z; returns its path."""
    above, name = os.path.split(folder)
    new = os.path.join(above, name + ".new.7z")
    if os.path.exists(new):
        os.remove(new)
    command = ["env", "-C", above, *pack_command(folder)]
    processes.run(command, os.path.join(above, name + ".log"))
    os.replace(new, folder + ".7z")
    os.remove(os.path.join(above, name + ".log"))
    return folder + ".7z"
