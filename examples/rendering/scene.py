"""A scene: a folder of examples/ with scene.pov, what stands where, and scene.py, whose
SCENE says all else."""

import dataclasses
import importlib
import os

from .camera import Camera

EXAMPLES = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


@dataclasses.dataclass(frozen=True)
class Quality:
    """How much work goes into light. The first numbers of examples/room took its 18 minutes."""
    oversampling: int = 2  # rays per pixel and axis
    antialiasing: tuple = ("+A0.12", "-J", "+AM1", "+R2", "Antialias_Gamma=2.2")
    # Indirect light is gathered from every so many views, with so many times fewer pixels.
    light_every: int = 1
    light_divisor: int = 2
    gather_more: bool = True  # where a view lacks some
    # POV-Ray's radiosity: count, recursion_limit, nearest_count, error_bound, minimum_reuse.
    rays: int = 240
    recursion: int = 2
    nearest: int = 14
    error_bound: float = 0.42
    reuse: float = 0.012


# A fifth of the time: two reflections less, and one ray per pixel where neighbours agree.
FAST = Quality(oversampling=1, antialiasing=("+A0.1", "-J", "+AM1", "+R2", "Antialias_Gamma=2.2"),
               light_every=3, light_divisor=4, gather_more=False, rays=120, recursion=1,
               nearest=10, error_bound=0.6, reuse=0.03)


@dataclasses.dataclass(frozen=True)
class Scene:
    name: str
    poses: list  # camera.Pose, in the order of the walk
    pictures: list  # (file, function of a random generator), which scene.pov looks up
    camera: Camera = Camera()
    quality: Quality = Quality()
    depth_range: float = 8.0  # metres that a depth pass of 16 bits spans
    seed: int = 100  # of the noise of the first photograph

    def source(self):
        return os.path.join(EXAMPLES, self.name, "scene.pov")

    def view_name(self, view):
        return "%s_%02d" % (self.name, view)


def names():
    """Of all scenes."""
    return sorted(name for name in os.listdir(EXAMPLES)
                  if os.path.isfile(os.path.join(EXAMPLES, name, "scene.pov")))


def load(name):
    """A scene by its name. EXAMPLES must be among the folders of modules."""
    return importlib.import_module(name + ".scene").SCENE
