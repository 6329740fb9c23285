#ifndef TAPA_SRC_MVS_SWEEP_PLANE_H_
#define TAPA_SRC_MVS_SWEEP_PLANE_H_

#include "src/mvs/sweep/depth_normal.h"

namespace tapa {

// A plane in the reference camera's frame: the points X with
// Dot(normal, X) = -distance. The unit normal faces the camera, so the distance
// from it is positive.
struct Plane {
  Vec3 normal;
  float distance = 0;
};

// Where a pixel's ray meets the plane. The depth is <= 0, infinite or NaN where
// it does not.
TAPA_INLINE DepthNormal PlaneAt(const Plane& plane, const Vec3& ray) {
  return {-plane.distance / Dot(plane.normal, ray), plane.normal};
}

// The same as a hypothesis, with depth 0 where it is outside the range of
// depths.
TAPA_INLINE DepthNormal PlaneHypothesis(const Plane& plane, const Vec3& ray,
                                        float depth_min, float depth_max) {
  const DepthNormal at = PlaneAt(plane, ray);
  const bool in_range = at.depth >= depth_min && at.depth <= depth_max;
  return in_range ? at : DepthNormal();
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_PLANE_H_
