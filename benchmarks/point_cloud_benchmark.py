#!/usr/bin/python3
"""Time and memory that scores of point clouds take.

    benchmarks/point_cloud_benchmark.py [RECONSTRUCTED SCANNED [PROGRAM]]

Prints a line of docs/evaluation.md's table for so many points (1000000 and 2000000). PROGRAM
is another one with the options of scripts/evaluate_point_cloud.

The scene is a hall of 10 x 10 x 5 m with two scanners, which turn like the instruments do, and a
reconstruction of what they measured: most points within a centimetre or two, some anywhere, in
no order, which is the worst case for the caches.
"""

import multiprocessing
import os
import sys
import tempfile

import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, ROOT)
from evaluation import meshlab_project, point_clouds, processes  # noqa: E402


def scan_hall(position, count):
    """What a scanner at a position measures, in its frame."""
    rows = int(np.sqrt(count / 2))
    azimuth = np.repeat(np.arange(2 * rows) * np.pi / rows, rows)
    inclination = np.tile((np.arange(rows) + 0.5) * np.pi / rows, 2 * rows)
    rays = np.stack((np.sin(inclination) * np.cos(azimuth),
                     np.sin(inclination) * np.sin(azimuth), np.cos(inclination)), axis=1)
    with np.errstate(divide="ignore"):
        to_walls = (np.copysign((5, 5, 2.5), rays) - position) / rays
    return (rays * to_walls.min(axis=1)[:, None]).astype(np.float32)


def make_scene(num_reconstructed, num_scanned, reconstruction, project):
    poses, scanned = {"scan1.ply": np.eye(4), "scan2.ply": np.eye(4)}, []
    for (name, pose), position in zip(poses.items(), ((-2, 1, 0), (2, 1, 0))):
        pose[:3, 3] = position
        points = scan_hall(pose[:3, 3], num_scanned // 2)
        point_clouds.write_ply(os.path.join(os.path.dirname(project), name), points)
        scanned.append(points + np.float32(position))
    meshlab_project.write(project, poses.items())
    random, scanned = np.random.default_rng(1), np.concatenate(scanned)
    points = scanned[random.integers(0, len(scanned), num_reconstructed)]
    points += random.normal(0, 0.01, points.shape).astype(np.float32)
    points[::20] = random.uniform(-1, 1, points[::20].shape) * (5, 5, 2.5)
    point_clouds.write_ply(reconstruction, points)


def main(num_reconstructed=1000000, num_scanned=2000000,
         program=os.path.join(ROOT, "scripts", "evaluate_point_cloud")):
    counts = int(num_reconstructed), int(num_scanned)
    with tempfile.TemporaryDirectory() as folder:
        reconstruction, project, log = (os.path.join(folder, name)
                                        for name in ("fused.ply", "scans.mlp", "log"))
        # In a process of its own, as a program counts the memory of the one that starts it.
        maker = multiprocessing.Process(target=make_scene, args=(*counts, reconstruction, project))
        maker.start()
        maker.join()
        usage = processes.run([program, "--reconstruction_ply_path", reconstruction,
                               "--ground_truth_mlp_path", project,
                               "--tolerances", "0.01,0.02,0.05,0.1,0.2,0.5"], log)
        print("\n".join(processes.last_output(log)[-4:]))
    print(f"| {counts[0] / 1e6:g} million | {counts[1] / 1e6:g} million | "
          f"{usage.peak_memory_bytes / 1e6:.0f} MB | {usage.cpu_seconds:.1f} s | "
          f"{usage.seconds:.1f} s |")


if __name__ == "__main__":
    main(*sys.argv[1:])
