"""What scripts/interchange.sh lets today's COLMAP do.

    today.py shrink PHOTOS OUT SIZE
    today.py reconstruct PHOTOS OUT
    today.py undistort PHOTOS MODEL WORKSPACE
    today.py make_rigs MODEL
    today.py fuse WORKSPACE PLY
    today.py rewrite_maps WORKSPACE COPY
    today.py rewrite_model MODEL COPY
"""

import shutil
import sys
from pathlib import Path

import pycolmap

SUFFIXES = {".jpg", ".jpeg", ".png", ".tif", ".tiff", ".bmp", ".ppm"}


def shrink(photos, out, size):
    """Copies of at most size pixels, every second one in a folder of its own."""
    size = int(str(size))
    paths = sorted(p for p in photos.rglob("*") if p.suffix.lower() in SUFFIXES)
    for index, path in enumerate(paths):
        bitmap = pycolmap.Bitmap.read(path, as_rgb=True)
        scale = min(1, size / max(bitmap.width, bitmap.height))
        if scale < 1:
            bitmap.rescale(round(scale * bitmap.width), round(scale * bitmap.height))
        target = out / ("left" if index % 2 == 0 else "right") / (path.stem + ".png")
        target.parent.mkdir(parents=True, exist_ok=True)
        if not bitmap.write(target):
            raise OSError(f"{target} cannot be written")


def reconstruct(photos, out):
    out.mkdir(parents=True)
    database = out / "database.db"
    pycolmap.set_random_seed(0)
    pycolmap.extract_features(
        database, photos, camera_mode=pycolmap.CameraMode.SINGLE, device=pycolmap.Device.cpu
    )
    pycolmap.match_exhaustive(database, device=pycolmap.Device.cpu)
    models = pycolmap.incremental_mapping(database, photos, out)
    if not models:
        raise RuntimeError("no sparse model could be made")
    largest = max(models.values(), key=lambda model: model.num_reg_images())
    (out / "sparse").mkdir()
    largest.write(out / "sparse")


def undistort(photos, model, workspace):
    pycolmap.undistort_images(workspace, model, photos)


def make_rigs(path):
    """Two rigs of three cameras each, and one moment at which a rig's pose is unknown."""
    options = pycolmap.SyntheticDatasetOptions()
    options.num_rigs = 2
    options.num_cameras_per_rig = 3
    options.num_points3D = 600
    pycolmap.set_random_seed(0)
    model = pycolmap.synthesize_dataset(options)
    model.deregister_frame(min(model.frames))
    path.mkdir(parents=True)
    model.write(path)


def fuse(workspace, ply):
    pycolmap.stereo_fusion(ply, workspace, input_type="geometric", output_type="ply")


def rewrite_maps(workspace, copy):
    """A copy of the workspace with all maps read and written by today's COLMAP.

    The geometric maps go to its folder "expected", so that its first view, which
    one-view.cfg names, is not done yet.
    """
    copy.mkdir(parents=True)
    for part in ("images", "sparse"):
        shutil.copytree(workspace / part, copy / part)
    for kind, type_ in (("depth_maps", pycolmap.DepthMap), ("normal_maps", pycolmap.NormalMap)):
        folder = workspace / "stereo" / kind
        for path in sorted(folder.rglob("*.bin")):
            geometric = path.name.endswith(".geometric.bin")
            top = copy / "expected" if geometric else copy / "stereo"
            target = top / kind / path.relative_to(folder)
            target.parent.mkdir(parents=True, exist_ok=True)
            source = type_()
            source.read(path)
            if type_ is pycolmap.DepthMap:
                rebuilt = type_.from_array(source.to_array(), source.depth_min, source.depth_max)
            else:
                rebuilt = type_.from_array(source.to_array())
            rebuilt.write(target)
    (copy / "stereo" / "consistency_graphs").mkdir()
    config = (workspace / "stereo" / "patch-match.cfg").read_text()
    (copy / "stereo" / "patch-match.cfg").write_text(config)
    (copy / "one-view.cfg").write_text("\n".join(config.splitlines()[:2]) + "\n")


def rewrite_model(model, copy):
    """Only the files that COLMAP had before it knew rigs are read."""
    for name in ("cameras.bin", "images.bin", "points3D.bin"):
        if not (model / name).is_file():
            raise FileNotFoundError(model / name)
    copy.mkdir(parents=True)
    pycolmap.Reconstruction(model).write(copy)


if __name__ == "__main__":
    globals()[sys.argv[1]](*map(Path, sys.argv[2:]))
