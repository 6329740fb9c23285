"""Memory follows the caches' sizes and the size of a view, not the number of views."""

import os
import re
import resource
import struct
import unittest

import tiny_workspace as tiny

BASELINE = 0.1
DEPTH = 4.0
MEGABYTES_PER_VIEW = 0.05
REACH = 5  # The points that a camera sees are within so many places of cameras.


def make_model(path, names, width, height, baseline):
    """A row of cameras before a wall; points are seen from near by only, as in a real scene."""
    os.makedirs(path)
    with open(os.path.join(path, "cameras.txt"), "w") as file:
        file.write("1 PINHOLE %d %d %d %d %r %r\n" % (
            width, height, width, width, width / 2, height / 2))
    points = [(i * baseline / 2, 0.2 * (i % 5 - 2)) for i in range(2 * len(names))]
    tracks = [[] for _ in points]
    with open(os.path.join(path, "images.txt"), "w") as file:
        for i, name in enumerate(names):
            first = max(0, 2 * i - 2 * REACH)
            seen = range(first, min(len(points), 2 * i + 2 * REACH + 1))
            file.write("%d 1 0 0 0 %r 0 0 1 %s\n" % (i + 1, -i * baseline, name))
            for number, j in enumerate(seen):
                tracks[j].append("%d %d" % (i + 1, number))
                x, y = points[j]
                file.write("%r %r %d " % (width * (x - i * baseline) / DEPTH + width / 2,
                                          width * y / DEPTH + height / 2, j + 1))
            file.write("\n")
    with open(os.path.join(path, "points3D.txt"), "w") as file:
        for j, (x, y) in enumerate(points):
            file.write("%d %r %r %r 9 9 9 0.1 %s\n" % (j + 1, x, y, DEPTH, " ".join(tracks[j])))


def make_workspace(path, num_views, width, height, baseline=BASELINE):
    """All views share the files of a few, which hold more than the program could tell apart."""
    names = ["view%04d.png" % i for i in range(num_views)]
    images = os.path.join(path, "images")
    tiny.make_images(images, ["a.png"], width, height)
    for name in names:
        os.link(os.path.join(images, "a.png"), os.path.join(images, name))
    make_model(os.path.join(path, "sparse"), names, width, height, baseline)
    tiny.make_config(path, names, sources="__auto__, 4")
    return names


def write_maps(workspace, names, width, height):
    """Of the wall, which looks the same from everywhere."""
    count = width * height
    for kind, values in (("depth_maps", struct.pack("<f", DEPTH) * count),
                         ("normal_maps", struct.pack("<f", 0) * 2 * count +
                          struct.pack("<f", -1) * count)):
        first = tiny.map_path(workspace, names[0], kind)
        with open(first, "wb") as file:
            file.write(b"%d&%d&%d&" % (width, height, len(values) // count // 4) + values)
        for name in names[1:]:
            os.link(first, tiny.map_path(workspace, name, kind))


class ControlGroup:
    """A group of processes with a limit on their memory, as containers and batch jobs make.

    Raises OSError where there are none, or where this process may not make one."""

    def __init__(self, limit):
        with open("/proc/self/cgroup") as file:
            groups = dict(line.rstrip("\n").split(":", 2)[1:] for line in file)
        version_1 = "memory" in groups
        parent = ("/sys/fs/cgroup/memory" + groups["memory"] if version_1 else
                  "/sys/fs/cgroup" + groups[""])
        self.path = os.path.join(parent, "tapa_memory_test_%d" % os.getpid())
        os.mkdir(self.path)
        try:
            name = "memory.limit_in_bytes" if version_1 else "memory.max"
            with open(os.path.join(self.path, name), "r+") as file:
                file.write(str(limit))
        except OSError:
            self.remove()
            raise

    def enter(self):
        with open(os.path.join(self.path, "cgroup.procs"), "w") as file:
            file.write(str(os.getpid()))

    def remove(self):
        os.rmdir(self.path)


def peak_megabytes(result):
    return int(re.search(r"Peak memory: (\d+) MB of \d+ MB", result.stdout)[1])


class MemoryTest(tiny.TestCase):

    def assert_bounded(self, run):
        """run: number of views to the output of the program. What there is of a view besides
        photograph, maps and points, such as its camera and what it shares with others, is small."""
        few, many = (peak_megabytes(run(number)) for number in (100, 1000))
        print("Peak memory with 100 views %d MB, with 1,000 views %d MB" % (few, many))
        self.assertGreater(few, 10)
        self.assertLess(many - few, 900 * MEGABYTES_PER_VIEW, "%d and %d MB" % (few, many))

    def test_fusion(self):
        width, height = 240, 180

        def fuse(num_views, cache_size=0.005):
            workspace = self.path("fusion%d" % num_views)
            if not os.path.exists(workspace):
                names = make_workspace(workspace, num_views, width, height)
                write_maps(workspace, names, width, height)
            result = tiny.run([
                tiny.COLMAP, "stereo_fusion", "--workspace_path", workspace,
                "--output_path", self.path("%d_%r.ply" % (num_views, cache_size)),
                "--StereoFusion.agreement_num_views", "4", "--StereoFusion.agreement_spread", "0",
                "--StereoFusion.agreement_cache_size", str(cache_size)])
            self.assert_success(result)
            # Each view asks for itself and its neighbours, of which most were asked for before.
            found = re.search(r"Found in the cache: (\d+) % of (\d+) maps", result.stdout)
            self.assertEqual(int(found[2]), 5 * num_views)
            self.assertGreater(int(found[1]), 60)
            return result

        # All maps would be 345 MB, all points 484 MB.
        self.assert_bounded(fuse)
        # The points that were kept in a file are those that memory would have held.
        fuse(100, cache_size=1)
        for end in ("", ".vis"):
            with open(self.path("100_0.005.ply" + end), "rb") as file:
                with open(self.path("100_1.ply" + end), "rb") as other:
                    self.assertEqual(file.read(), other.read())
        self.assertEqual([name for name in os.listdir(self.path("fusion100"))
                          if "part" in name], [])

    def test_stereo(self):
        """The parts of a run that look at all views, and at those of a share."""
        width, height = 480, 360

        def compute(num_views):
            workspace = self.path("stereo%d" % num_views)
            make_workspace(workspace, num_views, width, height)
            options = {"num_levels": 1, "cache_size": 0.005}
            prepared = tiny.run_stereo(workspace, step=0, **options)
            self.assert_success(prepared)
            self.assertIn("of %d photographs" % num_views, prepared.stdout)
            computed = tiny.run_stereo(workspace, step=1, share="1/%d" % num_views, **options)
            self.assert_success(computed)
            self.assertIn("has 1 views to compute", computed.stdout)
            return max(prepared, computed, key=peak_megabytes)

        # All photographs would be 173 MB.
        self.assert_bounded(compute)

    def check_limit(self, limit, take_limit):
        """What is sized by the machine's memory is sized by the limit."""
        tiny.make_workspace(self.folder, num_views=3)
        result = tiny.run(tiny.stereo_command(self.folder), preexec_fn=take_limit)
        self.assert_success(result)
        self.assertIn(" MB of %d MB that this process may use" % (limit >> 20), result.stdout)
        self.assertTrue(result.stdout.splitlines()[-1].startswith("Peak memory: "))

    def test_limit_of_a_shell(self):
        limit = 3 << 30
        self.check_limit(limit, lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))

    def test_limit_of_a_container(self):
        limit = 1 << 30
        try:
            group = ControlGroup(limit)
        except OSError as error:
            self.skipTest("no control group can be made here: %s" % error)
        self.addCleanup(group.remove)
        self.check_limit(limit, group.enter)


if __name__ == "__main__":
    unittest.main()
