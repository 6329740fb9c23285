"""How a folder of exported maps is laid out, and the text beside them that says what they mean.

    depth/NAME.png, normals/NAME.png, confidence/NAME.png, or with another extension; NAME is the
    photograph's, with its own extension and in its own sub-folders
    maps.json
"""

import math
import os
from typing import Optional

from .. import files, processes, schemas
from ..processes import Failure

DEPTH, NORMALS, CONFIDENCE = "depth", "normals", "confidence"


class Scale(schemas.Number):
    """Steps per unit, of whatever size the unit is."""

    @classmethod
    def _check(cls, value):
        if not 0 < super()._check(value) < math.inf:
            raise ValueError("value is not positive")
        return value


class Record(schemas.Model):
    """What is read back of maps.json."""
    depth_scale: Optional[Scale] = None


def record_path(folder):
    return os.path.join(folder, "maps.json")


def map_path(folder, kind, name, extension):
    return os.path.join(folder, kind, name + extension)


def read_record(folder):
    return files.read_json(record_path(folder), Record) or Record()


def warn(names, what):
    """Says what there is to say of these files or photographs, if there are any."""
    if names:
        processes.say(f"WARNING: {len(names)} {what}, such as {names[0]}")


def write_record(folder, extension, input_type, cameras, scales, confidence):
    """cameras: of each map's size, by name; scales: of PNG, by kind; confidence: what it is."""
    def stored(kind):
        return f"value / {kind}_scale" if kind in scales else "value"

    files.write_json(record_path(folder), {
        "format": extension[1:],
        "maps": input_type,
        **{f"{kind}_scale": scale for kind, scale in scales.items()},
        "meaning": {
            "files": f"{DEPTH}/NAME{extension}, {NORMALS}/NAME{extension}"
                     + (f", {CONFIDENCE}/NAME{extension}" if confidence else "")
                     + " for every NAME in views",
            "depth": f"{stored(DEPTH)}, along the optical axis (z in the camera's frame, not the "
                     "distance along the ray), in units of the sparse model; 0: none",
            "normals": "unit vectors (x, y, z) in the camera's frame that point towards the camera"
                       + (" = 2 value / 65535 - 1 of red, green, blue" if scales else "")
                       + "; 0 0 0: none",
            "confidence": f"{stored(CONFIDENCE)}: {confidence}; 0: none" if confidence else None,
            "camera_frame": "x to the right, y down, z forward; poses are in the sparse model",
            "pixels": "row by row from the top (as programs show PFM, which stores the last row "
                      "first); the centre of the top-left pixel is at (0.5, 0.5)",
        },
        "views": {name: _intrinsics(camera) for name, camera in cameras.items()}})


def _intrinsics(camera):
    return {"width": camera.width, "height": camera.height,
            **dict(zip(("fx", "fy", "cx", "cy"), camera.pinhole))}
