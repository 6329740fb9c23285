"""Names the Debian packages that are missing to build and test the Python package."""

import importlib.util
import os
import sysconfig


def has_header(name):
    folders = (sysconfig.get_path("include"), "/usr/include")
    return any(os.path.exists(os.path.join(folder, name)) for folder in folders)


present = {
    "pybind11-dev": has_header("pybind11/pybind11.h") or importlib.util.find_spec("pybind11"),
    "python3-dev": has_header("Python.h"),
    "python3-numpy": importlib.util.find_spec("numpy"),
    "python3-setuptools": importlib.util.find_spec("setuptools"),
}
print(", ".join(name for name, is_present in present.items() if not is_present))
