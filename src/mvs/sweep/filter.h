#ifndef TAPA_SRC_MVS_SWEEP_FILTER_H_
#define TAPA_SRC_MVS_SWEEP_FILTER_H_

#include "src/mvs/sweep/pixel_scratch.h"
#include "src/mvs/sweep/plane.h"
#include "src/mvs/sweep/source_cameras.h"
#include "src/mvs/sweep/sweep_params.h"
#include "src/mvs/sweep/view_prior.h"

namespace tapa {

// Counts the views that support the estimate and reports each one.
template <class Lanes, class Sources>
TAPA_INLINE int FindConsistentViews(const SweepParams& params,
                                    const SourceCameras& views,
                                    const Plane& plane, const Vec3& ray,
                                    const float* geom_cost, PixelScratch* s,
                                    Sources* sources) {
  const Vec3 point = plane.depth * ray;
  int num_consistent = 0;
  for (int m = Lanes::First(); m < views.count; m += Lanes::Step()) {
    const ViewingAngles angles =
        ComputeViewingAngles(views, m, point, plane.normal);
    const bool consistent =
        angles.cos_triangulation <= params.filter_cos_min_triangulation &&
        angles.cos_incident > 0.0f && s->prob[m] >= params.filter_min_prob &&
        (!params.geometric || geom_cost[m] <= params.filter_geom_max_cost);
    sources->SetConsistent(m, consistent);
    num_consistent += consistent ? 1 : 0;
  }
  return Lanes::Sum(num_consistent);
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_FILTER_H_
