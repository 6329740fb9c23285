#ifndef TAPA_SRC_MVS_SWEEP_CONSISTENT_VIEWS_H_
#define TAPA_SRC_MVS_SWEEP_CONSISTENT_VIEWS_H_

#include "src/mvs/sweep/pixel_context.h"
#include "src/mvs/sweep/view_prior.h"

namespace tapa {

// Counts the views that are consistent with an estimate and reports each one.
// geom_cost: the estimate's geometric cost in every view, in the geometric
// pass.
template <class Lanes, class Sources>
TAPA_INLINE int CountConsistentViews(const PixelContext& p,
                                     const DepthNormal& estimate,
                                     const float* geom_cost, Sources& sources) {
  const SweepParams& params = p.params;
  const Vec3 point = estimate.depth * p.ray;
  int num_consistent = 0;
  for (int m = Lanes::First(); m < p.views.count; m += Lanes::Step()) {
    const ViewingAngles angles =
        ComputeViewingAngles(p.views, m, point, estimate.normal);
    const bool consistent =
        angles.cos_triangulation <= params.filter_cos_min_triangulation &&
        angles.cos_incident > 0.0f &&
        p.scratch.prob[m] >= params.filter_min_prob &&
        (!params.geometric || geom_cost[m] <= params.filter_geom_max_cost);
    sources.SetConsistent(m, consistent);
    num_consistent += consistent ? 1 : 0;
  }
  return Lanes::Sum(num_consistent);
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_CONSISTENT_VIEWS_H_
