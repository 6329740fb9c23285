#ifndef TAPA_SRC_MVS_SWEEP_SCENE_PLANE_H_
#define TAPA_SRC_MVS_SWEEP_SCENE_PLANE_H_

#include "src/mvs/sweep/plane.h"

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

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_SCENE_PLANE_H_
