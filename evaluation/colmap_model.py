"""Cameras and poses of a COLMAP text model, and the camera models of ETH3D.

A pixel is a pair (x, y) as in COLMAP: x to the right, y down, the centre of the
top-left pixel at (0.5, 0.5). A ray is the pair (u, v) of a point (u, v, 1) in the
camera's frame (x right, y down, z forward), so that a depth z at the ray is the
point (u z, v z, z). Unreadable files raise Failure with the path in the message.
"""

import math
import os
from dataclasses import dataclass

import numpy as np

from .processes import Failure

_MAX_SIDE = 1_000_000  # Of a photograph, in pixels, as COLMAP's maps have it.
# Number of parameters by the name of the model.
PARAMETERS = {"SIMPLE_PINHOLE": 3, "PINHOLE": 4, "THIN_PRISM_FISHEYE": 12}


@dataclass(frozen=True)
class Camera:
    """One line of cameras.txt."""
    model: str
    width: int
    height: int
    params: tuple

    @property
    def pinhole(self):
        """Focal lengths and principal point, fx, fy, cx, cy."""
        return self.params[:1] * (self.model == "SIMPLE_PINHOLE") + self.params[:4]

    def resized(self, width, height):
        """The same for a photograph that was made larger or smaller; not of a fisheye."""
        x, y = width / self.width, height / self.height
        fx, fy, cx, cy = self.pinhole
        return Camera("PINHOLE", width, height, (fx * x, fy * y, cx * x, cy * y))

    def contains(self, x, y):
        """Which pixels (arrays of one shape) the photograph has; NaN is none."""
        return (x >= 0) & (x < self.width) & (y >= 0) & (y < self.height)


@dataclass(frozen=True)
class View:
    """One photograph of images.txt: x_camera = rotation x_world + translation."""
    number: int
    name: str
    camera: Camera
    rotation: np.ndarray  # (3, 3)
    translation: np.ndarray  # (3,)

    def camera_to_world(self):
        """Matrix, (4, 4), from this camera's frame to the world's."""
        matrix = np.eye(4)
        matrix[:3, :3] = self.rotation.T
        matrix[:3, 3] = -self.rotation.T @ self.translation
        return matrix


def rotation_of(quaternion):
    """Rotation matrix, (3, 3), of (w, x, y, z), which need not have unit length.

    The Python package, which reads models with this, needs no more than numpy.
    """
    length = np.linalg.norm(quaternion)
    if not 0 < length < np.inf:
        raise ValueError(f"{quaternion} is no rotation")
    w, x, y, z = np.divide(quaternion, length)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def check_finite(pose):
    if not all(map(math.isfinite, pose)):
        raise ValueError(f"{pose} is no pose")


def lines_in(text):
    """Those that are no comments. Only a line feed, with or without a carriage return, ends one."""
    return [line.rstrip("\r") for line in text.split("\n") if not line.startswith("#")]


def _lines(path):
    try:
        with open(path, encoding="utf-8-sig", newline="\n") as file:
            return lines_in(file.read())
    except (OSError, UnicodeDecodeError) as error:
        raise Failure(f"{path} cannot be read: {error}") from error


def check_camera(camera, number, path):
    """Raises Failure if a camera cannot be used."""
    model = camera.model
    if model not in PARAMETERS:
        raise Failure(f"{path}: cannot use the camera model {model}; there are "
                      + ", ".join(PARAMETERS))
    if len(camera.params) != PARAMETERS[model]:
        raise Failure(f"{path}: {model} has {PARAMETERS[model]} parameters, "
                      f"not {len(camera.params)}")
    if not (0 < camera.width <= _MAX_SIDE and 0 < camera.height <= _MAX_SIDE):
        raise Failure(f"{path}: camera {number} has no pixels, or more than a photograph has")
    if not all(map(math.isfinite, camera.params)):
        raise Failure(f"{path}: camera {number} has a parameter that is not a finite number")


def check_name(name, path):
    """Raises Failure unless a model's name of a photograph is that of a file below a folder.

    Whatever is made of a photograph is named after it: see src/colmap/image_name.h.
    """
    parts = name.split("/")
    if (not name or not parts[0] or ".." in parts or len(os.fsencode(name)) > 4000
            or max(len(os.fsencode(part)) for part in parts) > 255
            or any(ord(letter) < 32 or ord(letter) == 127 for letter in name)):
        raise Failure(f"{path} calls a photograph '{name[:100]}', which leads out of the folder of images "
                      "or is no name of a file; rename it there")


def name_in(line):
    """The name in the line of a photograph: the rest after nine numbers, and a blank."""
    fields = line.split(" ", 9)
    if len(fields) == 10 and all(fields[:9]):
        return fields[9].rstrip()
    return line.split(maxsplit=9)[-1].strip()


def read_cameras(path):
    """Cameras by their numbers."""
    cameras = {}
    for line in _lines(path):
        fields = line.split()
        if not fields:
            continue
        try:
            number, model = int(fields[0]), fields[1]
            camera = Camera(model, int(fields[2]), int(fields[3]),
                            tuple(float(value) for value in fields[4:]))
        except (IndexError, ValueError) as error:
            raise Failure(f"{path}: no camera in the line '{line}'") from error
        check_camera(camera, number, path)
        cameras[number] = camera
    if not cameras:
        raise Failure(f"{path} holds no camera")
    return cameras


def read_views(folder):
    """Views of the text model in a folder, in the order of their names."""
    cameras = read_cameras(os.path.join(folder, "cameras.txt"))
    path = os.path.join(folder, "images.txt")
    lines = _lines(path)
    views = []
    # A line of observations, which may be empty, follows each photograph's own.
    for line in lines[0::2]:
        if not line.strip():
            continue
        fields = line.split(maxsplit=9)
        try:
            pose = [float(value) for value in fields[1:8]]
            check_finite(pose)
            if len(fields) < 10:
                raise IndexError("no name")
            view = View(int(fields[0]), name_in(line), cameras[int(fields[8])],
                        rotation_of(pose[:4]), np.array(pose[4:7]))
        except (IndexError, KeyError, ValueError) as error:
            raise Failure(f"{path}: no photograph of a known camera in the line "
                             f"'{line[:80]}'") from error
        check_name(view.name, path)
        views.append(view)
    if not views:
        raise Failure(f"{path} holds no photograph")
    return sorted(views, key=lambda view: view.name)


def read_observations(folder):
    """What each view sees: (x, y, number of the point or -1) in rows, by view number."""
    lines = _lines(os.path.join(folder, "images.txt"))
    observations = {}
    for head, tail in zip(lines[0::2], lines[1::2]):
        if head.strip():
            observations[int(head.split()[0])] = np.array(tail.split(), float).reshape(-1, 3)
    return observations


def read_points(folder):
    """Positions, (3,), of the model's points by their numbers."""
    points = {}
    for line in _lines(os.path.join(folder, "points3D.txt")):
        if line.strip():
            fields = line.split(maxsplit=4)
            points[int(fields[0])] = np.array(fields[1:4], float)
    return points


def _thin_prism_fisheye(u, v, k1, k2, p1, p2, k3, k4, sx1, sy1):
    """Where the model moves a point: the equidistant fisheye's (u, v) to (u', v')."""
    uu, vv, uv = u * u, v * v, u * v
    rr = uu + vv
    radial = rr * (k1 + rr * (k2 + rr * (k3 + rr * k4)))
    return (u + u * radial + 2 * p1 * uv + p2 * (rr + 2 * uu) + sx1 * rr,
            v + v * radial + 2 * p2 * uv + p1 * (rr + 2 * vv) + sy1 * rr)


def _largest_angle(params):
    """Up to which angle to the optical axis the radial terms keep points apart.

    Beyond it the polynomial, which was fitted to what the lens sees, turns back and
    would show rays from outside the photograph within it.
    """
    k1, k2, _, _, k3, k4 = params[4:10]
    angle = np.linspace(0, np.pi / 2, 2000)
    rr = angle * angle
    slope = 1 + rr * (3 * k1 + rr * (5 * k2 + rr * (7 * k3 + rr * 9 * k4)))
    folded = np.flatnonzero(slope <= 0)
    return angle[folded[0]] if len(folded) else np.pi / 2


def project(camera, u, v):
    """Pixels x, y of rays u, v (arrays of one shape); NaN where the model ends."""
    u, v = np.asarray(u, float), np.asarray(v, float)
    fx, fy, cx, cy = camera.pinhole
    if camera.model == "THIN_PRISM_FISHEYE":
        radius = np.hypot(u, v)
        angle = np.arctan(radius)
        angle = np.where(angle < _largest_angle(camera.params), angle, np.nan)
        scale = np.divide(angle, radius, out=np.ones_like(radius), where=radius > 1e-9)
        u, v = _thin_prism_fisheye(u * scale, v * scale, *camera.params[4:])
    return fx * u + cx, fy * v + cy


def unproject(camera, x, y):
    """Rays u, v of pixels x, y (arrays of one shape); NaN where there is none."""
    fx, fy, cx, cy = camera.pinhole
    u, v = (np.asarray(x, float) - cx) / fx, (np.asarray(y, float) - cy) / fy
    if camera.model == "THIN_PRISM_FISHEYE":
        u, v = _undo_thin_prism_fisheye(camera.params, u, v)
    return u, v


def _undo_thin_prism_fisheye(params, u, v):
    """The inverse, by Newton's method with differences for derivatives."""
    a, b = u.copy(), v.copy()
    step = 1e-6
    with np.errstate(all="ignore"):
        for _ in range(30):
            u0, v0 = _thin_prism_fisheye(a, b, *params[4:])
            ua, va = _thin_prism_fisheye(a + step, b, *params[4:])
            ub, vb = _thin_prism_fisheye(a, b + step, *params[4:])
            uu, vu, uv, vv = (ua - u0) / step, (va - v0) / step, (ub - u0) / step, (vb - v0) / step
            determinant = uu * vv - uv * vu
            du, dv = u - u0, v - v0
            a = a + (vv * du - uv * dv) / determinant
            b = b + (uu * dv - vu * du) / determinant
        angle = np.hypot(a, b)
        u0, v0 = _thin_prism_fisheye(a, b, *params[4:])
        wrong = ~((np.hypot(u0 - u, v0 - v) < 1e-9) & (angle < _largest_angle(params)))
        scale = np.divide(np.tan(angle), angle, out=np.ones_like(angle), where=angle > 1e-9)
    scale = np.where(wrong, np.nan, scale)
    return a * scale, b * scale


def pixel_centres(camera):
    """x and y of the centres of all pixels, each (height, width)."""
    return np.meshgrid(np.arange(camera.width) + 0.5, np.arange(camera.height) + 0.5)


def pixel_rays(camera):
    """Rays of the centres of all pixels, u and v, each (height, width)."""
    return unproject(camera, *pixel_centres(camera))
