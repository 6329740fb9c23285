"""The methods that are compared, as options of the program."""

from .processes import number_text



def _stereo(**options):
    """Options of patch_match_stereo as arguments."""
    return [text for name, value in options.items()
            for text in ("--PatchMatchStereo." + name, str(value))]


# What COLMAP takes, and so the paper; in the program colmap_defaults says the same, but
# options after it would do nothing.
_COLMAP = _stereo(num_levels=1, num_iterations=5, num_geom_iterations=5, num_samples=15,
                  window_step=1, sigma_color=0.2, geom_perturbation=1, try_all=1, measure_all=1,
                  hysteresis=0, sigma_textured=-1)
_TAPA = _stereo(tapa=1)
_PAPER = _COLMAP + _TAPA + _stereo(tapa_completion=0, tapa_min_textureness=0.5)

# By name what a reader sees and the options of patch_match_stereo. plain and tapa are what
# this program does, colmap and paper what COLMAP does and what the paper describes; the others
# leave a part out, or take more or less time.
_ALL = {
    "plain": ("plain", []),
    "tapa": ("TAPA", _TAPA),
    "colmap": ("COLMAP", _COLMAP),
    "colmap-tapa": ("TAPA, 5 + 5 iterations, 15 samples", _COLMAP + _TAPA),
    "paper": ("paper's TAPA", _PAPER),
}
for _name, _label, _options in (
        ("one-level", "one level", _stereo(num_levels=1)),
        ("no-hysteresis", "no hysteresis", _stereo(hysteresis=0)),
        ("all", "all hypotheses", _stereo(try_all=1)),
        ("random", "a random change in every sweep", _stereo(random_share=1)),
        ("measure-all", "all views measured", _stereo(measure_all=1)),
        ("4-views", "4 views drawn", _stereo(num_samples=4)),
        ("8-views", "8 views drawn", _stereo(num_samples=8)),
        ("full", "full windows", _stereo(window_step=1)),
        ("sigma", "sigma_color 0.2", _stereo(sigma_color=0.2)),
        ("wide", "sigma_textured -1", _stereo(sigma_textured=-1)),
        ("long", "4 iterations at every level", _stereo(num_fine_iterations=4)),
        ("short", "1 geometric iteration", _stereo(num_geom_iterations=1))):
    for _base in ("plain", "tapa"):
        _ALL[f"{_base}-{_name}"] = f"{_ALL[_base][0]}, {_label}", _ALL[_base][1] + _options
for _name, _label, _option in (("weights", "weights", "texture_weighting"),
                               ("coarse", "coarse superpixels", "coarse_superpixels"),
                               ("fine", "fine superpixels", "fine_superpixels"),
                               ("refinement", "refinement", "refinement")):
    for _base in ("tapa", "paper"):
        _ALL[f"{_base}-{_name}"] = (f"{_ALL[_base][0]} without {_label}", [
            *_ALL[_base][1], *_stereo(**{"tapa_" + _option: 0})])

# Completion without one of its rules: at these values a rule decides nothing.
for _name, _label, _option, _value in (
        ("completion", "without completion", "completion", 0),
        ("sightings", "without sightings", "completion_sightings", 0),
        ("triangles", "without triangles", "completion_triangles", 0),
        ("silhouettes", "without silhouettes", "completion_silhouettes", 0),
        ("regions", "without regions", "completion_regions", 0),
        ("consensus", "without consensus", "completion_consensus", 0),
        ("agreement", "planes whatever lies on them", "completion_agreement", 0),
        ("radius", "agreement of whole superpixels", "completion_radius", 1),
        ("texture", "planes for nothing that stayed", "completion_textureness", 0),
        ("fill-share", "fill from any pixel", "completion_fill_share", 0)):
    _ALL["tapa-" + _name] = ("TAPA, " + _label, _TAPA + _stereo(**{"tapa_" + _option: _value}))

METHODS = {name: options for name, (_, options) in _ALL.items()}


def check_method(name):
    """The name of a method. Raises ValueError if there is none."""
    if name not in METHODS:
        raise ValueError(f"there is no method {name}; there are " + ", ".join(METHODS))
    return name


# The columns of the paper's Table 2: with the paper's own method, and with what
# this program does.
ABLATION = ["colmap", "paper-weights", "paper-coarse", "paper-fine", "paper-refinement", "paper"]
TAPA_ABLATION = ["plain", *(name.replace("paper", "tapa") for name in ABLATION[1:])]


# COLMAP's rule, which counts pixels, with its own thresholds; and the rule of this
# program, which weighs agreement.
FUSION_COLMAP = ["--StereoFusion.agreement", "0"]
FUSION_AGREEMENT = ["--StereoFusion.agreement", "1"]


def fusion_options(reprojection_error, normal_error=20):
    """Options of stereo_fusion for COLMAP's rule. Pixels and degrees."""
    return [*FUSION_COLMAP, "--StereoFusion.max_reproj_error", number_text(reprojection_error),
            "--StereoFusion.max_normal_error", number_text(normal_error)]


# The paper's section 6: half of COLMAP's reprojection error of 2 pixels with
# photographs of high resolution, a quarter with low; twice its normal error.
FUSION_HIGH = fusion_options(1)
FUSION_LOW = fusion_options(0.5)


def label(method):
    """The name of a method, or of something else to compare with, in words."""
    return _ALL[method][0] if method in _ALL else method
