"""A small scene in the layout of ETH3D's archives, made from the built-in example.

It has what the archives of a real scene unpack to, for both tracks (dslr: high
resolution, rig: low): photographs as taken by a lens with ETH3D's THIN_PRISM_FISHEYE
model, undistorted ones, their calibrations, depth of the former as bare floats (with
gaps, as a laser scan leaves them), and laser scans of three places with their poses.
A scene of the test split has photographs and undistorted calibration alone.

The rig's four cameras are views of the example in turn; they are no rigid rig, but
differ in their intrinsics. This is for tests and for trying scripts/eth3d out. Its
figures say nothing about the benchmark.
"""

import os
from dataclasses import dataclass

import cv2
import numpy as np

from .. import colmap_model, depth_maps, depth_scans, files, machine
from ..processes import Failure
from ..steps import Step
from .scenes import TRACKS, Track

ROOM = os.path.join(machine.ROOT, "examples", "room")
# A lens like that of ETH3D's camera: k1, k2, p1, p2, k3, k4, sx1, sy1.
LENS = (0.21, 0.2, -1e-5, 5e-4, -0.16, 0.4, -1e-4, 9e-4)
# The photograph as taken shows a little less than the undistorted one.
ZOOM = 1.04
MEASURED_SHARE = 0.7  # Of the pixels of a depth map.
SCANNERS = ("room_01", "room_06", "room_11")


@dataclass(frozen=True)
class Photograph:
    """One photograph to be made: of which view, by which cameras, under which names."""
    view: colmap_model.View
    camera: int
    undistorted_name: str
    original_name: str


@dataclass(frozen=True)
class Part:
    """One track of the scene."""
    track: Track
    undistorted: list  # Cameras.
    originals: list  # Cameras, as many.
    photographs: list
    is_grey: bool


def lines_of(name):
    """A file of the example's model without its comments."""
    with open(os.path.join(ROOM, "sparse", name), encoding="utf-8") as file:
        return [line for line in file.read().rstrip("\n").split("\n") if line[:1] != "#"]


def pinhole(source, size, shift=0.0):
    """The example's camera for photographs of another size, with columns cut off."""
    scale = size / source.width
    width, height = round(size * (1 - abs(shift))), round(source.height * scale)
    focal = source.params[0] * scale
    return colmap_model.Camera("PINHOLE", width, height,
                               (focal, focal, width / 2 + shift * size / 2, height / 2))


def with_lens(camera):
    fx, fy, cx, cy = camera.pinhole
    return colmap_model.Camera(
        "THIN_PRISM_FISHEYE", camera.width, camera.height,
        (ZOOM * fx, ZOOM * fy * 0.999, cx + 0.8, cy - 0.6) + LENS)


def spread(views, count):
    """count of the views, one after the other, from the middle of the walk."""
    first = (len(views) - count) // 2
    return views[first:first + count]


def dslr_name(index):
    """Folder and name of a photograph."""
    return "dslr_images", f"DSC_{101 + 3 * index:04d}.JPG"


def rig_name(index):
    return (f"images_rig_cam{4 + index % 4}",
            f"{1477833684658155598 + 50000000 * (index // 4)}.png")


def part_of(track, views, size, shifts, name_of, is_grey):
    """The photographs of views by cameras that differ in their shifts, in turn."""
    undistorted = [pinhole(views[0].camera, size, shift) for shift in shifts]
    photographs = []
    for index, view in enumerate(views):
        folder, name = name_of(index)
        photographs.append(Photograph(view, index % len(shifts), f"{folder}_undistorted/{name}",
                                      f"{folder}/{name}"))
    return Part(TRACKS[track], undistorted, list(map(with_lens, undistorted)), photographs,
                is_grey)


def source_pixels(camera, source):
    """Where in another camera's photograph every pixel of a camera looks: x, y."""
    return colmap_model.project(source, *colmap_model.pixel_rays(camera))


def make_photograph(image, camera, source):
    """The example's photograph through another camera; black outside."""
    scale = max(camera.params[0] / source.params[0], 1e-3)
    small = cv2.resize(image, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    x, y = source_pixels(camera, source)
    x = x * small.shape[1] / source.width - 0.5
    y = y * small.shape[0] / source.height - 0.5
    return cv2.remap(small, x.astype(np.float32), y.astype(np.float32), cv2.INTER_LINEAR,
                     borderMode=cv2.BORDER_CONSTANT)


def blank(image, undistorted, original):
    """Black where the original photograph shows nothing, as ETH3D has it."""
    image[~original.contains(*source_pixels(undistorted, original))] = 0
    return image


def make_depth(depth, camera, source, rng):
    """The example's depth through another camera; infinite without measurement."""
    x, y = source_pixels(camera, source)
    inside = source.contains(x, y) & (rng.random(x.shape) < MEASURED_SHARE)
    column, row = np.where(inside, x, 0).astype(int), np.where(inside, y, 0).astype(int)
    return np.where(inside, depth[row, column], np.inf).astype("<f4")


def write_model(folder, cameras, photographs, names, source):
    """A text model with the example's points, seen in these photographs."""
    observations = colmap_model.read_observations(os.path.join(ROOM, "sparse"))
    poses = {int(line.split()[0]): line.split()[:8] for line in lines_of("images.txt")[0::2]}
    tracks, pixels = {}, {}
    for photograph in photographs:
        number, camera = photograph.view.number, cameras[photograph.camera]
        seen = observations[number]
        x, y = colmap_model.project(camera, *colmap_model.unproject(source, seen[:, 0],
                                                                    seen[:, 1]))
        keep = camera.contains(x, y)
        pixels[number] = list(zip(x[keep], y[keep], seen[keep, 2].astype(int)))
        for index, (_, _, point) in enumerate(pixels[number]):
            tracks.setdefault(point, []).append(f"{number} {index}")
    tracks = {point: track for point, track in tracks.items() if len(track) >= 2}
    lines = ["# Camera list with one line of data per camera:"]
    for number, camera in enumerate(cameras):
        lines.append(f"{number} {camera.model} {camera.width} {camera.height} "
                     + " ".join(f"{value:.9g}" for value in camera.params))
    write_lines(os.path.join(folder, "cameras.txt"), lines)
    lines = [f"# Number of images: {len(photographs)}"]
    for photograph, name in zip(photographs, names):
        number = photograph.view.number
        lines += [f"{' '.join(poses[number])} {photograph.camera} {name}",
                  " ".join(f"{x:.3f} {y:.3f} {point if point in tracks else -1}"
                           for x, y, point in pixels[number])]
    write_lines(os.path.join(folder, "images.txt"), lines)
    points = {int(line.split()[0]): line.split()[:8] for line in lines_of("points3D.txt")}
    write_lines(os.path.join(folder, "points3D.txt"),
                [" ".join(points[point] + tracks[point]) for point in sorted(tracks)])


def write_lines(path, lines):
    files.write_text(path, "\n".join(lines) + "\n")


def write_part(out, part, source, is_training, voxel_size):
    rng = np.random.default_rng(4)
    for photograph in part.photographs:
        stem = os.path.splitext(photograph.view.name)[0]
        image = cv2.imread(os.path.join(ROOM, "images", photograph.view.name),
                           cv2.IMREAD_GRAYSCALE if part.is_grey else cv2.IMREAD_COLOR)
        depth = depth_maps.read_png(os.path.join(ROOM, "gt_depth", stem + ".png"))
        undistorted = part.undistorted[photograph.camera]
        original = part.originals[photograph.camera]
        pictures = {photograph.undistorted_name:
                    blank(make_photograph(image, undistorted, source), undistorted, original)}
        if is_training:
            pictures[photograph.original_name] = make_photograph(image, original, source)
            files.write_bytes(os.path.join(out, "ground_truth_depth", photograph.original_name),
                              make_depth(depth, original, source, rng).tobytes())
        for name, picture in pictures.items():
            is_jpeg = name.endswith(".JPG")
            _, encoded = cv2.imencode(".jpg" if is_jpeg else ".png", picture,
                                      [cv2.IMWRITE_JPEG_QUALITY, 95] if is_jpeg else [])
            files.write_bytes(os.path.join(out, "images", name), encoded.tobytes())
    models = [(f"{part.track.tag}_calibration_undistorted", part.undistorted, "undistorted_name")]
    if is_training:
        models.append((part.track.original_calibration, part.originals, "original_name"))
    for folder, cameras, key in models:
        write_model(os.path.join(out, folder), cameras, part.photographs,
                    [getattr(photograph, key) for photograph in part.photographs], source)
    if is_training:
        scans = os.path.join(out, f"{part.track.tag}_scan_eval")
        depth_scans.make_scans(ROOM, scans, SCANNERS, voxel_size=voxel_size)
        os.remove(os.path.join(scans, "scans.json"))


class MakeMiniature(Step):
    """A scene in a folder that does not exist yet."""
    name = "miniature"

    def __init__(self, out, split, image_size, views, voxel_size):
        self._out = out
        self._is_training = split != "test"
        self._image_size = image_size
        self._num_views = views
        self._voxel_size = voxel_size

    def commands(self):
        return [f"# {self._out} from {ROOM}"]

    def run(self):
        views = colmap_model.read_views(os.path.join(ROOM, "sparse"))
        if not 2 <= self._num_views <= len(views) or self._image_size < 32:
            raise Failure(f"--views must be 2 to {len(views)} and --image_size at least 32")
        if os.path.exists(self._out):
            raise Failure(f"{self._out} exists already; name another folder or scene")
        chosen = spread(views, self._num_views)
        for part in (part_of("high", chosen, self._image_size, [0.0], dslr_name, False),
                     part_of("low", chosen, self._image_size * 3 // 4,
                             [-0.05, -0.02, 0.02, 0.05], rig_name, True)):
            write_part(self._out, part, views[0].camera, self._is_training, self._voxel_size)
        print(self._out)
