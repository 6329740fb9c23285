"""Scores of clouds that can be computed by hand, and of random ones next to a reference."""

import collections
import itertools
import math
import unittest

import numpy as np

import helpers  # noqa: F401 (it finds the package)
from evaluation import blocks, cloud_checks, voxel_average
from evaluation.point_cloud_score import (BeamShape, LaserScan, f1_score, judge_accuracy,
                                          judge_completeness, merge_scans)
from evaluation.voxel_average import Verdicts

STRAIGHT = BeamShape(0.0625, 0)  # Beams of constant width, which make sums exact.


def scan_of(points, x=0, y=0, z=0, rotation=np.eye(3)):
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rotation, (x, y, z)
    return LaserScan(np.reshape(points, (-1, 3)).astype(np.float32), pose)


def judge(points, scans, tolerances, shape=STRAIGHT, num_threads=1):
    """(first tolerance at which it is good, whether it is judged) of each point."""
    verdicts = judge_accuracy(np.reshape(points, (-1, 3)).astype(np.float32), scans, tolerances,
                              shape, num_threads)
    return list(zip(verdicts.first_good.tolist(), verdicts.judged.tolist()))


def score(points, scans, tolerances, voxel_size, shape=STRAIGHT, num_threads=1):
    """Completeness and accuracy at each tolerance."""
    points, scanned = np.reshape(points, (-1, 3)).astype(np.float32), merge_scans(scans)
    return [voxel_average.average(of, verdicts, len(tolerances), voxel_size)
            for of, verdicts in (
                (scanned, judge_completeness(scanned, points, tolerances, num_threads)),
                (points, judge_accuracy(points, scans, tolerances, shape, num_threads)))]


def wall(distance):
    """A grid of points 1/8 apart, y and z within (-1, 1)."""
    return [(distance, col / 8, row / 8) for row in range(-7, 8) for col in range(-7, 8)]


class ByHandTest(unittest.TestCase):
    def test_walls(self):
        scans, shape = [scan_of(wall(4))], BeamShape(0.125, 0)
        for distance, expected in ((4, [1, 1, 1]), (3.75, [0, 1, 1]), (4.25, [0, 1, 1])):
            self.assertEqual(score(wall(distance), scans, (0.125, 0.25, 0.5), 0.25, shape),
                             [expected, expected])
        # Behind it nothing is known but how far away the wall is.
        self.assertEqual(set(judge(wall(4.25), scans, (0.125, 0.25), shape)), {(1, False)})

    def test_density_has_no_weight(self):
        # In one cube three points of which one is complete, in another one that is.
        measured = [(4.125, 0.125, 0), (4.125, 0.25, 0), (4.125, 0.375, 0), (4.125, 5.125, 0)]
        ((completeness,), (accuracy,)) = score(measured[::3], [scan_of(measured)], [0.0625], 1)
        self.assertAlmostEqual(completeness, (1 / 3 + 1) / 2, 12)
        self.assertEqual(accuracy, 1)
        self.assertAlmostEqual(f1_score(completeness, accuracy), 0.8, 12)
        # The other way round: two of the three are in empty space.
        cloud = [measured[0], (4, 0.125, 0), (4, 0.25, 0), measured[3]]
        self.assertAlmostEqual(score(cloud, [scan_of(measured)], [0.0625], 1)[1][0],
                               (1 / 3 + 1) / 2, 12)

    def test_both_grids_of_cubes(self):
        # Two points in one cube of the first grid, in two of the second, and the reverse.
        for y, expected in ((0.25, (0.5 + 1 + 0) / 3), (-0.25, (0 + 1 + 0.5) / 3)):
            scans = [scan_of([(4, y, 0), (4, 0.75 if y > 0 else 0.25, 0)])]
            complete = [(4, y if y > 0 else 0.25, 0)]
            self.assertAlmostEqual(score(complete, scans, [0.125], 1)[0][0], expected, 12)

    def test_free_space(self):
        scans = [scan_of([(4, 0, 0)])]
        for point, verdict in (
                ((2, 0, 0), (2, True)),  # In the beam, in empty space.
                ((2, 0.125, 0), (3, False)),  # Beside the beam.
                ((-2, 0, 0), (3, False)),  # On the other side of the scanner.
                ((4.5, 0, 0), (1, False)),  # Behind the point.
                ((4, 0.0625, 0), (0, False)),  # At the rim of the beam, beside the point.
                ((4, 0.09375, 0), (3, False))):  # Beyond the rim.
            self.assertEqual(judge(point, scans, (0.25, 1, 2)), [verdict], point)

    def test_two_walls_and_an_occluder(self):
        # The far wall is at 4; a near one at 2 hides the part of it with y > 0.
        seen = scan_of([(2, y / 2, z / 2) if y > 0 else (x, y, z) for x, y, z in wall(4)])
        between, thin = [(3, -0.375, 0), (3, 0.375, 0)], BeamShape(1 / 1024, 0)
        for second, verdict in (
                ([], (2, False)),
                # A scanner between the walls sees that there is nothing, or that there is.
                ([scan_of([(1, 0, 0)], 2.5, 0.375)], (2, True)),
                ([scan_of([(0.625, 0, 0)], 2.5, 0.375)], (0, True))):
            self.assertEqual(judge(between, [seen, *second], (0.125, 0.25), thin),
                             [(2, True), verdict])

    def test_poses_turn_scans(self):
        # Two scanners that look at one place along x and along y of the world.
        turn = np.array(((0, -1, 0), (1, 0, 0), (0, 0, 1)))
        scans = [scan_of([(2, 0, 0)], -1, 3), scan_of([(2, 0, 0)], 1, 1, 0, turn)]
        np.testing.assert_array_equal(merge_scans(scans), [(1, 3, 0)] * 2)
        self.assertEqual([judged for _, judged in judge(
            [(1, 2, 0), (0, 3, 0), (2, 2, 0)], scans, [0.5])], [True, True, False])

    def test_beams_widen_with_distance(self):
        shape = BeamShape(0, 45)
        self.assertAlmostEqual(shape.radius_at(2), 2)
        self.assertEqual([judged for _, judged in judge(
            [(1, 1, 0), (0.5, 1, 0), (-0.5, 1, 0)], [scan_of([(10, 0, 0)])], [0.5], shape)],
            [True, True, False])

    def test_distances_equal_to_a_tolerance(self):
        points = [np.array([point], np.float32) for point in ((0, 0, 0), (0, 0, 0.1))]
        for tolerances in ([0.1], [0.1, 0.2]):
            self.assertEqual(judge_completeness(*points, tolerances).first_good, [0])

    def test_nothing_to_judge(self):
        scans = [scan_of(wall(4))]
        self.assertEqual(score([], scans, (0.1, 0.5), 0.25), [[0, 0], [0, 0]])
        self.assertEqual(score((-4, 0, 0), scans, (0.1, 0.5), 0.25)[1], [0, 0])
        self.assertEqual((f1_score(0, 0), f1_score(0, 1)), (0, 0))

    def test_places_at_the_scanner(self):
        # Scanned points there have no beam; a reconstructed one is in all beams.
        self.assertEqual(judge(np.zeros((3, 3)), [scan_of([(0, 0, 0), (0, 0, 3)])], [0.5]),
                         [(1, True)] * 3)
        self.assertEqual(judge((0, 0, 0), [scan_of([(0, 0, 0)])], [0.5]), [(1, False)])

    def test_far_and_many_equal_points(self):
        points = np.array([(1, 2, 3)] * 5000 + [(3e38, -3e38, 3e38), (-3e38, 3e38, 1e30)], "f4")
        self.assertEqual(score(points, [scan_of(points)], [0.01], 0.01, BeamShape())[0], [1])


def reference_average(points, good, judged, voxel_size):
    shares = collections.defaultdict(list)
    with np.errstate(over="ignore"):
        scaled = points * np.float32(1 / voxel_size)
    for shift in (0, 0.5):
        cubes = np.clip(np.floor(scaled + np.float32(shift)), -2e9, 2e9)
        for cube, is_good, is_judged in zip(cubes.tolist(), good, judged):
            if is_good or is_judged:
                shares[shift, *cube].append(is_good)
    return sum(sum(cube) / len(cube) for cube in shares.values()) / max(len(shares), 1)


def reference_score(points, scans, tolerances, voxel_size, shape):
    """The definition, as simple as it can be said: every point with every other one.

    Completeness and accuracy, and how many verdicts are accurate, inaccurate and none.
    """
    scanned = merge_scans(scans)
    closest = np.array([np.linalg.norm(points.astype(float) - point, axis=1).min()
                        for point in scanned])
    least, before = np.full(len(points), np.inf), np.zeros(len(points), bool)
    for scan in scans:
        ends = scan.points[(scan.points != 0).any(axis=1)].astype(float)
        ranges = np.linalg.norm(ends, axis=1)
        for i, place in enumerate((points - scan.pose[:3, 3]) @ scan.pose[:3, :3]):
            radius = shape.start_radius + np.linalg.norm(place) * math.tan(
                math.radians(shape.divergence_halfangle))
            along = ends @ place / ranges
            aside = np.linalg.norm(place - along[:, None] * (ends / ranges[:, None]), axis=1)
            beam = (along >= 0) & (aside <= radius)
            least[i] = min([least[i], *np.linalg.norm(ends - place, axis=1)[beam]])
            before[i] |= (along < ranges)[beam].any()
    scores, counts = [[], []], np.zeros(3, int)
    for tolerance in np.float32(tolerances).astype(float):
        accurate = least <= tolerance
        scores[0].append(reference_average(scanned, closest <= tolerance,
                                           itertools.repeat(True), voxel_size))
        scores[1].append(reference_average(points, accurate, before, voxel_size))
        counts += accurate.sum(), (before & ~accurate).sum(), (~before & ~accurate).sum()
    return scores, counts


def random_scene(seed):
    """A room of 4 m with scanners in it, and a cloud of points on and near what they measured,
    in the air, behind the walls, and where directions are special: at the scanners, and above,
    below and behind them."""
    random = np.random.default_rng(seed)
    scans, cloud = [], []
    for _ in range(3):
        position = random.uniform(-1, 1, 3)
        rotation = np.linalg.qr(random.normal(size=(3, 3)))[0]
        rotation *= np.linalg.det(rotation)
        rays = random.normal(size=(400, 3))
        walls = position + rays * ((np.copysign(2, rays) - position) / rays).min(axis=1)[:, None]
        special = [(0, 0, 0), (0, 0, 1), (0, 0, -1), (-1, 0, 0), (-1, -0.0, 0)]
        scan = scan_of(np.concatenate(((walls - position) @ rotation, special)), *position,
                       rotation)
        scans.append(scan)
        world = scan.world_points()
        near, air, anywhere = np.split(world, (240, 320))
        places = [(0, 0, 0), (0, 0, 0.5), (0, 0, -0.5), (-0.5, 0, 0), (-0.5, 1e-7, 0),
                  (-0.5, -1e-7, 0), (1e-3, 1e-3, 1), (1e-3, 0, 0)]
        cloud += [near + random.uniform(-0.2, 0.2, near.shape),
                  air * random.uniform(0, 1.3, (len(air), 1)),
                  random.uniform(-2.5, 2.5, anywhere.shape), places @ rotation.T + position]
    return np.concatenate(cloud).astype(np.float32), scans


class ReferenceTest(unittest.TestCase):
    def test_random_scenes(self):
        tolerances = [0.02, 0.1, 0.5]
        for seed, shape in enumerate(itertools.starmap(BeamShape, (
                (0.5 * 0.00225, 0.011), (0.01, 0.5), (0.05, 0), (0, 2), (0.3, 5), (0, 40),
                (0, 80)))):
            points, scans = random_scene(seed)
            voxel_size = 0.01 if seed % 2 else 0.25
            expected, (num_accurate, num_inaccurate, num_not_judged) = reference_score(
                points, scans, tolerances, voxel_size, shape)
            np.testing.assert_allclose(score(points, scans, tolerances, voxel_size, shape),
                                       expected, atol=1e-9)
            # Every rule is at work, unless beams are so thin that they meet hardly any point or
            # so wide that they meet all.
            if seed < 5:
                self.assertGreater(num_not_judged, 20)
            if seed > 0:
                self.assertGreater(min(num_accurate, num_inaccurate), 100)

    def test_threads_change_nothing(self):
        points, scans = random_scene(1)
        points = np.concatenate([points + np.float32(0.001 * i) for i in range(100)])
        scores = [score(points, scans, (0.05, 0.2), 0.1, BeamShape(0.01, 0.5), num_threads)
                  for num_threads in (1, 2, 5)]
        self.assertEqual(scores[0], scores[1])
        self.assertEqual(scores[0], scores[2])

    def test_cubes_of_any_extent_in_any_number_of_parts(self):
        random = np.random.default_rng(3)
        points = random.integers(-40, 40, (3000, 3)).astype(np.float32) / 8
        verdicts = Verdicts(random.integers(0, 4, 3000), random.random(3000) < 0.7)
        self.addCleanup(setattr, voxel_average, "_POINTS_PER_PART", 1 << 22)
        # Distances between cubes beyond 32 bits, and beyond 64 when multiplied.
        for scale, voxel_size in ((1, 0.5), (1e-3, 1e-9), (100, 1e-5), (1e30, 1)):
            scaled = points * np.float32(scale)
            expected = [reference_average(scaled, verdicts.good_at(t), verdicts.judged, voxel_size)
                        for t in range(3)]
            for size in (1 << 22, 700):
                voxel_average._POINTS_PER_PART = size
                np.testing.assert_allclose(
                    voxel_average.average(scaled, verdicts, 3, voxel_size), expected, atol=1e-12)

    def test_numbers_in_blocks(self):
        counts = np.array((3, 0, 1, 7, 0))
        expected = [(i, n) for i, count in enumerate(counts) for n in range(count)]
        for size in (1, 2, 4, 100):
            pairs = [(owners.tolist(), numbers.tolist())
                     for owners, numbers in blocks.numbered(counts, size)]
            self.assertEqual([pair for owners, numbers in pairs
                              for pair in zip(owners, numbers)], expected)
            self.assertLessEqual(max(len(owners) for owners, _ in pairs), size)
        self.assertEqual(list(blocks.numbered(counts[:0])), [])


def circle(radius, count=1000):
    """Points around (5, 6, 7)."""
    angle = np.arange(count) * (2 * np.pi / count)
    return np.stack((5 + radius * np.cos(angle), 6 + radius * np.sin(angle),
                     np.full(count, 7)), axis=1).astype(np.float32)


class ChecksTest(unittest.TestCase):
    def test_typical_radius(self):
        for points in (np.empty((0, 3)), np.array([(1, 2, 3)])):
            self.assertEqual(cloud_checks.typical_radius(points), 0)
        many = circle(2, 250001)  # More points than are looked at, and some far away.
        many[::10] = 1e30, -1e30, 0
        self.assertAlmostEqual(cloud_checks.typical_radius(many), 2, delta=0.5)

    def test_unit_and_precision(self):
        for cloud, scan, text in (
                (circle(2), circle(30), ""), (circle(2), circle(0.15), ""),
                (circle(2), circle(2000), "s.ply is 1e+03 times larger"),
                (circle(2), circle(0.02), "s.ply is 1e+02 times smaller"),
                (circle(2)[:0], circle(2), ""), (circle(2)[:1], circle(2), "")):
            found = cloud_checks.check_unit(cloud, scan, "s.ply")
            self.assertTrue(found.startswith(text) and bool(found) == bool(text), found)
        for largest, text in ((8000, ""), (400000, "c.ply has coordinates of up to 4e+05")):
            for sign in (-1, 1):
                found = cloud_checks.check_precision(
                    np.array([(0, sign * largest, 0)], np.float32), 0.01, "c.ply")
                self.assertTrue(found.startswith(text) and bool(found) == bool(text), found)
        self.assertEqual(cloud_checks.check_precision(circle(2)[:0], 0.01, "c.ply"), "")
