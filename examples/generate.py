#!/usr/bin/python3
"""Renders rooms that do not exist: photographs, their sparse model, and exact depth.

    examples/generate.py SCENE... --out OUT [--shrink N] [--jobs N]
    examples/generate.py all --out OUT

writes OUT/SCENE in the format of examples/room: images/, sparse/, gt_depth/. A folder
appears when it is complete; one that is there already and was made from the same
files is kept. --shrink N divides the sides of photographs by N. --jobs views are
rendered side by side (as many as there are cores); nothing depends on it.
--preview 0,5 renders only these views, into OUT/SCENE-preview, without sparse model.

Needs POV-Ray 3.7 and, for this Python, NumPy and OpenCV (Debian: povray,
python3-numpy, python3-opencv). Everything is drawn from fixed seeds.
"""

import argparse
import concurrent.futures
import hashlib
import os
import shutil
import signal
import sys
import tempfile
import time

import cv2
import numpy as np

from rendering import camera as cameras
from rendering import pictures, povray, scene, sparse_model

DEPTH_UNITS = 4000.0  # per metre, in gt_depth
MADE_FROM = "made_from.txt"


class Failure(Exception):
    """Its text is one line for the user."""


def made_from(one, camera):
    """What pictures depend on, in a few lines."""
    digest = hashlib.sha256()
    folders = [os.path.join(scene.EXAMPLES, name) for name in (one.name, "rendering")]
    for path in [os.path.abspath(__file__)] + sorted(
            os.path.join(folder, name) for folder in folders for name in os.listdir(folder)
            if name.endswith((".py", ".pov", ".inc"))):
        with open(path, "rb") as file:
            digest.update(file.read())
    return "scene %s\nsize %dx%d\nsources sha256 %s\n" % (
        one.name, camera.width, camera.height, digest.hexdigest())


def render(one, camera, views, jobs, work):
    """(linear light, depth) by view."""
    for number, (name, draw) in enumerate(one.pictures):
        pictures.save(work, name, draw(np.random.default_rng(1000 + number)))
    renderer = povray.Renderer(one, camera, work)
    pool = concurrent.futures.ThreadPoolExecutor(jobs)
    try:
        renderer.gather_light(views)
        # Results come in the order of views.
        return dict(zip(views, pool.map(
            lambda view: (renderer.colour(view), renderer.depth(view)), views)))
    finally:
        renderer.stop()
        pool.shutdown(cancel_futures=True)


def write(one, camera, rendered, folder, with_model):
    for part in ("images", "gt_depth"):
        os.makedirs(os.path.join(folder, part))
    photographs = []
    for view, (colour, depth) in rendered.items():
        image = cameras.photograph(colour, camera, np.random.default_rng(one.seed + view))
        path = os.path.join(folder, "images", one.view_name(view) + ".jpg")
        truth = os.path.join(folder, "gt_depth", one.view_name(view) + ".png")
        if not (cv2.imwrite(path, image, [cv2.IMWRITE_JPEG_QUALITY, camera.jpeg_quality])
                and cv2.imwrite(truth, np.rint(depth * DEPTH_UNITS).astype(np.uint16),
                                [cv2.IMWRITE_PNG_COMPRESSION, 9])):
            raise Failure("%s cannot be written" % folder)
        photographs.append(cv2.imread(path))
    if with_model:
        os.makedirs(os.path.join(folder, "sparse"))
        sparse_model.write(os.path.join(folder, "sparse"), photographs,
                           [one.view_name(view) + ".jpg" for view in rendered],
                           [one.poses[view].world_to_camera() for view in rendered],
                           camera.focal)


def generate(one, arguments):
    camera = one.camera.shrunk(arguments.shrink)
    if camera is None:
        raise Failure("the sides of %s, %d and %d, cannot be divided by %d" % (
            one.name, one.camera.width, one.camera.height, arguments.shrink))
    target = os.path.join(os.path.abspath(arguments.out),
                          one.name + ("-preview" if arguments.preview else ""))
    content = made_from(one, camera)
    if os.path.lexists(target):
        try:
            with open(os.path.join(target, MADE_FROM), encoding="utf-8") as file:
                known = file.read()
        except OSError:
            known = ""
        if known != content:
            raise Failure("%s is there already, but was not made from these files at this "
                          "size; remove it or name another folder" % target)
        print("%s is there already" % target, file=sys.stderr, flush=True)
        return
    if shutil.which("povray") is None:
        raise Failure("POV-Ray is not installed (Debian: apt-get install povray)")
    views = list(range(len(one.poses)))
    if arguments.preview:
        views = [view for view in views if view in arguments.preview]
    print("%s: %d views of %dx%d ..." % (one.name, len(views), camera.width, camera.height),
          file=sys.stderr, flush=True)
    start = time.monotonic()
    os.makedirs(arguments.out, exist_ok=True)
    new = tempfile.mkdtemp(prefix=".%s-" % one.name, dir=arguments.out)
    try:
        with tempfile.TemporaryDirectory(prefix=one.name + "-") as work:
            rendered = render(one, camera, views, arguments.jobs, work)
        write(one, camera, rendered, new, not arguments.preview)
        with open(os.path.join(new, MADE_FROM), "w", encoding="utf-8") as file:
            file.write(content)
        os.chmod(new, 0o755)
        os.rename(new, target)
    finally:
        shutil.rmtree(new, ignore_errors=True)
    print("%s: %.0f s" % (target, time.monotonic() - start), file=sys.stderr, flush=True)


def count(text):
    if not (text.isdecimal() and 1 <= int(text) < 1000):
        raise argparse.ArgumentTypeError("'%s' is not a whole number from 1 on" % text)
    return int(text)


def parse():
    known = scene.names()
    parser = argparse.ArgumentParser(usage=__doc__, allow_abbrev=False)
    parser.add_argument("scenes", nargs="+", choices=known + ["all"], metavar="SCENE")
    parser.add_argument("--out", required=True)
    parser.add_argument("--shrink", type=count, default=1)
    parser.add_argument("--jobs", type=count, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--preview", type=lambda text: [int(v) for v in text.split(",")])
    parser.error = lambda message: sys.exit("ERROR: %s; %s --help explains the options" % (
        message, parser.prog))
    arguments = parser.parse_args()
    if "all" in arguments.scenes:
        arguments.scenes = known
    return arguments


def main():
    # As Ctrl-C, so that nothing is left behind.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    arguments = parse()
    try:
        for name in dict.fromkeys(arguments.scenes):
            generate(scene.load(name), arguments)
    except (Failure, OSError, RuntimeError) as error:
        sys.exit("ERROR: %s" % error)
    except KeyboardInterrupt:
        sys.exit(128 + signal.SIGINT)


if __name__ == "__main__":
    main()
