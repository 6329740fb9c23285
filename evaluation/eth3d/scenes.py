"""The scenes of ETH3D's multi-view benchmark, their archives and their folders.

Schoeps et al., "A Multi-View Stereo Benchmark with High-Resolution Images and
Multi-Camera Videos", CVPR 2017. The names are those of the benchmark's public site.
"""

import os
from dataclasses import dataclass

from .. import files, schemas
from ..methods import FUSION_HIGH, FUSION_LOW
from ..processes import Failure

# Where the archives are. Everything else here is relative to it.
BASE_URL = "https://www.eth3d.net/data"


@dataclass(frozen=True)
class Track:
    """One of the two parts of the benchmark."""
    name: str  # As in the leaderboard and in submissions.
    tag: str  # In names of archives and folders.
    originals: str  # Archive of the photographs as they were taken.
    original_calibration: str  # Folder of their calibration.
    fusion: list  # Options of stereo_fusion with TAPA's thresholds.


TRACKS = {
    "high": Track("high_res_multi_view", "dslr", "dslr_jpg", "dslr_calibration_jpg", FUSION_HIGH),
    "low": Track("low_res_many_view", "rig", "rig", "rig_calibration", FUSION_LOW),
}

_NAMES = {
    ("high", "training"): "courtyard delivery_area electro facade kicker meadow office pipes "
                          "playground relief relief_2 terrace terrains",
    ("high", "test"): "botanical_garden boulders bridge door exhibition_hall lecture_room "
                      "living_room lounge observatory old_computer statue terrace_2",
    ("low", "training"): "delivery_area electro forest playground terrains",
    ("low", "test"): "lakeside sand_box storage_room storage_room_2 tunnel",
}


@dataclass(frozen=True)
class Scene:
    """A scene in one of the tracks."""
    name: str
    resolution: str  # "high" or "low".
    split: str  # "training", with the truth, or "test", without.

    @property
    def track(self):
        return TRACKS[self.resolution]

    @property
    def set_name(self):
        """Name of the set that `prepare` makes of it; scenes may be in both tracks."""
        return f"{self.name}_{self.track.tag}"

    def archives(self, with_depth=True):
        """Names of the archives on the site; each holds one folder, the scene's name."""
        kinds = [f"{self.track.tag}_undistorted"]
        if self.split == "training":
            kinds.append(f"{self.track.tag}_scan_eval")
            if with_depth:
                kinds += [self.track.originals, f"{self.track.tag}_depth"]
        return [f"{self.name}_{kind}.7z" for kind in kinds]


def all_scenes():
    return [Scene(name, resolution, split) for (resolution, split), names in _NAMES.items()
            for name in names.split()]


def _folders(path):
    return sorted(os.listdir(path)) if os.path.isdir(path) else []


def unpacked_scenes(folder):
    """Scenes whose undistorted photographs are in a folder, known to the site or not."""
    scenes = []
    splits = {(scene.name, scene.resolution): scene.split for scene in all_scenes()}
    for name in _folders(folder):
        for resolution, track in TRACKS.items():
            inside = os.path.join(folder, name, track.tag)
            if os.path.isdir(inside + "_calibration_undistorted"):
                split = "training" if os.path.isdir(inside + "_scan_eval") else "test"
                scenes.append(Scene(name, resolution, splits.get((name, resolution), split)))
    return scenes


class SetDescription(schemas.Model):
    """set.json, as far as it is read."""
    scene: schemas.Text
    resolution: schemas.Text
    split: schemas.Text


def prepared_scenes(folder):
    """Scenes that `prepare` has made sets of, from their set.json."""
    contents = [files.read_json(os.path.join(folder, name, "set.json"), SetDescription)
                for name in _folders(folder)]
    return [Scene(content.scene, content.resolution, content.split)
            for content in contents if content is not None]


def select(scenes, resolution="high", split="training", names=None):
    """Those of the scenes that are wanted; raises Failure if a name is unknown.

    resolution and split may be "both"; names are those of scenes or of sets.
    """
    chosen = [scene for scene in scenes if resolution in (scene.resolution, "both")
              and split in (scene.split, "both")]
    if names is None:
        return chosen
    for name in names:
        if not any(name in (scene.name, scene.set_name) for scene in chosen):
            raise Failure(
                f"there is no scene {name} of {resolution} resolution in the {split} split; "
                "there are " + (", ".join(scene.set_name for scene in chosen) or "none"))
    return [scene for scene in chosen if scene.name in names or scene.set_name in names]
