#ifndef TAPA_SRC_MVS_TAPA_PLANE_FIT_H_
#define TAPA_SRC_MVS_TAPA_PLANE_FIT_H_

#include <cstdint>
#include <vector>

#include "src/mvs/sweep/plane.h"

namespace tapa {

// A plane and the trust in it.
struct FittedPlane {
  Plane plane;
  // Share of the points within the largest distance, 0 to 1; 0: there is no
  // plane.
  float inlier_ratio = 0;
  // The largest distance of an inlier, in scene units.
  float max_distance = 0;
};

// Plane through most of the points (reference camera's frame, scene units) by
// RANSAC (Fischler and Bolles, 1981) with a final least-squares fit to the
// points within max_distance (TAPA-MVS, section 4.1). There is none where fewer
// than min_num_inliers points agree (at least 3), where the points lie on a
// line, or where the plane passes through the camera's centre or is seen
// edge-on from it. Deterministic: `key` chooses the random samples.
FittedPlane FitPlane(const std::vector<Vec3>& points, float max_distance,
                     int min_num_inliers, uint64_t key);

// Points that count once, however many they are.
using PointGroup = std::vector<Vec3>;

// The same with errors of depth, and for groups of points: the inliers are the
// points whose depth is off by at most the share max_error of the plane's, as
// seen from the camera. The plane is the one that most groups have an inlier
// of, those by their smallest error e as 1 - (e / max_error)^2 (MSAC: Torr and
// Zisserman, 2000), and then that for which the sum over the groups of the mean
// squares of their inliers' errors is least. For points that are far apart,
// each as exact as its depth allows. There is none where fewer than
// min_num_groups (at least 1) have an inlier. No group may be empty.
// inlier_ratio of the result is the share of the groups, max_distance 0, and
// planes seen edge-on are some, too.
FittedPlane FitPlaneToDepths(const std::vector<PointGroup>& groups,
                             float max_error, int min_num_groups, uint64_t key);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_PLANE_FIT_H_
