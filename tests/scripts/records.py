"""Records of runs that nobody has run."""

from evaluation.methods import METHODS


def made_with(version="COLMAP 3.8", gpu=None):
    return {"version": version, "machine": {
        "cpu": "abacus", "cores": 2, "memory_bytes": 8e9, "gpu": gpu}}


def make_record(name="s", method="plain", seed=0, options=(), **values):
    """values: of record.json, in place of those here."""
    return {
        "set": name, "method": method, "seed": seed, "sources": 10, "every": 1,
        "options": ["--PatchMatchStereo.seed", str(seed),
                    *METHODS.get(method, []), *options],
        "fusion_options": {}, "made_with": {"stereo": [made_with()]},
        "views": 4, "image_size": [500, 500], "done": ["stereo"],
        "failed": None, "seconds": {"stereo": 70.0},
        "cpu_seconds": {"stereo": 120.0},
        "peak_memory_bytes": {"stereo": 300e6}, **values}
