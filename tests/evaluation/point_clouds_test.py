"""PLY files of all kinds, MeshLab projects, and those that are damaged."""


import numpy as np

from helpers import TestCase
from evaluation import meshlab_project, point_clouds
from evaluation.processes import Failure

XYZ = "property float x\nproperty float y\nproperty float z\n"
ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
IDENTITY = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1"


def ply(kind, elements, rows):
    """rows: of (NumPy type, value) pairs."""
    head = f"ply\nformat {kind} 1.0\ncomment by a test\n{elements}end_header\n".encode()
    if kind == "ascii":
        return head + "".join(" ".join(repr(value) for _, value in row) + "\n"
                              for row in rows).encode()
    return head + b"".join(np.array(value, ORDERS[kind] + code).tobytes()
                           for row in rows for code, value in row)


def floats(*values):
    return [("f4", value) for value in values]


class PlyTest(TestCase):
    def read_bytes(self, content):
        with open(self.path("cloud.ply"), "wb") as file:
            file.write(content)
        return point_clouds.read_ply(self.path("cloud.ply"))

    def expect(self, content, points, num_left_out=0):
        found, left_out = self.read_bytes(content)
        self.assertEqual(found.dtype, np.float32)
        np.testing.assert_array_equal(found, np.reshape(points, (-1, 3)))
        self.assertEqual(left_out, num_left_out)

    def refuse(self, content, *parts):
        with self.subTest(content=content[:300]):
            with self.assertRaises(Failure) as caught:
                self.read_bytes(content)
            for part in (self.path("cloud.ply"), *parts):
                self.assertIn(part, str(caught.exception))
            self.assertNotIn("\n", str(caught.exception))

    def test_types_and_orders(self):
        columns = [("uchar red", "u1"), ("double z", "f8"), ("int16 x", "i2"),
                   ("float32 y", "f4"), ("uint x", "u4"), ("char a", "i1"), ("float64 t", "f8")]
        rows = [[(code, value) for (_, code), value in zip(columns, (
            255, -0.125 * i, -300 * i, 0.5 * i, 7, -1, 3e9))] for i in (1, 2)]
        head = "element vertex 2\n" + "".join(f"property {name}\n" for name, _ in columns)
        for kind in ORDERS:
            self.expect(ply(kind, head, rows), [[-300, 0.5, -0.125], [-600, 1, -0.25]])

    def test_far_from_the_origin(self):
        doubles = "property double x\nproperty double y\nproperty double z\n"
        row = [("f8", value) for value in (500000.25, 5200000.125, 200.0625)]
        for kind in ORDERS:
            found, _ = self.read_bytes(ply(kind, "element vertex 1\n" + doubles, [row]))
            np.testing.assert_array_equal(found, [[value for _, value in row]])
            point_clouds.write_ply(self.path("again.ply"), found)
            np.testing.assert_array_equal(point_clouds.read_ply(self.path("again.ply"))[0], found)

    def test_lists_and_other_elements(self):
        rows = [[("u1", 3), ("i4", 0), ("i4", 1), ("i4", 0)], [("u1", 0)],
                [("f8", 1.0), ("f8", 2.0)],
                [("f4", 1.0), ("u2", 2), ("f8", 8.0), ("f8", 9.0), *floats(2.0, 3.0)],
                [("f4", 4.0), ("u2", 0), *floats(5.0, 6.0)]]
        head = ("element face 2\nproperty list uchar int vertex_indices\nelement empty 7\n"
                "element camera 1\nproperty double f\nproperty double k\n"
                "element vertex 2\nproperty float x\nproperty list ushort double weights\n"
                "property float y\nproperty float z\nelement edge 5\nproperty int a\n")
        for kind in ORDERS:
            self.expect(ply(kind, head, rows), [[1, 2, 3], [4, 5, 6]])

    def test_more_points_than_are_read_at_a_time(self):
        x = np.arange(300000, dtype=np.float32) / 4
        points = np.stack((x, -x, x + 1), axis=1)
        for kind, order in ORDERS.items():
            body = ("\n".join(map("{0[0]:.9g} {0[1]:.9g} {0[2]:.9g}".format, points)).encode()
                    if kind == "ascii" else points.astype(order + "f4").tobytes())
            self.expect(ply(kind, f"element vertex {len(x)}\n{XYZ}", []) + body, points)

    def test_what_ascii_may_look_like(self):
        self.expect(b"ply\r\nformat ascii 1.0\r\nobj_info scanner\r\nelement vertex 3\r\n"
                    + XYZ.replace("\n", "\r\n").encode() + b"end_header\r\n"
                    b"+1\t-2e0   3.\r\n\r\n  1e-400 0 1E2\r\n4 5 6", [[1, -2, 3], [0, 0, 100],
                                                                     [4, 5, 6]])

    def test_points_that_are_not_finite(self):
        for kind in ORDERS:
            rows = [floats(1, float("nan"), 3), floats(1, 2, 3), floats(1, 2, -float("inf"))]
            self.expect(ply(kind, "element vertex 3\n" + XYZ, rows), [1, 2, 3], 2)
            self.expect(ply(kind, "element vertex 0\n" + XYZ, []), [])
        doubles = XYZ.replace("float", "double")  # Beyond single precision.
        self.expect(ply("binary_big_endian", "element vertex 1\n" + doubles,
                        [[("f8", 1e39)] * 3]), [], 1)
        self.expect(ply("ascii", "element vertex 1\n" + XYZ, []) + b"1e999 0 0\n", [], 1)

    def test_files_that_end_early(self):
        head = "element vertex 2\n" + XYZ
        for kind in ORDERS:
            whole = ply(kind, head, [floats(1.5, -2, 0.25), floats(4, 5, 6)])
            self.refuse(whole[:-4], "values missing" if kind == "ascii" else
                        "is truncated: of 2 elements vertex it has 1")
            self.refuse(whole[:40], "its header has no end")
            for count in (3, 9000000000000000, 10 ** 30):  # Needs no memory for them.
                self.refuse(whole.replace(b"vertex 2", b"vertex %d" % count),
                            f"is truncated: of {count} elements vertex it has 2")
        for kind in ("binary_little_endian", "binary_big_endian"):
            self.refuse(ply(kind, "element camera 5\nproperty double f\n" + head, [[("f8", 1)]]),
                        "is truncated: of 5 elements camera it has 1")
            faces = "element face 2\nproperty list int int v\n" + head
            self.refuse(ply(kind, faces, [[("i4", 1), ("i4", 0)], [("i4", 10 ** 9)]]),
                        "is truncated: of 2 elements face it has 1")
            self.refuse(ply(kind, faces, [[("i4", -1)]]), "face 0 has a list of negative length")

    def test_other_files(self):
        for content, part in (
                (b"", "is not a PLY file"), (b"plywood\n", "is not a PLY file"),
                (b"x" * 1000000, "is not a PLY file"), (b"ply\n" + b"x" * 1000000, "no end"),
                (b"ply\nend_header\n", "does not say its format"),
                (ply("ascii", "", []), "has no vertices"),
                (ply("ascii", "element face 1\nproperty float x\n", [floats(1)]), "no vertices"),
                (ply("ascii", "element vertex 1\n", []), "no property x"),
                (ply("ascii", "element vertex 1\n" + XYZ[:34], [floats(1, 2)]), "no property z"),
                (ply("ascii", "element vertex 1\nproperty list uchar float x\n" + XYZ[17:],
                     [floats(0, 1, 2)]), "no property x")):
            self.refuse(content, part)
        for line in ("format ascii 2.0", "format binary 1.0", "format", "nonsense",
                     "element vertex", "element vertex -1", "element vertex 1.5",
                     "property float x"):
            self.refuse(f"ply\n{line}\nend_header\n".encode(), f"line 2: '{line}'")
        for line in ("property quad x", "property float", "property list uchar float",
                     "property list float float x", "property float x y"):
            self.refuse(f"ply\nelement vertex 1\n{line}\r\n".encode(), f"line 3: '{line}'")

    def test_bad_numbers(self):
        for body, part in ((b"1 2 3\n4 5\n6\n", "line 10: there are values missing"),
                           (b"1 2 x\n4 5 6\n", "line 9: could not convert string 'x'"),
                           (b"\n1 2,5 3\n4 5 6\n", "line 10: could not convert string '2,5'")):
            self.refuse(ply("ascii", "element vertex 2\n" + XYZ, []) + body, part)

    def test_coloured_points_come_back(self):
        points = np.arange(12, dtype=np.float32).reshape(4, 3)
        point_clouds.write_ply(self.path("new/c.ply"), points, np.full((4, 3), (1, 2, 3)))
        np.testing.assert_array_equal(point_clouds.read_ply(self.path("new/c.ply"))[0], points)
        with open(self.path("new/c.ply"), "rb") as file:
            self.assertEqual(file.read()[-3:], bytes((1, 2, 3)))


class ProjectTest(TestCase):
    def write_project(self, *scans):
        return self.write("scans.mlp", "<!DOCTYPE MeshLabDocument>\n<MeshLabProject>\n<MeshGroup>"
                          + "".join(f'<MLMesh label="a" filename="{name}">\n<MLMatrix44>\n{matrix}'
                                    "\n</MLMatrix44></MLMesh>" for name, matrix in scans)
                          + "</MeshGroup>\n<RasterGroup/>\n</MeshLabProject>\n")

    def refuse(self, text, part):
        path = self.write("scans.mlp", text)
        with self.subTest(text=text):
            with self.assertRaises(Failure) as caught:
                meshlab_project.read(path)
            self.assertRegex(str(caught.exception), f"^{path}[^\n]*$")
            self.assertIn(part, str(caught.exception))

    def test_scans_with_poses(self):
        turned = "0.866025 -0.5 0 1e-3\n0.5 0.866025 0 -2.5E1\n0 0 1 0\n0 0 0 1"
        scans = meshlab_project.read(self.write_project(
            ("a.ply", IDENTITY), ("sub/b.ply", turned), ("/c.ply", IDENTITY)))
        self.assertEqual([path for path, _ in scans],
                         [self.path("a.ply"), self.path("sub/b.ply"), "/c.ply"])
        np.testing.assert_array_equal(scans[0][1], np.eye(4))
        np.testing.assert_array_equal(scans[1][1][:, 3], [1e-3, -25, 0, 1])
        meshlab_project.write(self.path("again.mlp"), [("x & y.ply", scans[1][1])])
        ((path, pose),) = meshlab_project.read(self.path("again.mlp"))
        self.assertEqual(path, self.path("x & y.ply"))
        np.testing.assert_allclose(pose, scans[1][1])

    def test_what_is_none(self):
        mesh = ('<MeshLabProject><MeshGroup><MLMesh label="a"{}</MLMesh></MeshGroup>'
                "</MeshLabProject>")
        for text, part in (
                ("", "is not a MeshLab project: "), ("nonsense", "is not a MeshLab project: "),
                ("<MeshLabProject>\n<MLMesh\n", "line "), ("<COLLADA/>", "not a MeshLab project"),
                ("<MeshLabProject/>", "lists no scan"),
                (mesh.format("><MLMatrix44/>"), "scan 1 has no file name"),
                (mesh.format(' filename="a.ply">'), "scan a.ply has no pose (MLMatrix44)")):
            self.refuse(text, part)
        for path in (self.path("none.mlp"), self.folder):
            with self.assertRaisesRegex(Failure, f"^{path} cannot be read: "):
                meshlab_project.read(path)

    def test_bad_poses(self):
        for matrix, part in (
                ("", "16 numbers"), (IDENTITY[:-2], "16 numbers"), (IDENTITY + " 0", "16 numbers"),
                ("x" + IDENTITY[1:], "16 numbers"), ("nan" + IDENTITY[1:], "16 numbers"),
                (IDENTITY[:-3] + "1 1", "whose last row is not 0 0 0 1"),
                (IDENTITY + "000", "whose last row is not 0 0 0 1"),
                (IDENTITY.replace("1", "1000", 3), "not a rotation"),  # Scale.
                ("1.001" + IDENTITY[1:], "not a rotation"),
                ("-1" + IDENTITY[1:], "not a rotation"),
                (IDENTITY.replace("1 0", "1 0.001", 1), "not a rotation"),  # Shear.
                ("0" + IDENTITY[1:], "not a rotation")):
            with self.subTest(matrix=matrix):
                with self.assertRaisesRegex(Failure, "mlp: scan bad.ply has a pose .*" + part):
                    meshlab_project.read(self.write_project(("good.ply", IDENTITY),
                                                            ("bad.ply", matrix)))
