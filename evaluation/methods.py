"""The methods that are compared, as options of the program."""

from .processes import number_text

# What COLMAP takes, and so the paper; in the program colmap_defaults says the same.
_COLMAP = ["--PatchMatchStereo.num_iterations", "5",
           "--PatchMatchStereo.num_geom_iterations", "5",
           "--PatchMatchStereo.num_samples", "15",
           "--PatchMatchStereo.first_window_step", "1"]
_TAPA = ["--PatchMatchStereo.tapa", "1"]
_PAPER = _COLMAP + _TAPA + ["--PatchMatchStereo.tapa_completion", "0",
                  "--PatchMatchStereo.tapa_min_textureness", "0.5"]


def _without(part):
    return ["--PatchMatchStereo.tapa_" + part, "0"]


_FULL_WINDOW = ["--PatchMatchStereo.first_window_step", "1"]
_FEWER_ITERATIONS = [*_FULL_WINDOW, "--PatchMatchStereo.num_iterations", "2"]
_SPARSE_WINDOW = ["--PatchMatchStereo.num_iterations", "2", "--PatchMatchStereo.window_step", "2"]

# Options of patch_match_stereo by name. plain and tapa are what this program does,
# colmap and paper what COLMAP does and what the paper describes; the others leave a
# part out, or take more or less time.
METHODS = {
    "plain": [],
    "tapa": _TAPA,
    "colmap": _COLMAP,
    "colmap-tapa": _COLMAP + _TAPA,
    "plain-full": _FULL_WINDOW,
    "tapa-full": _TAPA + _FULL_WINDOW,
    "plain-2+2": _FEWER_ITERATIONS,
    "tapa-2+2": _TAPA + _FEWER_ITERATIONS,
    "plain-sparse": _SPARSE_WINDOW,
    "tapa-sparse": _TAPA + _SPARSE_WINDOW,
    "tapa-weights": _TAPA + _without("texture_weighting"),
    "tapa-coarse": _TAPA + _without("coarse_superpixels"),
    "tapa-fine": _TAPA + _without("fine_superpixels"),
    "tapa-refinement": _TAPA + _without("refinement"),
    "paper": _PAPER,
    "paper-weights": _PAPER + _without("texture_weighting"),
    "paper-coarse": _PAPER + _without("coarse_superpixels"),
    "paper-fine": _PAPER + _without("fine_superpixels"),
    "paper-refinement": _PAPER + _without("refinement"),
}



def check_method(name):
    """The name of a method. Raises ValueError if there is none."""
    if name not in METHODS:
        raise ValueError(f"there is no method {name}; there are " + ", ".join(METHODS))
    return name


# What a reader sees.
LABELS = {
    "plain": "plain",
    "tapa": "TAPA",
    "colmap": "COLMAP",
    "colmap-tapa": "TAPA, 5 + 5 iterations, 15 samples",
    "plain-full": "plain, full windows",
    "tapa-full": "TAPA, full windows",
    "plain-2+2": "plain, 2 + 2 iterations, full windows",
    "tapa-2+2": "TAPA, 2 + 2 iterations, full windows",
    "plain-sparse": "plain, 2 + 2 iterations, window step 2",
    "tapa-sparse": "TAPA, 2 + 2 iterations, window step 2",
    "tapa-weights": "TAPA without weights",
    "tapa-coarse": "TAPA without coarse superpixels",
    "tapa-fine": "TAPA without fine superpixels",
    "tapa-refinement": "TAPA without refinement",
    "paper": "paper's TAPA",
    "paper-weights": "paper's TAPA without weights",
    "paper-coarse": "paper's TAPA without coarse superpixels",
    "paper-fine": "paper's TAPA without fine superpixels",
    "paper-refinement": "paper's TAPA without refinement",
}

# The columns of the paper's Table 2: with the paper's own method, and with what
# this program does.
ABLATION = ["colmap", "paper-weights", "paper-coarse", "paper-fine",
            "paper-refinement", "paper"]
TAPA_ABLATION = ["plain", *(name.replace("paper", "tapa") for name in ABLATION[1:])]


def fusion_options(reprojection_error, normal_error=20):
    """Options of stereo_fusion. Pixels and degrees."""
    return ["--StereoFusion.max_reproj_error", number_text(reprojection_error),
            "--StereoFusion.max_normal_error", number_text(normal_error)]


# The paper's section 6: half of COLMAP's reprojection error of 2 pixels with
# photographs of high resolution, a quarter with low; twice its normal error.
FUSION_HIGH = fusion_options(1)
FUSION_LOW = fusion_options(0.5)


def label(method):
    """The name of a method, or of something else to compare with, in words."""
    return LABELS.get(method, method)
