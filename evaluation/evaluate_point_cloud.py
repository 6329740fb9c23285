"""Compares a point cloud with laser scans as ETH3D does; docs/evaluation.md explains it.

Options, output and exit codes are those of ETH3D's own program: 2 where the reconstruction
cannot be read, 1 after any other error.
"""

import os
import sys

import numpy as np

from . import cloud_checks, command_line, files, meshlab_project, point_clouds
from . import point_cloud_score as scores
from .processes import Failure
from .voxel_average import average

_GOOD, _BAD, _NOT_JUDGED = (0, 255, 0), (255, 0, 0), (0, 0, 255)


class UnreadableReconstruction(Failure):
    """The reconstruction cannot be read."""
    exit_status = 2


def _parse(words):
    parser = command_line.Parser(prog="evaluate_point_cloud", description=__doc__.split(";")[0])
    add = parser.add_argument
    add("--reconstruction_ply_path", required=True, help="point cloud to be scored, a PLY file")
    add("--ground_truth_mlp_path", required=True,
        help="MeshLab project with the scans and their poses")
    add("--tolerances", type=command_line.positive_numbers, required=True,
        help="distances that are tolerated, in metres: 0.01,0.02,0.05,0.1,0.2,0.5 in most "
        "publications")
    add("--voxel_size", type=command_line.positive_number, default=0.01,
        help="edge of the cubes that points are averaged over, in metres (%(default)s)")
    shape = scores.BeamShape()
    add("--beam_start_radius_meters", default=shape.start_radius,
        type=command_line.number("at least 0", lambda value: value >= 0),
        help="radius of a scanner's beam at the scanner (%(default)s)")
    add("--beam_divergence_halfangle_deg", default=shape.divergence_halfangle,
        type=command_line.number("at least 0 and below 90", lambda value: 0 <= value < 90),
        help="half the opening angle of the beam, in degrees (%(default)s)")
    add("--completeness_cloud_output_path",
        help="if given, the scans are written to PATH.tolerance_TOLERANCE.ply: green where they "
        "are complete, else red")
    add("--accuracy_cloud_output_path",
        help="if given, the reconstruction is written to PATH.tolerance_TOLERANCE.ply: green "
        "where it is accurate, red where it is not, blue where it cannot be judged")
    add("--json", help="file for the scores")
    add("--num_threads", type=int, default=-1, help="-1: one per core (%(default)s)")
    arguments = parser.parse_args(words)
    arguments.tolerances.sort()
    if len(arguments.tolerances) > scores.MAX_NUM_TOLERANCES:
        parser.error(f"--tolerances may have at most {scores.MAX_NUM_TOLERANCES} values")
    for path in (arguments.reconstruction_ply_path, arguments.ground_truth_mlp_path):
        if arguments.json and os.path.exists(path) and os.path.exists(arguments.json) \
                and os.path.samefile(arguments.json, path):
            parser.error(f"--json would overwrite {path}")
    if arguments.num_threads < 1:
        arguments.num_threads = len(os.sched_getaffinity(0))
    return arguments


def _say(text):
    print(text, flush=True)


def _warn(text):
    if text:
        print(f"WARNING: {text}.", file=sys.stderr, flush=True)


def _read_points(path, arguments):
    points, num_left_out = point_clouds.read_ply(path)
    if num_left_out:
        _warn(f"{path} has {num_left_out} points with a coordinate that is infinite or not a "
              "number; they are left out")
    _warn(cloud_checks.check_precision(points, arguments.tolerances[0], path))
    return points


def _read_reconstruction(arguments):
    path = arguments.reconstruction_ply_path
    _say(f"Loading reconstruction: {path}")
    try:
        points = _read_points(path, arguments)
    except Failure as error:
        raise UnreadableReconstruction(str(error)) from error
    if not len(points):
        _warn(f"{path} has no points; all scores are 0")
    return points


def _read_scans(listed, reconstruction, arguments):
    scans = []
    for path, pose in listed:
        _say(f"Loading scan: {path}")
        points = _read_points(path, arguments)
        if not len(points):
            raise Failure(f"{path} has no points; leave it out of the MeshLab project")
        if len(points) >= 2 ** 32 - 1:
            raise Failure(f"{path} has more than 2^32 points")
        _warn(cloud_checks.check_unit(reconstruction, points, path))
        scans.append(scores.LaserScan(points, pose))
    return scans


def _local_origin(reconstruction, listed):
    """What to subtract from all coordinates of the world, as those of UTM are too large."""
    if not point_clouds.is_far(reconstruction):
        return np.zeros(3)
    first = listed[0][1][:3, 3]
    return first if point_clouds.is_far(first) else np.floor(np.median(reconstruction, axis=0))


def _moved(pose, origin):
    moved = pose.copy()
    moved[:3, 3] -= origin
    return moved


def _summarize(points, verdicts, cloud_path, arguments):
    """Writes the coloured clouds, if they are wanted, and takes the mean."""
    tolerances = arguments.tolerances
    for number, tolerance in enumerate(tolerances if cloud_path else ()):
        colors = np.where(verdicts.judged[:, None], np.uint8(_BAD), np.uint8(_NOT_JUDGED))
        colors[verdicts.good_at(number)] = _GOOD
        point_clouds.write_ply(f"{cloud_path}.tolerance_{tolerance:g}.ply",
                               points + arguments.origin if arguments.origin.any() else points,
                               colors)
    return average(points, verdicts, len(tolerances), arguments.voxel_size)


def _completeness(reconstruction, scans, arguments):
    _say("Computing completeness")
    points, tolerances = scores.merge_scans(scans), arguments.tolerances
    verdicts = scores.judge_completeness(points, reconstruction, tolerances, arguments.num_threads)
    if len(reconstruction):
        _warn(cloud_checks.check_overlap(verdicts, tolerances[-1], len(tolerances)))
    return _summarize(points, verdicts, arguments.completeness_cloud_output_path, arguments)


def _accuracy(reconstruction, scans, arguments):
    _say("Computing accuracy")
    shape = scores.BeamShape(arguments.beam_start_radius_meters,
                             arguments.beam_divergence_halfangle_deg)
    verdicts = scores.judge_accuracy(reconstruction, scans, arguments.tolerances, shape,
                                     arguments.num_threads)
    if len(reconstruction):
        _warn(cloud_checks.check_judged(verdicts, len(arguments.tolerances)))
    return _summarize(reconstruction, verdicts, arguments.accuracy_cloud_output_path, arguments)


def main(words=None):
    arguments = _parse(words)
    listed = meshlab_project.read(arguments.ground_truth_mlp_path)
    reconstruction = _read_reconstruction(arguments)
    arguments.origin = _local_origin(reconstruction, listed)
    if arguments.origin.any():
        _say("Everything is moved by "
             + " ".join(f"{value:.12g}" for value in -arguments.origin)
             + ", as coordinates are large")
        reconstruction = (reconstruction - arguments.origin).astype(np.float32)
        listed = [(path, _moved(pose, arguments.origin)) for path, pose in listed]
    scans = _read_scans(listed, reconstruction, arguments)
    completeness = _completeness(reconstruction, scans, arguments)
    accuracy = _accuracy(reconstruction, scans, arguments)
    result = {"tolerances": arguments.tolerances, "completeness": completeness,
              "accuracy": accuracy, "f1": list(map(scores.f1_score, completeness, accuracy))}
    for name, values in zip(("Tolerances", "Completenesses", "Accuracies", "F1-scores"),
                            result.values()):
        _say(f"{name}: " + " ".join(f"{value:g}" for value in values))
    if arguments.json:
        files.write_json(arguments.json, result)
    return 0
