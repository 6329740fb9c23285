"""From a scene of ETH3D, as its archives unpack, to a set of this project.

A set (see examples/room/README.md) has images/ and sparse/, here links to the scene's
undistorted photographs and their model, scans/, a link to its laser scans, and
gt_depth/. ETH3D's depth maps belong to the photographs as they were taken, with the
lens's distortion. They are sampled at the rays of the undistorted photographs' pixels;
the depth z of a point does not depend on the distortion.
"""

import os

import numpy as np

from .. import colmap_model, depth_maps, files, processes
from ..processes import Failure
from ..steps import Step

MODEL_FILES = ("cameras.txt", "images.txt", "points3D.txt")
MAX_POSE_DIFFERENCE = 1e-3  # Metres, and entries of the rotation.
# How far the median of measured depth over that of the model's points may be from 1.
MAX_DEPTH_DISAGREEMENT = 0.05
CHECKED_VIEWS = 8


def _link(target, link):
    """A relative link, so that the folder of everything can be moved."""
    os.makedirs(os.path.dirname(link), exist_ok=True)
    text = os.path.relpath(os.path.realpath(target), os.path.realpath(os.path.dirname(link)))
    if os.path.islink(link):
        if os.readlink(link) == text:
            return
        os.remove(link)
    os.symlink(text, link)


def _scaled(camera, size):
    """The camera of a photograph made smaller so that no side exceeds size."""
    factor = min(1.0, size / max(camera.width, camera.height)) if size > 0 else 1.0
    return camera.resized(max(1, round(camera.width * factor)),
                          max(1, round(camera.height * factor)))


def sampled_pixels(original, undistorted):
    """Which pixel of the original photograph every undistorted pixel shows.

    Index into the original's pixels row by row, (height, width) of the undistorted
    camera; -1 where the ray is outside the original photograph.
    """
    x, y = colmap_model.project(original, *colmap_model.pixel_rays(undistorted))
    inside = original.contains(x, y)
    column = np.where(inside, x, 0).astype(np.int64)
    row = np.where(inside, y, 0).astype(np.int64)
    return np.where(inside, row * original.width + column, -1)


def warp(depth, pixels):
    """Depth at the pixels that sampled_pixels returned; 0 where there is none."""
    return np.where(pixels >= 0, depth.ravel()[np.maximum(pixels, 0)], 0).astype(np.float32)


def original_name(name):
    """Of the photograph as it was taken, from the undistorted one's name."""
    folder, base = os.path.split(name)
    return os.path.join(folder.removesuffix("_undistorted"), base)


def _find_originals(scene_path, scene, views):
    """The views as they were taken, by the names of the undistorted ones."""
    folder = os.path.join(scene_path, scene.track.original_calibration)
    originals = {view.name: view for view in colmap_model.read_views(folder)}
    taken = {}
    for view in views:
        original = originals.get(original_name(view.name))
        if original is None:
            continue
        difference = max(np.abs(original.rotation - view.rotation).max(),
                         np.abs(original.translation - view.translation).max())
        if difference > MAX_POSE_DIFFERENCE:
            raise Failure(f"{folder}: the pose of {original.name} is another than that of "
                             f"{view.name}; unpack both archives of the scene again")
        taken[view.name] = original
    return taken


def depth_folder(scene_path, scene):
    """Where the scene's depth maps are, "" if they or the lens are missing."""
    folder = os.path.join(scene_path, "ground_truth_depth")
    calibration = os.path.join(scene_path, scene.track.original_calibration)
    return folder if os.path.isdir(folder) and os.path.isdir(calibration) else ""


def _prepare_depth(scene_path, scene, views, out, size):
    """Writes gt_depth; returns the number of maps."""
    folder = depth_folder(scene_path, scene)
    originals = _find_originals(scene_path, scene, views) if folder else {}
    pixels = {}
    count = 0
    for view in views:
        original = originals.get(view.name)
        source = os.path.join(folder, original.name) if original else ""
        if not os.path.isfile(source):
            continue
        target = os.path.join(out, "gt_depth", os.path.splitext(view.name)[0] + ".bin")
        if not os.path.isfile(target):
            cameras = (original.camera, view.camera)
            if cameras not in pixels:
                pixels[cameras] = sampled_pixels(original.camera, _scaled(view.camera, size))
            depth = depth_maps.read_raw(source, original.camera.width, original.camera.height)
            depth_maps.write_bin(target, warp(depth, pixels[cameras]))
        count += 1
    return count


def depth_agreement(model, views, gt_depth):
    """Median of measured depth over the depth of the model's points at their pixels.

    None where no point has a measurement. Looks at some of the views.
    """
    points = colmap_model.read_points(model)
    observations = colmap_model.read_observations(model)
    ratios = []
    for view in views[::max(1, len(views) // CHECKED_VIEWS)]:
        path = depth_maps.find(gt_depth, view.name)
        seen = [row for row in observations.get(view.number, ()) if int(row[2]) in points]
        if not path or not seen:
            continue
        depth = depth_maps.read(path)
        x, y = (np.array([row[axis] for row in seen]) for axis in (0, 1))
        column = np.clip(x * depth.shape[1] / view.camera.width, 0, depth.shape[1] - 1)
        row = np.clip(y * depth.shape[0] / view.camera.height, 0, depth.shape[0] - 1)
        measured = depth[row.astype(int), column.astype(int)]
        world = np.array([points[int(entry[2])] for entry in seen])
        z = world @ view.rotation[2] + view.translation[2]
        known = (measured > 0) & (z > 0)
        ratios.append(measured[known] / z[known])
    ratios = np.concatenate(ratios) if ratios else np.empty(0)
    return float(np.median(ratios)) if len(ratios) else None


def _check_depth(model, views, out):
    """Raises Failure if measured depth is not that of these photographs."""
    ratio = depth_agreement(model, views, os.path.join(out, "gt_depth"))
    if ratio is not None and abs(ratio - 1) > MAX_DEPTH_DISAGREEMENT:
        raise Failure(f"{out}/gt_depth is {ratio:.3f} times as deep as the points of the model; "
                      "depth maps and photographs are not of the same scene, or not of the "
                      "same unit")
    return ratio


def _check_photographs(scene_path, views):
    for view in views:
        if view.camera.model != "PINHOLE":
            raise Failure(f"{view.name} has the camera model {view.camera.model}, but an "
                             "undistorted photograph has PINHOLE")
        path = os.path.join(scene_path, "images", view.name)
        if not os.path.isfile(path):
            raise Failure(f"{path} is missing; unpack the scene's undistorted photographs")


def _check_depth_size(out, depth_size):
    """Maps of two sizes are not mixed; depth_size stands beside the first of them."""
    path = os.path.join(out, "gt_depth", "size.txt")
    if not os.path.isfile(path):
        files.write_text(path, f"{depth_size}\n")
        return
    with open(path, encoding="ascii") as file:
        before = file.read().strip()
    if before != str(depth_size):
        raise Failure(f"{out}/gt_depth was made with --depth_size {before}; remove it "
                      f"to make it with {depth_size}")


class Prepare(Step):
    """A set, made or completed. What exists in it is not made again."""
    name = "set"

    def __init__(self, scene, scene_path, out, depth_size=2000):
        """depth_size: the longest side of gt_depth's maps in pixels, 0: as the photographs."""
        self._scene = scene
        self._scene_path = scene_path
        self._out = out
        self._depth_size = depth_size

    def commands(self):
        return [f"# {self._out}: links to {self._scene_path}, gt_depth from "
                + (depth_folder(self._scene_path, self._scene) or "nothing")]

    def run(self):
        scene, scene_path, out = self._scene, self._scene_path, self._out
        calibration = os.path.join(scene_path, f"{scene.track.tag}_calibration_undistorted")
        for name in MODEL_FILES:
            if not os.path.isfile(os.path.join(calibration, name)):
                raise Failure(f"{calibration} has no {name}; unpack {scene.archives()[0]} into "
                              f"{os.path.dirname(scene_path)}")
        views = colmap_model.read_views(calibration)
        _check_photographs(scene_path, views)
        scans = os.path.join(scene_path, f"{scene.track.tag}_scan_eval")
        if (os.path.isdir(scans)
                and not os.path.isfile(os.path.join(scans, "scan_alignment.mlp"))):
            raise Failure(f"{scans} has no scan_alignment.mlp; unpack the scans again")
        if depth_folder(scene_path, scene):
            _check_depth_size(out, self._depth_size)

        for view in views:
            _link(os.path.join(scene_path, "images", view.name),
                  os.path.join(out, "images", view.name))
        for name in MODEL_FILES:
            _link(os.path.join(calibration, name), os.path.join(out, "sparse", name))
        if os.path.isdir(scans):
            _link(scans, os.path.join(out, "scans"))
        count = _prepare_depth(scene_path, scene, views, out, self._depth_size)
        if count == 0 and depth_folder(scene_path, scene):
            processes.say(f"WARNING: {scene.set_name}: no depth map is at "
                          f"{scene_path}/ground_truth_depth/{original_name(views[0].name)}")
        files.write_json(os.path.join(out, "set.json"), {
            "scene": scene.name, "resolution": scene.resolution, "split": scene.split,
            "photographs": len(views), "scans": os.path.isdir(scans), "depth_maps": count,
            "depth_size": self._depth_size,
            "depth_over_points": _check_depth(calibration, views, out)})
        processes.say(f"{out}: {len(views)} photographs, {count} depth maps, "
                      f"{'with' if os.path.isdir(scans) else 'without'} scans")
