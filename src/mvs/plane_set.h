#ifndef TAPA_SRC_MVS_PLANE_SET_H_
#define TAPA_SRC_MVS_PLANE_SET_H_

#include <cstdint>
#include <vector>

#include "src/base/map.h"
#include "src/mvs/plane.h"

namespace tapa {

// A plane in the reference camera's frame: the points X with
// Dot(normal, X) = -distance. The unit normal faces the camera, so the distance
// from it is positive.
struct ScenePlane {
  Vec3 normal;
  float distance = 0;
};

// Where a pixel's ray meets the plane. The depth is not positive, infinite or
// not a number where it does not.
TAPA_INLINE Plane PlaneAt(const ScenePlane& plane, const Vec3& ray) {
  return {-plane.distance / Dot(plane.normal, ray), plane.normal};
}

// The same as a hypothesis, with depth 0 where it is outside the range of
// depths.
TAPA_INLINE Plane ProposedPlane(const ScenePlane& scene_plane, const Vec3& ray,
                                float depth_min, float depth_max) {
  const Plane plane = PlaneAt(scene_plane, ray);
  const bool in_range = plane.depth >= depth_min && plane.depth <= depth_max;
  return in_range ? plane : Plane();
}

// Planes, one of which every pixel may try as a hypothesis.
struct PlaneSet {
  static constexpr uint16_t kNone = 0xFFFF;

  std::vector<ScenePlane> planes;
  // Which plane each pixel tries; kNone: none. Empty: no pixel tries any.
  Map<uint16_t> index;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_PLANE_SET_H_
