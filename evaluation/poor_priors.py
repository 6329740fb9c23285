"""Makes depth maps as other programs might guess them, of photographs with measured depth.

    scripts/poor_priors DATA --out OUT --kind KIND [--seed N]

OUT/NAME.exr is a prior for each photograph of DATA that has a measured depth, for
patch_match_stereo --PatchMatchStereo.prior_path OUT. KIND is one of

    true    the measured depth
    poor    the same with a smooth error of up to 10 %, blurred edges and holes
    other   the measured depth of another photograph, halfway around the set
    plane   a slanted plane
    noise   a random number in every pixel

All are half as large as the photographs, and have the inverse of the depth with a scale
and a shift of their own, as networks do that see a single photograph.
"""

import argparse
import os

import cv2
import numpy as np

from . import command_line, depth_maps, files
from .exchange import formats
from .processes import Failure

KINDS = ("true", "poor", "other", "plane", "noise")
_LARGEST_ERROR = 0.1
_CELLS = 5  # Across, of the smooth error.
_BLUR = 0.01  # Standard deviation, of the width.
_HOLES, _HOLE_RADIUS = 12, 0.06  # Number, and largest radius, of the width.
_SCALE, _SHIFT = 0.7, 0.2


def _parse(words):
    parser = command_line.Parser(prog="poor_priors", description=__doc__,
                                 formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("data", metavar="DATA", help="folder with images/ and gt_depth/, as examples/room")
    add("--out", required=True, help="folder for the depth maps, which must not be there yet")
    add("--kind", required=True, choices=KINDS)
    add("--seed", type=command_line.whole_number(0), default=0, help="of what is random")
    return parser.parse_args(words)


def _smooth_error(height, width, random):
    cells = random.standard_normal((max(2, round(_CELLS * height / width)), _CELLS))
    error = cv2.resize(cells, (width, height), interpolation=cv2.INTER_CUBIC)
    return _LARGEST_ERROR * error / np.abs(error).max()


def _blurred(depth):
    """Edges become slopes; what has no depth takes no part."""
    sigma = _BLUR * depth.shape[1]
    is_known = (depth > 0).astype(np.float64)
    weight = cv2.GaussianBlur(is_known, (0, 0), sigma)
    total = cv2.GaussianBlur(depth.astype(np.float64), (0, 0), sigma)
    return np.divide(total, weight, out=np.zeros_like(total), where=depth > 0)


def _without_holes(depth, random):
    height, width = depth.shape
    rows, cols = np.mgrid[:height, :width]
    for _ in range(_HOLES):
        row, col = random.uniform(0, height), random.uniform(0, width)
        radius = random.uniform(0.3, 1) * _HOLE_RADIUS * width
        depth = np.where(np.hypot(rows - row, cols - col) < radius, 0, depth)
    return depth


def make_prior(kind, own, other, random):
    """A prior of a photograph with depth `own`; other: that of another photograph.

    Arrays of the same kind: 0 where nothing is known.
    """
    height, width = own.shape
    if kind == "noise":
        return random.uniform(0.1, 1, own.shape)
    if kind == "plane":
        rows, cols = np.mgrid[:height, :width]
        return 1 + rows / height + cols / width
    depth = other if kind == "other" else own
    if kind == "poor":
        depth = _blurred(depth) * (1 + _smooth_error(height, width, random))
        depth = _without_holes(depth, random)
    is_known = depth > 0
    nearest = depth[is_known].min(initial=np.inf)
    return np.where(is_known, _SCALE * nearest / np.maximum(depth, nearest) + _SHIFT, 0)


def _halved(depth):
    """Nearest pixels, so that edges stay."""
    return depth[::2, ::2]


def main(words=None):
    arguments = _parse(words)
    folder = os.path.join(arguments.data, "gt_depth")
    names = [name for name in files.names_below(os.path.join(arguments.data, "images"))
             if depth_maps.find(folder, name)]
    if not names:
        raise Failure(f"{arguments.data} has no photographs in images with depth in gt_depth")
    with files.replacing_folder(arguments.out) as out:
        for i, name in enumerate(names):
            own, other = (_halved(depth_maps.read(depth_maps.find(folder, names[index])))
                          for index in (i, (i + len(names) // 2) % len(names)))
            random = np.random.default_rng((arguments.seed, i))
            prior = make_prior(arguments.kind, own, other, random)
            formats.write_numbers(os.path.join(out, name + ".exr"), prior.astype(np.float32))
    print(f"{arguments.out}: {len(names)} depth maps")
    return 0
