"""Dense stereo and fusion of COLMAP workspaces by TAPA-MVS, and the maps as numpy arrays.

    import tapa_mvs
    tapa_mvs.patch_match_stereo("DENSE", {"tapa": True}, progress=print)
    tapa_mvs.stereo_fusion("DENSE", "DENSE/fused.ply")
    depth = tapa_mvs.read_depth_map("DENSE", "photo.jpg")

docs/python.md tells more.
"""

from .errors import Error
from .maps import read_confidence_map, read_depth_map, read_normal_map
from .options import fusion_options, stereo_options
from .runs import patch_match_stereo, stereo_fusion

__all__ = ["Error", "fusion_options", "patch_match_stereo", "read_confidence_map",
           "read_depth_map", "read_normal_map", "stereo_fusion", "stereo_options"]
