"""Normals from nothing but depth.

On a plane the inverse of the depth changes by the same amount from pixel to pixel, and how much
says how the plane stands: with n (u, v, 1) z = d at the ray (u, v, 1), 1 / z is n / d times it.
"""

import math

import numpy as np

from .. import colmap_model, depth_maps

_RADIUS = 2  # Of the window in which a plane is fitted, in pixels.
_STEEPEST = 10.0  # Tangent of the angle to a ray, up to which a slope is no edge between surfaces.
_RIDGE = 1e-3  # Little next to the square of a pixel; what has one solution keeps it.


def normals_from_depth(depth, camera):
    """Unit normals in the camera's frame, (height, width, 3), 0 where there is no depth.

    camera: of pictures of the size of the map. A pixel without neighbours of its surface faces
    along the optical axis.
    """
    is_known = depth_maps.is_depth(depth)
    inverse = np.divide(1, depth, out=np.zeros(depth.shape, np.float32), where=is_known)
    fx, fy, _, _ = camera.pinhole
    across, down = _slopes(inverse, fx, fy)
    u, v = colmap_model.pixel_rays(camera)
    across, down = fx * across, fy * down
    # Times the ray this is -1 / z: it faces the camera.
    normals = np.dstack((-across, -down, across * u + down * v - inverse))
    length = np.linalg.norm(normals, axis=2, keepdims=True)
    return np.divide(normals, length, out=np.zeros(normals.shape, np.float32),
                     where=is_known[:, :, None], casting="same_kind")


def _slopes(inverse, fx, fy):
    """Change of the inverse depth from a pixel to the next one, across and down.

    Least squares over the differences to those pixels of the window that may be of the same
    surface. Where all of these stand in a line, there is no change to either side of it.
    """
    height, width = inverse.shape
    padded = np.pad(inverse, _RADIUS)
    xx, xy, yy, xw, yw = (np.zeros_like(inverse) for _ in range(5))
    window = range(-_RADIUS, _RADIUS + 1)
    for x, y in ((x, y) for y in window for x in window if x or y):
        other = padded[_RADIUS + y:_RADIUS + y + height, _RADIUS + x:_RADIUS + x + width]
        change = other - inverse
        steepest = np.float32(_STEEPEST * math.hypot(x / fx, y / fy)) * inverse
        is_same = (other > 0) & (np.abs(change) <= steepest)
        change *= is_same
        for total, weight in ((xx, x * x), (xy, x * y), (yy, y * y)):
            total += weight * is_same
        xw += x * change
        yw += y * change
    xx += _RIDGE
    yy += _RIDGE
    determinant = xx * yy - xy * xy
    return (yy * xw - xy * yw) / determinant, (xx * yw - xy * xw) / determinant
