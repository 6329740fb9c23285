"""The checks of scripts/interchange.sh: one line each, exit status 1 if it fails.

    checks.py versions
    checks.py same_model MODEL COPY
    checks.py read_model MODEL ANALYSIS
    checks.py same_cameras MODEL OTHER
    checks.py same_poses MODEL OTHER
    checks.py depth_maps WORKSPACE
    checks.py map_files WORKSPACE
    checks.py same_maps WORKSPACE REWRITTEN
    checks.py fused WORKSPACE THEIRS.ply OURS.ply

Depth maps and points are read here without COLMAP's help, from what its
documentation says of the files.
"""

import platform
import re
import sys
from pathlib import Path

import numpy as np
import pycolmap


def read_map(path):
    """One array of shape (channels, height, width)."""
    data = Path(path).read_bytes()
    header = re.match(rb"(\d+)&(\d+)&(\d+)&", data)
    width, height, channels = (int(value) for value in header.groups())
    values = np.frombuffer(data, "<f4", offset=header.end())
    return values.reshape(channels, height, width)


def read_points(path):
    """Positions, (n, 3), of a PLY file as both versions write them."""
    data = Path(path).read_bytes()
    header = data[: data.index(b"end_header\n") + 11]
    lines = header.decode("ascii").split("\n")
    if "format binary_little_endian 1.0" not in lines:
        raise ValueError(f"{path} is not a binary PLY file")
    types = {"float": "<f4", "double": "<f8", "uchar": "u1", "int": "<i4"}
    fields = [line.split() for line in lines if line.startswith("property ")]
    count = next(int(line.split()[2]) for line in lines if line.startswith("element vertex "))
    vertices = np.frombuffer(
        data, [(name, types[type_]) for _, type_, name in fields], count, len(header)
    )
    return np.stack([vertices[axis] for axis in "xyz"], axis=1).astype(np.float64)


def map_paths(workspace, kind="geometric"):
    folder = workspace / "stereo" / "depth_maps"
    return sorted(folder.rglob(f"*.{kind}.bin"))


def normal_path(path):
    return Path(str(path).replace("depth_maps", "normal_maps"))


def nearest(queries, points):
    """Distance of every query to the nearest of the points."""
    distances = np.empty(len(queries))
    points = points.astype(np.float32)
    for i, query in enumerate(queries.astype(np.float32)):
        difference = points - query
        distances[i] = np.sqrt(np.einsum("ij,ij->i", difference, difference).min())
    return distances


def sample(values, count):
    if len(values) <= count:
        return values
    return values[np.random.default_rng(0).choice(len(values), count, replace=False)]


def poses(model):
    """Matrices, (3, 4), from the world to the camera, by the names of the images."""
    return {
        image.name: image.cam_from_world().matrix()
        for image in model.images.values()
        if image.has_pose
    }


def typical_depth(model):
    depths = []
    for image in model.images.values():
        ids = [p.point3D_id for p in image.points2D if p.has_point3D()]
        matrix = image.cam_from_world().matrix()
        points = np.array([model.points3D[i].xyz for i in ids])
        depths.append(points @ matrix[2, :3] + matrix[2, 3])
    return np.median(np.concatenate(depths))


def report(passed, text):
    print(f"{'PASS' if passed else 'FAIL'}  {text}")
    return passed


def versions():
    print(f"Today's COLMAP: {pycolmap.COLMAP_version}, pycolmap {pycolmap.__version__}, "
          f"numpy {np.__version__}, Python {platform.python_version()}; "
          f"dense stereo of its own: {'yes' if pycolmap.has_cuda else 'no, needs a GPU'}")
    return True


def same_model(path, copy):
    a, b = pycolmap.Reconstruction(path), pycolmap.Reconstruction(copy)
    counts = [
        (m.num_cameras(), m.num_reg_images(), m.num_points3D(), m.compute_num_observations())
        for m in (a, b)
    ]
    worst = np.inf
    if counts[0] == counts[1] and poses(a).keys() == poses(b).keys():
        differences = [0.0]
        other = {image.name: image for image in b.images.values()}
        for name, matrix in poses(a).items():
            differences.append(np.abs(matrix - poses(b)[name]).max())
        for image in a.images.values():
            for p, q in zip(image.points2D, other[image.name].points2D):
                differences.append(np.abs(p.xy - q.xy).max())
        for id_, point in a.points3D.items():
            differences.append(np.abs(point.xyz - b.points3D[id_].xyz).max())
        for id_, camera in a.cameras.items():
            same = camera.model == b.cameras[id_].model
            differences.append(np.abs(camera.params - b.cameras[id_].params).max()
                               if same else np.inf)
        worst = max(differences)
    names = ("cameras", "images", "points", "observations")
    found = ", ".join(f"{name} {count}" for name, count in zip(names, counts[1]))
    return report(
        worst <= 1e-9 and counts[1][2] > 500,
        f"the model came back whole: {found}; largest difference {worst:.1g}",
    )


def read_model(path, analysis):
    """What our model_analyzer says of our model, against what is read there."""
    model = pycolmap.Reconstruction(path)
    text = Path(analysis).read_text()
    said = {key: float(value) for key, value in
            re.findall(r"^(?:.*\] )?([A-Z][A-Za-z ]+): ([0-9.]+)(?:px)?$", text, re.M)}
    pairs = [
        (said["Cameras"], model.num_cameras()),
        (said["Registered images"], model.num_reg_images()),
        (said["Points"], model.num_points3D()),
        (said["Observations"], model.compute_num_observations()),
        (said["Mean reprojection error"], model.compute_mean_reprojection_error()),
    ]
    return report(
        all(abs(ours - theirs) <= 1e-5 for ours, theirs in pairs) and pairs[2][1] > 500,
        "our model as read there (here): cameras {} ({:.0f}), images {} ({:.0f}), points {} "
        "({:.0f}), observations {} ({:.0f}), mean error {:.4f} ({:.4f}) px".format(
            *(value for ours, theirs in pairs for value in (theirs, ours))),
    )


def same_cameras(path, other):
    """Undistorted by us and by them from one model."""
    a, b = pycolmap.Reconstruction(path), pycolmap.Reconstruction(other)
    worst = 0.0
    for id_, camera in a.cameras.items():
        twin = b.cameras[id_]
        if camera.model != twin.model or (camera.width, camera.height) != (twin.width, twin.height):
            worst = np.inf
        else:
            worst = max(worst, np.abs(camera.params - twin.params).max())
    matrices = poses(b)
    turned = max(np.abs(m - matrices[name]).max() for name, m in poses(a).items())
    return report(
        worst <= 0.5 and turned <= 1e-9,
        f"our model undistorted here and there: pinhole parameters within {worst:.2g} px, "
        f"poses within {turned:.1g}",
    )


def same_poses(path, other):
    """Two models of the same photographs, after the best similarity between them."""
    a, b = (poses(pycolmap.Reconstruction(p)) for p in (path, other))
    names = sorted(a.keys() & b.keys())
    centres = [
        np.array([-m[name][:, :3].T @ m[name][:, 3] for name in names]) for m in (a, b)
    ]
    x, y = (c - c.mean(axis=0) for c in centres)
    u, s, vt = np.linalg.svd(y.T @ x)
    sign = np.diag([1, 1, np.linalg.det(u @ vt)])
    scale = np.trace(np.diag(s) @ sign) / (x**2).sum()
    residuals = np.linalg.norm(y - scale * x @ (u @ sign @ vt).T, axis=1)
    error = 100 * np.median(residuals) / np.linalg.norm(y, axis=1).max()
    return report(
        len(names) >= 0.8 * max(len(a), len(b)) and error <= 1,
        f"models made here and there from the same photographs agree: {len(names)} common "
        f"images, median distance of the camera centres {error:.2f} % of their extent",
    )


def depth_maps(workspace):
    model = pycolmap.Reconstruction(workspace / "sparse")
    folder = workspace / "stereo" / "depth_maps"
    covered, errors = [], []
    missing = 0
    for image in model.images.values():
        path = folder / f"{image.name}.geometric.bin"
        if not path.is_file():
            missing += 1
            continue
        depths = read_map(path)[0]
        covered.append((depths > 0).mean())
        camera = model.cameras[image.camera_id]
        points = [model.points3D[p.point3D_id].xyz for p in image.points2D if p.has_point3D()]
        matrix = image.cam_from_world().matrix()
        local = np.array(points) @ matrix[:, :3].T + matrix[:, 3]
        xy = camera.img_from_cam(local)
        height, width = depths.shape
        x = np.floor(xy[:, 0] * width / camera.width).astype(int)
        y = np.floor(xy[:, 1] * height / camera.height).astype(int)
        inside = (x >= 0) & (x < width) & (y >= 0) & (y < height)
        found = depths[y[inside], x[inside]]
        expected = local[inside, 2]
        errors.append((np.abs(found - expected) / expected)[found > 0])
    errors = np.concatenate(errors) if errors else np.array([np.inf])
    good = 100 * (errors <= 0.02).mean()
    coverage = 100 * np.mean(covered) if covered else 0
    return report(
        missing == 0 and coverage >= 30 and np.median(errors) <= 0.005 and good >= 80,
        f"{len(covered)} depth maps of {model.num_reg_images()} images, {coverage:.0f} % of the "
        f"pixels filled; at {len(errors)} sparse points the median difference is "
        f"{100 * np.median(errors):.2f} %, {good:.0f} % are within 2 %",
    )


def map_files(workspace):
    equal = count = 0
    for path in map_paths(workspace, "photometric") + map_paths(workspace):
        count += 1
        depths, normals = pycolmap.DepthMap(), pycolmap.NormalMap()
        depths.read(path)
        normals.read(normal_path(path))
        raw = read_map(normal_path(path))
        lengths = np.linalg.norm(raw, axis=0)
        equal += (
            np.array_equal(depths.to_array(), read_map(path)[0])
            and (3, normals.height, normals.width) == raw.shape
            and np.allclose(lengths[read_map(path)[0] > 0], 1, atol=1e-4)
        )
    return report(
        count > 0 and equal == count,
        f"{equal} of {count} depth maps have the same values read there, and normals of length 1",
    )


def same_maps(workspace, rewritten):
    """Files that today's COLMAP wrote, and what we made from some of them."""
    identical = count = 0
    for path in sorted((workspace / "stereo").glob("*_maps/**/*.bin")):
        geometric = path.name.endswith(".geometric.bin")
        top = rewritten / ("expected" if geometric else "stereo")
        count += 1
        identical += (top / path.relative_to(workspace / "stereo")).read_bytes() == path.read_bytes()
    made = map_paths(rewritten)
    again = sum(
        p.read_bytes() == (workspace / p.relative_to(rewritten)).read_bytes() for p in made
    )
    passed = report(
        count > 0 and identical == count,
        f"{identical} of {count} maps that today's COLMAP read and wrote again are our files, "
        f"byte for byte",
    )
    return report(
        len(made) == 1 and again == 1,
        f"the geometric pass from its photometric maps: {again} of {len(made)} views as before, "
        f"byte for byte",
    ) and passed


def fused(workspace, theirs, ours):
    model = pycolmap.Reconstruction(workspace / "sparse")
    unit = typical_depth(model) / 100
    a, b = read_points(theirs), read_points(ours)
    difference = 100 * abs(len(a) - len(b)) / max(len(b), 1)
    passed = report(
        min(len(a), len(b)) >= 5000 and difference <= 5,
        f"fused from our maps: {len(a)} points there, {len(b)} here, {difference:.1f} % apart",
    )
    # Their rays go through the corners of pixels, ours through the centres.
    (camera, *_), (path, *_) = model.cameras.values(), map_paths(workspace)
    pixel = 100 * camera.width / (read_map(path).shape[2] * camera.focal_length_x)
    there, back = nearest(sample(a, 2000), b) / unit, nearest(sample(b, 2000), a) / unit
    far = [np.percentile(d, 95) for d in (there, back)]
    passed = report(
        max(np.median(there), np.median(back)) <= pixel and max(far) <= 3 * pixel,
        f"from the points fused there to ours and back: median distance {np.median(there):.3f} and "
        f"{np.median(back):.3f} % of the depth, 95th percentile {far[0]:.3f} and {far[1]:.3f} %; "
        f"a pixel is {pixel:.2f} % wide",
    ) and passed
    sparse = np.array([p.xyz for p in model.points3D.values() if p.track.length() >= 3])
    distances = nearest(sample(sparse, 2000), a) / unit
    near = 100 * (distances <= 2).mean()
    return report(
        np.median(distances) <= 1 and near >= 85,
        f"from the sparse points to those fused there: median distance "
        f"{np.median(distances):.2f} % of the depth, {near:.0f} % within 2 %",
    ) and passed


if __name__ == "__main__":
    try:
        passed = globals()[sys.argv[1]](*map(Path, sys.argv[2:]))
    except Exception as error:
        passed = report(False, f"{sys.argv[1]}: {type(error).__name__}: {error}")
    sys.exit(0 if passed else 1)
