#ifndef TAPA_SRC_MVS_SWEEP_DEPTH_NORMAL_H_
#define TAPA_SRC_MVS_SWEEP_DEPTH_NORMAL_H_

#include <cmath>

#include "src/mvs/sweep/ref_camera.h"

namespace tapa {

// An estimate or a hypothesis of one pixel: `depth` on the pixel's ray (z
// coordinate in the reference camera's frame, scene units) and the unit
// `normal`, which faces the camera: Dot(normal, ray) < 0. It stands for the
// plane through that point.
struct DepthNormal {
  float depth = 0;
  Vec3 normal;
};

// Depth at which another pixel's ray meets the plane that an estimate at
// `ray_from` stands for. Keeps the depth where the ray is nearly parallel to
// the plane.
TAPA_INLINE float PropagateDepth(const DepthNormal& estimate,
                                 const Vec3& ray_from, const Vec3& ray_to) {
  constexpr float kMinCosine = 1e-5f;
  const float to = Dot(estimate.normal, ray_to);
  if (fabsf(to) < kMinCosine) {
    return estimate.depth;
  }
  return estimate.depth * Dot(estimate.normal, ray_from) / to;
}

// The vector m for which the plane of an estimate induces the homography A + b
// m^T on pixels (see SourceCameras): m = K^-T n / (distance of the plane to the
// camera).
TAPA_INLINE Vec3 HomographyVector(const RefCamera& camera,
                                  const DepthNormal& estimate,
                                  const Vec3& ray) {
  const Vec3 n =
      (1.0f / (estimate.depth * Dot(estimate.normal, ray))) * estimate.normal;
  return {n.x * camera.inv_fx, n.y * camera.inv_fy,
          n.x * camera.offset_x + n.y * camera.offset_y + n.z};
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_DEPTH_NORMAL_H_
