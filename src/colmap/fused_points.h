#ifndef TAPA_SRC_COLMAP_FUSED_POINTS_H_
#define TAPA_SRC_COLMAP_FUSED_POINTS_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "src/fusion/fused_cloud.h"
#include "util/ply.h"

// This header is included by COLMAP's own sources.

namespace colmap {
namespace mvs {
class StereoFusion;
}  // namespace mvs
}  // namespace colmap

namespace tapa {

// Write the points of fusion, which are relative to an origin (LocalOrigin), to
// where they belong, and beside them, as COLMAP does, which images see each
// (".vis"). Coordinates are in double precision unless the origin is 0. The
// file appears under its name only when both are complete, and two that are
// there are of the same fusion. Throw Failure.
void WriteFusedPoints(const std::string& path,
                      const std::vector<colmap::PlyPoint>& points,
                      const std::vector<std::vector<int>>& visibility,
                      const Eigen::Vector3d& origin);
// With the property `confidence` in addition.
void WriteFusedPoints(const std::string& path, const FusedCloud& cloud,
                      const Eigen::Vector3d& origin);
// What a fusion has made, by either rule; prints how much memory it took.
void WriteFusedPoints(const std::string& path,
                      const colmap::mvs::StereoFusion& fusion);

// The points without confidence and visibility, as COLMAP's rule makes them.
std::vector<colmap::PlyPoint> PlyPoints(const FusedCloud& cloud);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_FUSED_POINTS_H_
