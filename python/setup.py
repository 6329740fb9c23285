"""Builds the package tapa_mvs: the library behind it, and a module around that.

scripts/build.sh makes the library, in the folder that it makes the program in: what is built
there already is used. BUILD_DIR names another folder than build/.

Of the package evaluation come along, in tapa_mvs.evaluation, those modules that read maps. With
TAPA_JOBS_LIBRARY, the path of the library, nothing but the module is built.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext
from setuptools.command.build_py import build_py

ROOT = Path(__file__).resolve().parent.parent
BUILD = Path(os.environ.get("BUILD_DIR") or ROOT / "build").resolve()
LIBRARY = Path(os.environ.get("TAPA_JOBS_LIBRARY") or BUILD / "python" / "libtapa_jobs.so")
EVALUATION = """
    binary_model blocks colmap_model depth_maps files model_names point_clouds processes progress
    texts workspaces exchange/__init__ exchange/confidences page/__init__ page/confidence
    page/workspace
""".split()

try:
    from pybind11 import get_include
    PYBIND11 = [get_include()]
except ImportError:  # Debian's pybind11-dev, among the headers of the system.
    PYBIND11 = []


def plain_environment():
    """Without the environment of Python's that pip has made for a moment, or this one."""
    def is_passing(folder):
        return "pip-build-env" in folder or Path(folder) == Path(sys.prefix, "bin")

    variables = {name: value for name, value in os.environ.items()
                 if not name.startswith(("PYTHON", "VIRTUAL_ENV"))}
    folders = os.environ.get("PATH", os.defpath).split(os.pathsep)
    variables["PATH"] = os.pathsep.join(
        folder for folder in folders if not is_passing(folder) or sys.prefix == sys.base_prefix)
    return variables


class BuildModule(build_ext):
    def run(self):
        if "TAPA_JOBS_LIBRARY" not in os.environ:
            subprocess.run([ROOT / "scripts" / "build.sh", "tapa_jobs"], check=True,
                           env={**plain_environment(), "BUILD_DIR": str(BUILD)})
        super().run()
        package = Path(self.build_lib, "tapa_mvs")
        shutil.copy2(LIBRARY, package)
        # Of what the library has of COLMAP.
        shutil.copy2(LIBRARY.parent.parent / "colmap-3.8" / "COPYING.txt",
                     package / "colmap-copyright.txt")


class BuildPackage(build_py):
    def run(self):
        super().run()
        package = Path(self.build_lib, "tapa_mvs")
        for name in EVALUATION:
            target = package / "evaluation" / f"{name}.py"
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / "evaluation" / f"{name}.py", target)
        shutil.copy2(ROOT / "LICENSE", package)


setup(
    cmdclass={"build_ext": BuildModule, "build_py": BuildPackage},
    ext_modules=[Extension(
        "tapa_mvs._engine", ["engine.cc"], include_dirs=[str(ROOT), *PYBIND11],
        depends=["jobs.h"], libraries=["tapa_jobs"], library_dirs=[str(LIBRARY.parent)],
        extra_compile_args=["-std=c++17", "-O2", "-fvisibility=hidden", "-Wall", "-Wextra"],
        # The library lies beside the module.
        extra_link_args=["-Wl,-rpath,$ORIGIN"])])
