"""MeshLab projects (.mlp), which list laser scans and where their scanners stood.

A pose is a matrix, (4, 4), from the frame of a scan, in which the scanner is at the
origin, to that of the world.
"""

import os
import xml.etree.ElementTree as ElementTree

import numpy as np

from . import files
from .processes import Failure

# How far a matrix that was written as text may be from a rotation: a millimetre in ten metres.
_MAX_ROTATION_ERROR = 1e-4


def read(path):
    """(path of the PLY, pose) of each scan. Raises Failure, which names the file."""
    try:
        root = ElementTree.parse(path).getroot()
    except OSError as error:
        raise Failure(f"{path} cannot be read: {error.strerror}") from error
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        raise Failure(f"{path} is not a MeshLab project: {error}") from error
    if root.tag != "MeshLabProject":
        raise Failure(f"{path} is not a MeshLab project")
    scans = []
    for number, mesh in enumerate(root.findall("MeshGroup/MLMesh"), 1):
        name = mesh.get("filename")
        if not name:
            raise Failure(f"{path}: scan {number} has no file name")
        # An absolute name stands for itself.
        scans.append((os.path.join(os.path.dirname(path), name),
                      _pose(mesh.findtext("MLMatrix44"), f"{path}: scan {name}")))
    if not scans:
        raise Failure(f"{path} lists no scan")
    return scans


def _pose(text, where):
    if text is None:
        raise Failure(f"{where} has no pose (MLMatrix44)")
    try:
        matrix = np.array(text.split(), float)
    except ValueError:
        matrix = np.empty(0)
    if matrix.shape != (16,) or not np.isfinite(matrix).all():
        raise Failure(f"{where} has a pose that is not 16 numbers (MLMatrix44)")
    matrix = matrix.reshape(4, 4)
    if (matrix[3] != (0, 0, 0, 1)).any():
        raise Failure(f"{where} has a pose whose last row is not 0 0 0 1")
    rotation = matrix[:3, :3]
    error = np.abs(rotation @ rotation.T - np.eye(3)).max()
    if error > _MAX_ROTATION_ERROR or np.linalg.det(rotation) < 0:
        raise Failure(f"{where} has a pose that is not a rotation and a translation: apply "
                      "scale, shear or reflection to the points of the scan")
    return matrix


def write(path, scans):
    """Writes a project of (name of a PLY beside it, pose) pairs."""
    project = ElementTree.Element("MeshLabProject")
    group = ElementTree.SubElement(project, "MeshGroup")
    for name, pose in scans:
        mesh = ElementTree.SubElement(group, "MLMesh", label=name, filename=name)
        rows = (" ".join(f"{value:.12g}" for value in row) for row in pose)
        ElementTree.SubElement(mesh, "MLMatrix44").text = "\n" + " \n".join(rows) + " \n"
    ElementTree.SubElement(project, "RasterGroup")
    ElementTree.indent(project, " ")
    files.write_text(path, "<!DOCTYPE MeshLabDocument>\n"
                     + ElementTree.tostring(project, encoding="unicode") + "\n")
