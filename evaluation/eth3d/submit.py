"""The layout in which ETH3D takes results.

One folder per track, high_res_multi_view or low_res_many_view, with SCENE.ply and
SCENE.txt for every scene of the training and the test split; the text file has the line
"runtime SECONDS". The folder is uploaded as a 7z archive.
"""

import os
import re
import shutil

from .. import files, processes, record
from ..processes import Failure
from ..steps import Step
from .download import seven_zip
from .scenes import all_scenes


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


class AddScene(Step):
    """A scene's cloud and time in the folder of its track."""
    name = "submission"
    is_quick = True

    def __init__(self, folder, scene_name, run_folder, cloud):
        self._folder = folder
        self._scene = scene_name
        self._run = run_folder
        self._cloud = cloud

    def commands(self):
        return [f"# {self._folder}/{self._scene}.ply from {self._run}/{self._cloud}.ply"]

    def run(self):
        content = record.load(self._run)
        if content is None:
            raise Failure(f"{self._run} has no run; make it with scripts/eth3d run")
        source = os.path.join(self._run, self._cloud + ".ply")
        check_cloud(source)
        seconds = content.total_seconds(self._cloud)
        if seconds is None:
            raise Failure("it is not known how long the run took, as part of it was killed or "
                          "made by another program; remove the run and make it again")
        with files.replacing(os.path.join(self._folder, self._scene + ".ply")) as new:
            try:
                os.link(source, new)  # Clouds are large.
            except OSError:
                shutil.copyfile(source, new)
        files.write_text(os.path.join(self._folder, self._scene + ".txt"),
                         f"runtime {seconds:.3f}\n")


class Pack(Step):
    """FOLDER.7z of a track's folder."""
    name = "archive"

    def __init__(self, folder):
        self._folder = folder
        self._new = folder + ".new.7z"

    def commands(self):
        above, name = os.path.split(self._folder)
        return [["env", "-C", above, seven_zip(), "a", "-t7z", "-bd",
                 os.path.basename(self._new), name]]

    def run(self):
        if os.path.exists(self._new):
            os.remove(self._new)
        log = self._folder + ".log"
        processes.run(self.commands()[0], log)
        os.replace(self._new, self._folder + ".7z")
        os.remove(log)
        print(self._folder + ".7z")
        self._warn_of_missing()

    def _warn_of_missing(self):
        """The server asks for the scenes of both splits."""
        track = os.path.basename(self._folder)
        missing = [scene.name for scene in all_scenes() if scene.track.name == track
                   and not os.path.exists(os.path.join(self._folder, scene.name + ".ply"))]
        if missing:
            processes.say(f"WARNING: {track} is without {len(missing)} of the benchmark's "
                          f"scenes: {', '.join(missing)}")
