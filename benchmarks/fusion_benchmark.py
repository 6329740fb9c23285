#!/usr/bin/python3
"""Times the two rules of fusion next to each other, and takes their memory.

    benchmarks/fusion_benchmark.py COLMAP FOLDER [VIEWS] [WIDTH] [HEIGHT]

COLMAP is the program. In FOLDER it makes a workspace of VIEWS (50) photographs of
WIDTH x HEIGHT (3000 x 2000) pixels with maps of a wavy wall, with noise: 16 bytes per
pixel and view. Each rule fuses all of it once; a line each tells the time, the CPU
time, the largest memory, and the number of points.
"""

import os
import subprocess
import sys
import time

import cv2
import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from evaluation import point_clouds

FOCAL = 1.0  # Of the image's width.
BASELINE = 0.15  # Between neighbouring views, at a distance of 4.


def wall(x, y):
    return 4 + 0.2 * np.sin(3 * x) * np.cos(2 * y)


def depth_of_view(index, width, height):
    """Depth and normals (3, height, width) that a view along z at (x, 0, 0) sees."""
    cols, rows = np.meshgrid(np.arange(width, dtype=np.float32) + 0.5,
                             np.arange(height, dtype=np.float32) + 0.5)
    u, v = (cols - width / 2) / (FOCAL * width), (rows - height / 2) / (FOCAL * width)
    depth = np.full((height, width), 4, np.float32)
    for _ in range(8):
        depth = wall(index * BASELINE + u * depth, v * depth).astype(np.float32)
    x, y = index * BASELINE + u * depth, v * depth
    normal = np.stack((0.6 * np.cos(3 * x) * np.cos(2 * y), -0.4 * np.sin(3 * x) * np.sin(2 * y),
                       -np.ones_like(x)))
    normal /= np.linalg.norm(normal, axis=0)
    noise = np.random.default_rng(index).normal(0, 0.001, depth.shape)
    return (depth * (1 + noise)).astype(np.float32), normal.astype(np.float32)


def write_map(path, values):
    channels, height, width = values.shape
    with open(path, "wb") as file:
        file.write(b"%d&%d&%d&" % (width, height, channels))
        file.write(values.astype("<f4").tobytes())


def make_workspace(folder, views, width, height):
    for part in ("images", "sparse", "stereo/depth_maps", "stereo/normal_maps"):
        os.makedirs(os.path.join(folder, part), exist_ok=True)
    names = ["view%02d.jpg" % i for i in range(views)]
    image = np.random.default_rng(0).integers(0, 255, (height // 8, width // 8, 3), np.uint8)
    cv2.imwrite(os.path.join(folder, "images", names[0]), cv2.resize(image, (width, height)))
    for index, name in enumerate(names):
        if index:
            path = os.path.join(folder, "images", name)
            if not os.path.exists(path):
                os.link(os.path.join(folder, "images", names[0]), path)
        depth, normals = depth_of_view(index, width, height)
        write_map(os.path.join(folder, "stereo/depth_maps", name + ".geometric.bin"), depth[None])
        write_map(os.path.join(folder, "stereo/normal_maps", name + ".geometric.bin"), normals)
    with open(os.path.join(folder, "stereo/fusion.cfg"), "w") as file:
        file.write("".join(name + "\n" for name in names))
    with open(os.path.join(folder, "stereo/patch-match.cfg"), "w") as file:
        file.write("")
    write_model(os.path.join(folder, "sparse"), names, width, height)


def write_model(folder, names, width, height):
    """Points on the wall, each in all views that see it."""
    random = np.random.default_rng(1)
    length = BASELINE * len(names)
    xs, ys = random.uniform(-2, length + 2, 100 * len(names)), random.uniform(-1.2, 1.2,
                                                                            100 * len(names))
    zs = wall(xs, ys)
    seen = [[] for _ in names]
    tracks = []
    for number, (x, y, z) in enumerate(zip(xs, ys, zs)):
        track = []
        for index in range(len(names)):
            col = FOCAL * width * (x - index * BASELINE) / z + width / 2
            row = FOCAL * width * y / z + height / 2
            if 0 < col < width and 0 < row < height:
                track.append((index, len(seen[index])))
                seen[index].append((col, row, number + 1))
        tracks.append(track)
    with open(os.path.join(folder, "cameras.txt"), "w") as file:
        file.write(f"1 PINHOLE {width} {height} {FOCAL * width} {FOCAL * width} {width / 2} "
                   f"{height / 2}\n")
    with open(os.path.join(folder, "images.txt"), "w") as file:
        for index, name in enumerate(names):
            file.write(f"{index + 1} 1 0 0 0 {-index * BASELINE} 0 0 1 {name}\n")
            file.write(" ".join("%g %g %d" % point for point in seen[index]) + "\n")
    with open(os.path.join(folder, "points3D.txt"), "w") as file:
        for number, track in enumerate(tracks):
            if len(track) >= 2:
                file.write(f"{number + 1} {xs[number]} {ys[number]} {zs[number]} 0 0 0 1 " + " ".join(
                    f"{index + 1} {at}" for index, at in track) + "\n")


def fuse(colmap, folder, agreement):
    output = os.path.join(folder, f"fused{agreement}.ply")
    begin = time.monotonic()
    process = subprocess.Popen(
        [colmap, "stereo_fusion", "--workspace_path", folder, "--output_path", output,
         "--StereoFusion.agreement", str(agreement)], stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.monotonic() - begin
    if status != 0:
        sys.exit(f"ERROR: stereo_fusion ended with status {status}")
    points = len(point_clouds.read_ply(output)[0])
    name = "agreement" if agreement else "COLMAP's rule"
    print(f"| {name} | {seconds:.0f} s | {usage.ru_utime + usage.ru_stime:.0f} s | "
          f"{usage.ru_maxrss / 1024:.0f} MB | {points} |", flush=True)


def main():
    if not 3 <= len(sys.argv) <= 6:
        sys.exit(__doc__)
    colmap, folder = sys.argv[1:3]
    views, width, height = [int(word) for word in sys.argv[3:]] + [50, 3000, 2000][
        len(sys.argv) - 3:]
    make_workspace(folder, views, width, height)
    print(f"{views} views of {width}x{height}\n| rule | time | CPU time | memory | points |")
    for agreement in (1, 0):
        fuse(colmap, folder, agreement)


if __name__ == "__main__":
    main()
