"""A COLMAP sparse model from photographs whose poses are known.

What a structure-from-motion run would leave: SIFT features, matched between all
pairs, joined into tracks, triangulated. Only the poses are taken as given; the
points carry the noise of the features. No point comes from the exact depth.
"""

import os

import cv2
import numpy as np

MAX_FEATURES = 4000
RATIO = 0.8
MAX_EPIPOLAR_ERROR = 2.0  # pixels
MAX_REPROJECTION_ERROR = 1.5  # pixels
MIN_ANGLE = 2.0  # degrees, between the two rays that are furthest apart
MIN_ANGLE_TWO_VIEWS = 4.0  # as nothing else confirms a track of two


def upscaling_shift():
    """OpenCV before 4.8 doubles the image without moving the coordinates back, which
    puts every feature 0.25 px to the right and below. Measured on a blob."""
    yy, xx = np.mgrid[0:101, 0:101]
    blob = np.uint8(30 + 200 * np.exp(-((xx - 50) ** 2 + (yy - 50) ** 2) / 32.0))
    found = cv2.SIFT_create().detect(blob)
    best = min(found, key=lambda k: (k.pt[0] - 50) ** 2 + (k.pt[1] - 50) ** 2)
    return 0.5 * (best.pt[0] + best.pt[1]) - 50


def extract(photographs):
    sift = cv2.SIFT_create(nfeatures=MAX_FEATURES, contrastThreshold=0.02)
    shift = 0.5 - upscaling_shift()  # COLMAP: the top-left pixel's centre is (0.5, 0.5)
    features = []
    for photograph in photographs:
        grey = cv2.cvtColor(photograph, cv2.COLOR_BGR2GRAY)
        keypoints, descriptors = sift.detectAndCompute(grey, None)
        # One feature per place, even where two orientations were found.
        seen, keep = set(), []
        for index, keypoint in enumerate(keypoints):
            if keypoint.pt not in seen:
                seen.add(keypoint.pt)
                keep.append(index)
        points = np.array([keypoints[i].pt for i in keep]) + shift
        root = descriptors[keep] / np.maximum(
            descriptors[keep].sum(axis=1, keepdims=True), 1e-9)
        features.append((points, np.sqrt(root)))
    return features


def match(descriptors_a, descriptors_b):
    """Mutual nearest neighbours that pass the ratio test."""
    similarity = descriptors_a @ descriptors_b.T
    distance = np.sqrt(np.maximum(2 - 2 * similarity, 0))
    nearest = distance.argmin(axis=1)
    rows = np.arange(len(distance))
    best = distance[rows, nearest]
    second = np.partition(distance, 1, axis=1)[:, 1]
    mutual = distance.argmin(axis=0)[nearest] == rows
    good = mutual & (best < RATIO * second) & (best < 0.7)
    return np.stack((rows[good], nearest[good]), axis=1)


def epipolar_error(points_a, points_b, pose_a, pose_b, calibration):
    """Distance in pixels to the epipolar line, the larger of both ways."""
    rotation = pose_b[0] @ pose_a[0].T
    translation = pose_b[1] - rotation @ pose_a[1]
    cross = np.array(((0, -translation[2], translation[1]),
                      (translation[2], 0, -translation[0]),
                      (-translation[1], translation[0], 0)))
    inverse = np.linalg.inv(calibration)
    fundamental = inverse.T @ cross @ rotation @ inverse
    a = np.column_stack((points_a, np.ones(len(points_a))))
    b = np.column_stack((points_b, np.ones(len(points_b))))
    line_b, line_a = a @ fundamental.T, b @ fundamental
    value = np.abs(np.sum(b * line_b, axis=1))
    return value / np.minimum(np.hypot(line_a[:, 0], line_a[:, 1]),
                              np.hypot(line_b[:, 0], line_b[:, 1]))


def join_tracks(links):
    """Connected components of (view, feature) nodes."""
    parent = {}

    def root(node):
        while parent.setdefault(node, node) != node:
            parent[node] = parent[parent[node]]
            node = parent[node]
        return node

    for a, b in links:
        parent[root(a)] = root(b)
    tracks = {}
    for node in sorted(parent):
        tracks.setdefault(root(node), []).append(node)
    return [tracks[key] for key in sorted(tracks)]


def triangulate(matrices, pixels):
    rows = []
    for matrix, (x, y) in zip(matrices, pixels):
        rows.append(x * matrix[2] - matrix[0])
        rows.append(y * matrix[2] - matrix[1])
    solution = np.linalg.svd(np.array(rows))[2][-1]
    if abs(solution[3]) < 1e-12:
        return None
    point = solution[:3] / solution[3]
    for _ in range(5):  # Gauss-Newton on the reprojection error
        jacobian, residual = [], []
        for matrix, pixel in zip(matrices, pixels):
            u, v, w = matrix @ np.append(point, 1)
            if w <= 0:
                return None
            residual += [u / w - pixel[0], v / w - pixel[1]]
            jacobian.append((matrix[0, :3] - u / w * matrix[2, :3]) / w)
            jacobian.append((matrix[1, :3] - v / w * matrix[2, :3]) / w)
        step = np.linalg.lstsq(np.array(jacobian), np.array(residual), rcond=None)[0]
        point = point - step
    return point


def reprojection_errors(matrices, pixels, point):
    projected = np.array(matrices) @ np.append(point, 1)
    if (projected[:, 2] <= 0).any():
        return np.full(len(pixels), np.inf)
    return np.linalg.norm(projected[:, :2] / projected[:, 2:] - pixels, axis=1)


def widest_angle(centres, point):
    rays = point - np.array(centres)
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    return np.degrees(np.arccos(np.clip(rays @ rays.T, -1, 1).min()))


def quaternion(rotation):
    """(w, x, y, z) of a rotation matrix."""
    trace = np.trace(rotation)
    r = rotation
    if trace > 0:
        s = 2 * np.sqrt(1 + trace)
        q = (s / 4, (r[2, 1] - r[1, 2]) / s, (r[0, 2] - r[2, 0]) / s,
             (r[1, 0] - r[0, 1]) / s)
    else:
        i = int(np.argmax(np.diag(r)))
        j, k = (i + 1) % 3, (i + 2) % 3
        s = 2 * np.sqrt(1 + r[i, i] - r[j, j] - r[k, k])
        q = [(r[k, j] - r[j, k]) / s, 0, 0, 0]
        q[1 + i], q[1 + j], q[1 + k] = s / 4, (r[j, i] + r[i, j]) / s, (
            r[k, i] + r[i, k]) / s
    return np.array(q)


def write(folder, photographs, names, poses, focal):
    """names: of the photographs' files."""
    height, width = photographs[0].shape[:2]
    calibration = np.array(((focal, 0, width / 2), (0, focal, height / 2), (0, 0, 1)))
    matrices = [calibration @ np.column_stack(pose) for pose in poses]
    centres = [-rotation.T @ translation for rotation, translation in poses]

    features = extract(photographs)
    links = []
    for a in range(len(features)):
        for b in range(a + 1, len(features)):
            pairs = match(features[a][1], features[b][1])
            error = epipolar_error(features[a][0][pairs[:, 0]],
                                   features[b][0][pairs[:, 1]],
                                   poses[a], poses[b], calibration)
            links += [((a, int(i)), (b, int(j)))
                      for i, j in pairs[error < MAX_EPIPOLAR_ERROR]]

    points, observations = [], [[] for _ in photographs]
    for track in join_tracks(links):
        if len({view for view, _ in track}) < len(track):
            continue  # two features of one photograph: a repeated pattern
        while len(track) >= 2:
            views = [matrices[view] for view, _ in track]
            pixels = np.array([features[view][0][index] for view, index in track])
            point = triangulate(views, pixels)
            if point is None:
                track = []
                break
            errors = reprojection_errors(views, pixels, point)
            if errors.max() < MAX_REPROJECTION_ERROR:
                break
            track = [node for i, node in enumerate(track) if i != errors.argmax()]
        if len(track) < 2:
            continue
        angle = widest_angle([centres[view] for view, _ in track], point)
        if angle < (MIN_ANGLE_TWO_VIEWS if len(track) == 2 else MIN_ANGLE):
            continue
        number = len(points) + 1
        colours, members = [], []
        for (view, _), (x, y) in zip(track, pixels):
            colours.append(photographs[view][min(int(y), height - 1),
                                             min(int(x), width - 1), ::-1])
            members.append((view + 1, len(observations[view])))
            observations[view].append((x, y, number))
        points.append((point, np.mean(colours, axis=0), errors.mean(), members))

    with open(os.path.join(folder, "cameras.txt"), "w") as f:
        f.write("# Camera list with one line of data per camera:\n"
                "#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n"
                "# Number of cameras: 1\n")
        f.write("1 PINHOLE %d %d %g %g %g %g\n" % (width, height, focal, focal,
                                                   width / 2, height / 2))
    with open(os.path.join(folder, "images.txt"), "w") as f:
        f.write("# Image list with two lines of data per image:\n"
                "#   IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n"
                "#   POINTS2D[] as (X, Y, POINT3D_ID)\n"
                "# Number of images: %d, mean observations per image: %.2f\n"
                % (len(poses), np.mean([len(o) for o in observations])))
        for view, (rotation, translation) in enumerate(poses):
            f.write("%d %s %s 1 %s\n" % (
                view + 1, " ".join("%.12f" % v for v in quaternion(rotation)),
                " ".join("%.9f" % v for v in translation), names[view]))
            f.write(" ".join("%.3f %.3f %d" % o for o in observations[view]) + "\n")
    with open(os.path.join(folder, "points3D.txt"), "w") as f:
        f.write("# 3D point list with one line of data per point:\n"
                "#   POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, "
                "POINT2D_IDX)\n"
                "# Number of points: %d, mean track length: %.3f\n"
                % (len(points), np.mean([len(p[3]) for p in points])))
        for number, (point, colour, error, members) in enumerate(points, 1):
            f.write("%d %.6f %.6f %.6f %d %d %d %.4f %s\n" % (
                (number,) + tuple(point) + tuple(np.rint(colour)) + (
                    error, " ".join("%d %d" % m for m in members))))
