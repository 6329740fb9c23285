#!/usr/bin/python3
"""Makes the example: photographs, sparse model and exact depth.

    examples/room/generate.py [--out DIR] [--work DIR] [--jobs N]

Needs POV-Ray 3.7 and, for this Python, numpy and OpenCV (Debian: povray,
python3-numpy, python3-opencv). Everything is drawn from fixed seeds, and POV-Ray
runs single-threaded, since with several threads its radiosity depends on chance;
`--jobs` renders that many views side by side instead.
"""

import argparse
import concurrent.futures
import os
import shutil
import subprocess
import sys
import tempfile

import cv2
import numpy as np

import sparse_model
import textures

HERE = os.path.dirname(os.path.abspath(__file__))

WIDTH, HEIGHT, FOCAL = 720, 480, 525.0
NUM_VIEWS = 12
DEPTH_RANGE = 8.0  # metres that a depth pass of 16 bits spans
DEPTH_UNITS = 4000.0  # per metre, in gt_depth

# How the "camera" sees.
EXPOSURE = 0.95
FULL_WELL = 4500.0  # electrons at white: the photon noise
READ_NOISE = 5.0  # electrons
VIGNETTING = 0.17  # loss of light in the corners
JPEG_QUALITY = 95


class Pose:
    """A camera in POV-Ray's left-handed world (x right, y up, z forward)."""

    def __init__(self, eye, target, roll_degrees):
        self.eye = np.asarray(eye, float)
        forward = np.asarray(target, float) - self.eye
        self.forward = forward / np.linalg.norm(forward)
        right = np.cross((0.0, 1.0, 0.0), self.forward)
        right /= np.linalg.norm(right)
        up = np.cross(self.forward, right)
        roll = np.radians(roll_degrees)
        self.right = np.cos(roll) * right + np.sin(roll) * up
        self.up = np.cos(roll) * up - np.sin(roll) * right

    def world_to_camera(self):
        """R, t for a right-handed world (x right, y down, z forward), as COLMAP's."""
        flip = np.array((1.0, -1.0, 1.0))
        rotation = np.stack((self.right * flip, -self.up * flip, self.forward * flip))
        return rotation, -rotation @ (self.eye * flip)


def make_poses():
    """A walk on an arc of about two metres around the coffee table, by hand."""
    rng = np.random.default_rng(5)
    poses = []
    for angle in np.linspace(-14.0, 30.0, NUM_VIEWS):
        a = np.radians(angle + rng.normal(0, 0.4))
        radius = 2.85 + rng.normal(0, 0.05)
        eye = (-0.35 + radius * np.sin(a), 1.46 + rng.normal(0, 0.05),
               3.35 - radius * np.cos(a))
        target = (-0.40 + 0.008 * angle + rng.normal(0, 0.05),
                  0.92 + rng.normal(0, 0.03), 3.35)
        poses.append(Pose(eye, target, rng.normal(0, 0.8)))
    return poses


def write_view(path, pose, depth_pass, pretrace_end):
    def vector(v):
        return "<%.12f, %.12f, %.12f>" % tuple(v)

    with open(path, "w") as f:
        f.write("#declare Pass = %d;\n" % depth_pass)
        f.write("#declare Eye = %s;\n" % vector(pose.eye))
        f.write("#declare Right = %s;\n" % vector(pose.right))
        f.write("#declare Up = %s;\n" % vector(pose.up))
        f.write("#declare Forward = %s;\n" % vector(pose.forward))
        f.write("#declare WidthOverFocal = %.12f;\n" % (WIDTH / FOCAL))
        f.write("#declare HeightOverFocal = %.12f;\n" % (HEIGHT / FOCAL))
        f.write("#declare DepthRange = %.12f;\n" % DEPTH_RANGE)
        f.write("#declare PretraceEnd = %.4f;\n" % pretrace_end)


def render(work, name, pose, options, depth_pass=False, size=(WIDTH, HEIGHT),
           pretrace_end=0.02):
    """Runs POV-Ray in a folder of its own; returns linear 16-bit BGR."""
    folder = os.path.join(work, name)
    os.makedirs(folder, exist_ok=True)
    write_view(os.path.join(folder, "view.inc"), pose, depth_pass, pretrace_end)
    out = os.path.join(folder, "out.png")
    command = ["povray", "+Iroom.pov", "+L" + folder, "+L" + work, "+O" + out,
               "+W%d" % size[0], "+H%d" % size[1], "+FN16", "File_Gamma=1.0", "-D",
               "+WT1", "Verbose=off"] + options
    result = subprocess.run(command, cwd=work, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, universal_newlines=True)
    image = cv2.imread(out, cv2.IMREAD_UNCHANGED) if result.returncode == 0 else None
    if image is None:
        raise RuntimeError("POV-Ray failed on %s:\n%s" % (name, result.stdout.split("[Parsing...]")[-1]))
    return image


def render_light(work, poses, every=1):
    """Gathers the indirect light of all views in one file, so that a wall looks the
    same in every photograph."""
    cache = os.path.join(work, "light.rad")
    for index, pose in enumerate(poses[::every]):
        options = ["-A", "Radiosity_File_Name=" + cache, "Radiosity_To_File=on",
                   "Radiosity_From_File=" + ("on" if index else "off"),
                   "Radiosity_Vain_Pretrace=on"]
        render(work, "light_%02d" % index, pose, options,
               size=(WIDTH // 2, HEIGHT // 2), pretrace_end=0.02)
    return cache


def render_colour(work, name, pose, cache):
    """Four rays per pixel or, where these differ, up to sixteen; linear, 0 to 1."""
    options = ["+A0.12", "-J", "+AM1", "+R2", "Antialias_Gamma=2.2",
               "Radiosity_File_Name=" + cache, "Radiosity_From_File=on",
               "Radiosity_To_File=off"]
    big = render(work, name, pose, options, size=(2 * WIDTH, 2 * HEIGHT))
    return cv2.resize(big.astype(np.float32), (WIDTH, HEIGHT),
                      interpolation=cv2.INTER_AREA) / 65535.0


def render_depth(work, name, pose):
    """Planar z in metres through the centres of the pixels, one ray each."""
    encoded = render(work, name, pose, ["-A", "-J"], depth_pass=True)
    if encoded.ndim == 3:
        encoded = encoded[..., 0]
    return encoded.astype(np.float64) * (DEPTH_RANGE / 65535.0)


def photograph(linear, rng):
    """Exposure, vignetting, photon and read noise, tone curve; 8 bits."""
    yy, xx = np.mgrid[0:HEIGHT, 0:WIDTH]
    radius2 = ((xx + 0.5 - WIDTH / 2) ** 2 + (yy + 0.5 - HEIGHT / 2) ** 2) / (
        (WIDTH / 2) ** 2 + (HEIGHT / 2) ** 2)
    light = linear * EXPOSURE * (1 - VIGNETTING * radius2)[..., None]
    electrons = light * FULL_WELL
    electrons = electrons + rng.standard_normal(light.shape) * np.sqrt(
        electrons + READ_NOISE ** 2)
    light = np.clip(electrons / FULL_WELL, 0, None)
    # A shoulder, so that highlights roll off instead of clipping.
    knee = 0.75
    over = np.maximum(light - knee, 0)
    light = np.where(light > knee, knee + (1 - knee) * over / (over + 1 - knee), light)
    encoded = np.where(light <= 0.0031308, 12.92 * light,
                       1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)
    return np.clip(np.rint(encoded * 255), 0, 255).astype(np.uint8)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", default=HERE)
    parser.add_argument("--work", help="folder for intermediate files, kept")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--views", help="only these, e.g. 0,5,11 (no sparse model)")
    parser.add_argument("--reuse", action="store_true",
                        help="take what an earlier run left in the work folder")
    args = parser.parse_args()

    if shutil.which("povray") is None:
        sys.exit("povray is not installed (Debian: apt-get install povray)")
    work = os.path.abspath(args.work) if args.work else tempfile.mkdtemp(prefix="room-")
    os.makedirs(work, exist_ok=True)
    textures.write_all(work)
    shutil.copy(os.path.join(HERE, "room.pov"), work)

    poses = make_poses()
    chosen = [int(v) for v in args.views.split(",")] if args.views else list(
        range(NUM_VIEWS))
    rendered = os.path.join(work, "view_%02d.npz")

    missing = [v for v in chosen
               if not (args.reuse and os.path.exists(rendered % v))]
    if missing:
        cache = render_light(work, [poses[v] for v in chosen])

        def make_view(view):
            colour = render_colour(work, "colour_%02d" % view, poses[view], cache)
            depth = render_depth(work, "depth_%02d" % view, poses[view])
            np.savez(rendered % view, colour=colour, depth=depth)

        with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
            views = [pool.submit(make_view, view) for view in missing]
            done, rest = concurrent.futures.wait(
                views, return_when=concurrent.futures.FIRST_EXCEPTION)
            for view in rest:
                view.cancel()
            for view in done:
                view.result()

    for folder in ("images", "gt_depth", "sparse"):
        os.makedirs(os.path.join(args.out, folder), exist_ok=True)
    photographs = []
    for view in chosen:
        data = np.load(rendered % view)
        image = photograph(data["colour"], np.random.default_rng(100 + view))
        path = os.path.join(args.out, "images", "room_%02d.jpg" % view)
        cv2.imwrite(path, image, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])
        photographs.append(cv2.imread(path))
        cv2.imwrite(os.path.join(args.out, "gt_depth", "room_%02d.png" % view),
                    np.rint(data["depth"] * DEPTH_UNITS).astype(np.uint16),
                    [cv2.IMWRITE_PNG_COMPRESSION, 9])
    if len(chosen) == NUM_VIEWS:
        sparse_model.write(os.path.join(args.out, "sparse"), photographs,
                           [pose.world_to_camera() for pose in poses], FOCAL)
    if not args.work:
        shutil.rmtree(work)


if __name__ == "__main__":
    main()
