"""What scripts/evaluate, eth3d, evaluate_depth_maps and evaluate_point_cloud are made of.

A run is one method with one seed on one set of photographs. It has a folder,
OUT/SET/METHOD-SEED, which is a COLMAP workspace with these files beside it:

    record.json         options, versions, machines, times, memory (record.py)
    fused.ply           points, fused with TAPA's thresholds
    fused_default.ply   points, fused with COLMAP's own thresholds
    fused_agreement.ply points, fused by the rule that weighs agreement
    depth_scores.json   scores of the depth maps (depth_scores.py)
    cloud_scores.json   scores of the points (cloud_scores.py)
    *.log               what the programs printed

page/ makes HTML files of workspaces and reports, for scripts/result_page and evaluate;
exchange/ files of other programs of maps, and back, for scripts/convert_maps.

A command plans steps and runs those that are not done (steps.py). Scores remember
what they were made from, and are not shown for anything else.

Shares are 0 to 1, lengths in metres, times in seconds, memory in bytes.
Functions raise processes.Failure, whose text is one line for the user.
"""

import importlib.util
import sys

# Before anything runs for hours and then cannot be drawn.
for _module, _package in (("numpy", "numpy"), ("cv2", "opencv"), ("scipy", "scipy"),
                          ("matplotlib", "matplotlib"), ("pydantic", "pydantic")):
    if importlib.util.find_spec(_module) is None:
        sys.exit(f"ERROR: python3-{_package} is missing; run scripts/install_deps.sh")
