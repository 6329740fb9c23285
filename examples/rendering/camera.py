"""Cameras: where they stand, and how they turn light into a photograph."""

import dataclasses

import numpy as np


@dataclasses.dataclass(frozen=True)
class Camera:
    """Pixels, and how the camera sees."""
    width: int = 720
    height: int = 480
    focal: float = 525.0
    exposure: float = 0.95
    balance: tuple = (1.0, 1.0, 1.0)  # gains of blue, green, red
    full_well: float = 4500.0  # electrons at white: the photon noise
    read_noise: float = 5.0  # electrons
    vignetting: float = 0.17  # loss of light in the corners
    jpeg_quality: int = 95

    def shrunk(self, divisor):
        """With so many times fewer pixels per side; None if that leaves no whole number."""
        if self.width % divisor or self.height % divisor:
            return None
        return dataclasses.replace(self, width=self.width // divisor,
                                   height=self.height // divisor, focal=self.focal / divisor)


class Pose:
    """A camera in POV-Ray's left-handed world (x right, y up, z forward)."""

    def __init__(self, eye, target, roll_degrees):
        self.eye = np.asarray(eye, float)
        forward = np.asarray(target, float) - self.eye
        self.forward = forward / np.linalg.norm(forward)
        right = np.cross((0.0, 1.0, 0.0), self.forward)
        right /= np.linalg.norm(right)
        up = np.cross(self.forward, right)
        roll = np.radians(roll_degrees)
        self.right = np.cos(roll) * right + np.sin(roll) * up
        self.up = np.cos(roll) * up - np.sin(roll) * right

    def world_to_camera(self):
        """R, t for a right-handed world (x right, y down, z forward), as COLMAP's."""
        flip = np.array((1.0, -1.0, 1.0))
        rotation = np.stack((self.right * flip, -self.up * flip, self.forward * flip))
        return rotation, -rotation @ (self.eye * flip)


def photograph(linear, camera, rng):
    """Exposure, vignetting, photon and read noise, tone curve; 8 bits."""
    height, width = linear.shape[:2]
    yy, xx = np.mgrid[0:height, 0:width]
    radius2 = ((xx + 0.5 - width / 2) ** 2 + (yy + 0.5 - height / 2) ** 2) / (
        (width / 2) ** 2 + (height / 2) ** 2)
    light = linear * camera.exposure * (1 - camera.vignetting * radius2)[..., None]
    light = light * np.array(camera.balance)
    electrons = light * camera.full_well
    electrons = electrons + rng.standard_normal(light.shape) * np.sqrt(
        electrons + camera.read_noise ** 2)
    light = np.clip(electrons / camera.full_well, 0, None)
    # A shoulder, so that highlights roll off instead of clipping.
    knee = 0.75
    over = np.maximum(light - knee, 0)
    light = np.where(light > knee, knee + (1 - knee) * over / (over + 1 - knee), light)
    encoded = np.where(light <= 0.0031308, 12.92 * light,
                       1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)
    return np.clip(np.rint(encoded * 255), 0, 255).astype(np.uint8)
