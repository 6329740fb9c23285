#ifndef TAPA_SRC_MVS_SWEEP_PLANE_H_
#define TAPA_SRC_MVS_SWEEP_PLANE_H_

#include <cmath>

#include "src/base/vec3.h"

namespace tapa {

// The estimate of one pixel: the plane through the point at `depth` on the
// pixel's ray (z coordinate in the reference camera's frame, scene units) with
// the unit `normal`, which faces the camera: Dot(normal, ray) < 0.
struct Plane {
  float depth = 0;
  Vec3 normal;
};

// Intrinsics of the reference camera in the form that sweeps need: for indices
// of pixels (see CameraTable).
struct RefCamera {
  float inv_fx;
  float inv_fy;
  // (0.5 - cx) / fx and (0.5 - cy) / fy.
  float offset_x;
  float offset_y;

  // Ray of a pixel's centre in the camera's frame, scaled to depth 1.
  TAPA_INLINE Vec3 Ray(float row, float col) const {
    return {inv_fx * col + offset_x, inv_fy * row + offset_y, 1.0f};
  }
};

// Depth at which another pixel's ray meets the plane that an estimate at
// `ray_from` stands for. Keeps the depth where the ray is nearly parallel to
// the plane.
TAPA_INLINE float PropagateDepth(const Plane& plane, const Vec3& ray_from,
                                 const Vec3& ray_to) {
  constexpr float kMinCosine = 1e-5f;
  const float to = Dot(plane.normal, ray_to);
  if (fabsf(to) < kMinCosine) {
    return plane.depth;
  }
  return plane.depth * Dot(plane.normal, ray_from) / to;
}

// The vector m for which the plane induces the homography A + b m^T on pixels
// (see SourceCameras): m = K^-T n / (distance of the plane to the camera).
TAPA_INLINE Vec3 HomographyVector(const RefCamera& camera, const Plane& plane,
                                  const Vec3& ray) {
  const Vec3 n = (1.0f / (plane.depth * Dot(plane.normal, ray))) * plane.normal;
  return {n.x * camera.inv_fx, n.y * camera.inv_fy,
          n.x * camera.offset_x + n.y * camera.offset_y + n.z};
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_PLANE_H_
