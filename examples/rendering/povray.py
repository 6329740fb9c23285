"""Renders views of a scene with POV-Ray."""

import os
import subprocess
import threading

import cv2
import numpy as np

from .scene import EXAMPLES


class Renderer:
    """Of one scene, with files in the folder work."""

    def __init__(self, scene, camera, work):
        self._scene = scene
        self._camera = camera
        self._work = work
        self._cache = os.path.join(work, "light.rad")
        self._running = set()
        self._is_stopped = False
        self._lock = threading.Lock()

    def stop(self):
        """Ends what runs in other threads."""
        with self._lock:
            self._is_stopped = True
            for process in self._running:
                process.kill()

    def gather_light(self, views):
        """Gathers the indirect light of all views in one file, so that a wall looks the
        same in every photograph."""
        quality, camera = self._scene.quality, self._camera
        for index, view in enumerate(views[::quality.light_every]):
            options = ["-A", "Radiosity_File_Name=" + self._cache, "Radiosity_To_File=on",
                       "Radiosity_From_File=" + ("on" if index else "off"),
                       "Radiosity_Vain_Pretrace=on"]
            self._render("light_%02d" % view, view, options,
                         size=(camera.width // quality.light_divisor,
                               camera.height // quality.light_divisor))

    def colour(self, view):
        """Linear light, 0 to 1, blue first. Indirect light must have been gathered."""
        quality, camera = self._scene.quality, self._camera
        options = [*quality.antialiasing, "Radiosity_File_Name=" + self._cache,
                   "Radiosity_From_File=on", "Radiosity_To_File=off"]
        big = self._render("colour_%02d" % view, view, options,
                           size=(quality.oversampling * camera.width,
                                 quality.oversampling * camera.height),
                           gather=quality.gather_more)
        return cv2.resize(big.astype(np.float32), (camera.width, camera.height),
                          interpolation=cv2.INTER_AREA) / 65535.0

    def depth(self, view):
        """Planar z in metres through the centres of the pixels, one ray each."""
        encoded = self._render("depth_%02d" % view, view, ["-A", "-J"], depth_pass=True,
                               size=(self._camera.width, self._camera.height))
        if encoded.ndim == 3:
            encoded = encoded[..., 0]
        return encoded.astype(np.float64) * (self._scene.depth_range / 65535.0)

    def _write_view(self, path, view, depth_pass, gather):
        pose, camera, quality = self._scene.poses[view], self._camera, self._scene.quality

        def vector(v):
            return "<%.12f, %.12f, %.12f>" % tuple(v)

        with open(path, "w", encoding="utf-8") as f:
            for name, text in (
                    ("Pass", "%d" % depth_pass),
                    ("Eye", vector(pose.eye)), ("Right", vector(pose.right)),
                    ("Up", vector(pose.up)), ("Forward", vector(pose.forward)),
                    ("WidthOverFocal", "%.12f" % (camera.width / camera.focal)),
                    ("HeightOverFocal", "%.12f" % (camera.height / camera.focal)),
                    ("DepthRange", "%.12f" % self._scene.depth_range),
                    ("PretraceStart", "%.4f" % (0.08 if gather else 1)),
                    ("PretraceEnd", "%.4f" % (0.02 if gather else 1)),
                    ("RadiosityCount", "%d" % quality.rays),
                    ("RadiosityRecursion", "%d" % quality.recursion),
                    ("RadiosityNearest", "%d" % quality.nearest),
                    ("RadiosityErrorBound", "%.4f" % quality.error_bound),
                    ("RadiosityReuse", "%.4f" % quality.reuse)):
                f.write("#declare %s = %s;\n" % (name, text))

    def _render(self, name, view, options, size, depth_pass=False, gather=True):
        """Runs POV-Ray in a folder of its own; returns linear 16-bit BGR."""
        folder = os.path.join(self._work, name)
        os.makedirs(folder, exist_ok=True)
        self._write_view(os.path.join(folder, "view.inc"), view, depth_pass, gather)
        out = os.path.join(folder, "out.png")
        # One thread: with several, radiosity depends on chance.
        command = ["povray", "+I" + self._scene.source(), "+L" + folder, "+L" + self._work,
                   "+L" + os.path.join(EXAMPLES, "rendering"), "+O" + out,
                   "+W%d" % size[0], "+H%d" % size[1], "+FN16", "File_Gamma=1.0", "-D",
                   "+WT1", "Verbose=off"] + options
        with self._lock:
            if self._is_stopped:
                raise RuntimeError("stopped")
            process = subprocess.Popen(command, cwd=self._work, stdin=subprocess.DEVNULL,
                                       stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                       encoding="utf-8", errors="replace")
            self._running.add(process)
        try:
            printed, _ = process.communicate()
        finally:
            with self._lock:
                self._running.discard(process)
        image = cv2.imread(out, cv2.IMREAD_UNCHANGED) if process.returncode == 0 else None
        if image is None:
            raise RuntimeError("POV-Ray failed on %s of %s: %s" % (
                name, self._scene.name, printed.split("[Parsing...]")[-1].strip()))
        return image
