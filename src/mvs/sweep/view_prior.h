#ifndef TAPA_SRC_MVS_SWEEP_VIEW_PRIOR_H_
#define TAPA_SRC_MVS_SWEEP_VIEW_PRIOR_H_

#include <cmath>

#include "src/base/angle.h"
#include "src/mvs/sweep/math.h"
#include "src/mvs/sweep/source_cameras.h"

namespace tapa {

// Cosines of the angles under which the reference and a source view see a point
// of the surface.
struct ViewingAngles {
  // Between the rays from the point to both cameras.
  float cos_triangulation;
  // Between the normal and the ray from the point to the source camera.
  float cos_incident;
};

TAPA_INLINE ViewingAngles ComputeViewingAngles(const SourceCameras& views,
                                               int m, const Vec3& point,
                                               const Vec3& normal) {
  const Vec3 to_source = {views.C[0][m] - point.x, views.C[1][m] - point.y,
                          views.C[2][m] - point.z};
  const float inv_source = 1.0f / sqrtf(Dot(to_source, to_source));
  const float inv_reference = 1.0f / sqrtf(Dot(point, point));
  return {-Dot(to_source, point) * inv_source * inv_reference,
          Dot(to_source, normal) * inv_source};
}

// Priors on how well a source view measures a hypothesis (Schoenberger et al.,
// ECCV 2016, section 4.2).
struct ViewPrior {
  float cos_min_triangulation = 0;
  float inv_one_minus_cos_min = 0;
  float incident_scale = 0;

  static ViewPrior FromAngles(double min_triangulation_angle_degrees,
                              double incident_angle_sigma) {
    // 1 - cos x without cancellation.
    const double half =
        std::sin(DegToRad(0.5 * min_triangulation_angle_degrees));
    const double one_minus_cos = 2.0 * half * half;
    ViewPrior prior;
    prior.cos_min_triangulation = static_cast<float>(1.0 - one_minus_cos);
    prior.inv_one_minus_cos_min =
        one_minus_cos > 0 ? static_cast<float>(1.0 / one_minus_cos) : 0.0f;
    prior.incident_scale = static_cast<float>(
        -0.5 / (incident_angle_sigma * incident_angle_sigma));
    return prior;
  }

  // 1 for angles from the minimum on, falls to 0 with the angle below.
  TAPA_INLINE float Triangulation(float cos_triangulation) const {
    const float cosine = fabsf(cos_triangulation);
    const float scaled = 1.0f - (1.0f - cosine) * inv_one_minus_cos_min;
    const float likelihood = 1.0f - scaled * scaled;
    const float clamped = likelihood > 0.0f ? likelihood : 0.0f;
    return cosine > cos_min_triangulation ? clamped : 1.0f;
  }

  // 1 for a surface seen frontally.
  TAPA_INLINE float Incident(float cos_incident) const {
    const float x = 1.0f - (cos_incident > 0.0f ? cos_incident : 0.0f);
    return ExpNegative(x * x * incident_scale);
  }

  // Ratio of the areas that the window covers in the two views, at most 1; 0
  // where the window cannot be projected.
  TAPA_INLINE static float Resolution(const Warp& warp, float radius) {
    // Half the cross product of the diagonals, with the corners as homogeneous
    // coordinates: one division will do for all.
    const Vec3 a = warp.At(-radius, -radius);
    const Vec3 b = warp.At(-radius, radius);
    const Vec3 c = warp.At(radius, radius);
    const Vec3 d = warp.At(radius, -radius);
    const float ac_x = c.x * a.z - a.x * c.z;
    const float ac_y = c.y * a.z - a.y * c.z;
    const float bd_x = d.x * b.z - b.x * d.z;
    const float bd_y = d.y * b.z - b.y * d.z;
    const float source_area = 0.5f * fabsf(ac_x * bd_y - bd_x * ac_y);
    const float size = 2.0f * radius + 1.0f;
    const float area = size * size * fabsf(a.z * c.z * b.z * d.z);
    const bool is_smaller = source_area < area;
    const float prior =
        (is_smaller ? source_area : area) / (is_smaller ? area : source_area);
    return prior > 0.0f ? prior : 0.0f;
  }
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_VIEW_PRIOR_H_
