#!/usr/bin/python3
"""Makes laser scans from depth maps: what a scanner at a camera's place would measure.

    evaluation/depth_scans.py DATA OUT [--scanners NAMES] [--voxel_size METRES]

DATA has sparse/ (a COLMAP text model) and gt_depth/ (see examples/room/README.md). One
file OUT/scanN.ply per scanner and OUT/scan_alignment.mlp, a MeshLab project with their
poses, are what scripts/evaluate_point_cloud takes as the truth.

Every point is a pixel that was measured, on the ray through its centre. Nothing is
interpolated, so there are no points in the air between a near and a far surface, and
what one place does not see is missing from its scan. The frame of a scan is the
scanner's own, as that of a levelled instrument: x forward, y left, z up, origin at the
camera. Units are those of the model.

A scan from a depth map is sparser than that of an instrument. Points of a reconstruction
between its beams cannot be judged, right or wrong; OUT/scans.json says how wide beams
would have to be to leave no gaps (evaluate_point_cloud --beam_divergence_halfangle_deg).
"""

import os
import sys
from typing import Optional

import numpy as np

if not __package__:  # Started as a program.
    sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from evaluation import (colmap_model, command_line, depth_maps, files, meshlab_project,
                        point_clouds, schemas)
from evaluation.processes import Failure

# From a camera's frame (x right, y down, z forward) to the scanner's.
SCANNER_FROM_CAMERA = np.array(((0., 0., 1.), (-1., 0., 0.), (0., -1., 0.)))


class About(schemas.Model):
    """scans.json. made_from: a fingerprint of depth and poses."""
    beam_divergence_halfangle_deg: schemas.Number
    made_from: Optional[schemas.Text]


def scan_points(view, depth):
    """Points, (n, 3), in the scanner's frame of the pixels of a depth map.

    The map may be smaller or larger than the photograph, not of another shape.
    """
    height, width = depth.shape
    scale = (view.camera.width / width, view.camera.height / height)
    rows, columns = np.nonzero(depth > 0)
    u, v = colmap_model.unproject(view.camera, (columns + 0.5) * scale[0], (rows + 0.5) * scale[1])
    z = depth[rows, columns].astype(np.float64)
    points = np.stack((u * z, v * z, z), axis=1) @ SCANNER_FROM_CAMERA.T
    return points[np.isfinite(points).all(axis=1)]


def thin(points, voxel_size):
    """Of the points in each cube of a grid the one that is closest to the cube's centre.

    Points are left out, never moved or averaged. Returns them in their order.
    """
    cubes = np.floor(points / voxel_size).astype(np.int64)
    distance = ((points - (cubes + 0.5) * voxel_size) ** 2).sum(axis=1)
    order = np.lexsort((distance, cubes[:, 2], cubes[:, 1], cubes[:, 0]))
    ordered = cubes[order]
    first = np.ones(len(order), bool)
    first[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    return points[np.sort(order[first])]


def scanner_to_world(view):
    """Matrix, (4, 4), of the scanner's frame at a camera."""
    turn = np.eye(4)
    turn[:3, :3] = SCANNER_FROM_CAMERA.T
    return view.camera_to_world() @ turn


def beam_halfangle(view, depth):
    """Half the angle in degrees between the rays of neighbouring pixels in the centre."""
    return float(np.degrees(np.arctan(0.5 * view.camera.width / depth.shape[1]
                                      / view.camera.pinhole[0])))


def choose_scanners(views, names=None):
    """The views that are scanners: those named, or all."""
    if names is None:
        return views
    known = {}
    for view in views:
        for key in (view.name, os.path.splitext(os.path.basename(view.name))[0]):
            known[key] = view
    unknown = [name for name in names if name not in known]
    if unknown:
        raise Failure(f"there is no photograph {unknown[0]} in the model; its first is "
                         f"{views[0].name}")
    return [known[name] for name in names]


def make_scans(data, out, names=None, voxel_size=0.0):
    """Writes the scans of a data set. Returns the path of the MeshLab project.

    Raises Failure if the data cannot be used; the project is written last.
    """
    views = choose_scanners(colmap_model.read_views(os.path.join(data, "sparse")), names)
    measured = [(view, depth_maps.find(os.path.join(data, "gt_depth"), view.name))
                for view in views]
    missing = [view.name for view, path in measured if not path]
    if len(missing) == len(views) or (names is not None and missing):
        raise Failure(f"{data}/gt_depth has no depth of {missing[0]}")
    os.makedirs(out, exist_ok=True)
    scans, angles, counts = [], [], []
    for view, path in measured:
        if not path:
            continue
        depth = depth_maps.read(path)
        points = scan_points(view, depth)
        if voxel_size > 0:
            points = thin(points, voxel_size)
        if len(points) == 0:
            continue
        name = f"scan{len(scans) + 1}.ply"
        point_clouds.write_ply(os.path.join(out, name), points)
        scans.append((name, scanner_to_world(view)))
        angles.append(beam_halfangle(view, depth))
        counts.append({"scan": name, "photograph": view.name, "points": len(points)})
    if not scans:
        raise Failure(f"the depth maps in {data}/gt_depth hold no depth to scan")
    files.write_json(os.path.join(out, "scans.json"),
                     {"beam_divergence_halfangle_deg": max(angles), "scans": counts,
                      "made_from": _source(data)})
    project = os.path.join(out, "scan_alignment.mlp")
    meshlab_project.write(project, scans)
    return project


def _source(data):
    return files.fingerprint(os.path.join(data, "gt_depth"), os.path.join(data, "sparse"))


def read_about(out):
    """What OUT/scans.json says, None where there is none."""
    return files.read_json(os.path.join(out, "scans.json"), About)


def are_of_other_data(data, out):
    """Whether scans are not of the depth and the poses that a data set has now."""
    about = read_about(out)
    return about is not None and about.made_from not in (None, _source(data))


def main():
    parser = command_line.Parser(usage=__doc__)
    parser.add_argument("data")
    parser.add_argument("out")
    parser.add_argument("--scanners", type=command_line.texts)
    parser.add_argument("--voxel_size", default=0.0,
                        type=command_line.number("at least 0", lambda value: value >= 0))
    arguments = parser.parse_args()
    print(make_scans(arguments.data, arguments.out, arguments.scanners, arguments.voxel_size))
    return 0


if __name__ == "__main__":
    sys.exit(command_line.run(main, "start it again"))
