"""From a folder of photographs to points: example.py PHOTOS OUT (needs pycolmap)."""

import sys
from pathlib import Path

import pycolmap
import tapa_mvs

photos, out = map(Path, sys.argv[1:])
database, dense = out / "database.db", out / "dense"
out.mkdir(parents=True)
pycolmap.extract_features(database, photos, device=pycolmap.Device.cpu)
pycolmap.match_exhaustive(database, device=pycolmap.Device.cpu)
models = pycolmap.incremental_mapping(database, photos, out).values()
max(models, key=lambda model: model.num_reg_images()).write(out)
pycolmap.undistort_images(dense, out, photos)

tapa_mvs.patch_match_stereo(dense, {"tapa": True, "max_image_size": 1600},
                            progress=lambda share, text: print(text, end="\r"))
tapa_mvs.stereo_fusion(dense, dense / "fused.ply")
for image in pycolmap.Reconstruction(dense / "sparse").images.values():
    depth = tapa_mvs.read_depth_map(dense, image.name)
    print(f"{image.name}: depth at {(depth > 0).mean():.0%} of {depth.shape} pixels")
