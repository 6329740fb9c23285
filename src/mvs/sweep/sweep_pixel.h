#ifndef TAPA_SRC_MVS_SWEEP_SWEEP_PIXEL_H_
#define TAPA_SRC_MVS_SWEEP_SWEEP_PIXEL_H_

#include <cstdint>

#include "src/mvs/sweep/filter.h"
#include "src/mvs/sweep/hypotheses.h"
#include "src/mvs/sweep/hypothesis_costs.h"
#include "src/mvs/sweep/lanes.h"
#include "src/mvs/sweep/pixel_scratch.h"
#include "src/mvs/sweep/plane.h"
#include "src/mvs/sweep/random.h"
#include "src/mvs/sweep/source_cameras.h"
#include "src/mvs/sweep/sweep_params.h"
#include "src/mvs/sweep/view_sampling.h"
#include "src/mvs/sweep/view_selection.h"

// What a sweep does with one pixel. Written once for all backends: a backend
// brings `Lanes`, see lanes.h, and `Sources`, which correlates patches and
// reads depth maps.

namespace tapa {

// The new estimate of a pixel.
struct Choice {
  Plane plane;
  Hypothesis hypothesis;
  // Whether it passed the filter, if that is on.
  bool keep;
};

// Chooses among the hypotheses of the pixel and updates its costs, messages and
// selection probabilities. `previous` is the estimate of the pixel before on
// the sweep's line, with its ray. The choice is that before filtering.
template <class Lanes, class Sources>
TAPA_INLINE Choice SweepPixel(const SweepParams& params,
                              const RefCamera& camera,
                              const SourceCameras& views, Sources& sources,
                              int row, int col, uint64_t pixel,
                              const Plane& current, const Plane& previous,
                              const Vec3& previous_ray, const PixelGuide& guide,
                              PixelScratch* s) {
  const Random random(params.seed, pixel, params.index);
  const Vec3 ray = camera.Ray(row, col);
  ComputeSamplingDistribution<Lanes>(params, camera, views, row, col, current,
                                     ray, s);
  const int num_distinct = DrawViews<Lanes>(params, random, views, s);

  if (Lanes::First() == 0) {
    MakeHypotheses(params, random, current, previous, previous_ray, ray, guide,
                   s->plane);
  }
  Lanes::Sync();
  if (params.geometric) {
    ComputeGeometricCostsOfAll<Lanes>(params, views, sources, row, col, s);
  }
  const int best =
      ChooseHypothesis<Lanes>(params, camera, views, sources, row, col, ray,
                              guide.weights, num_distinct, s);
  const Plane chosen = s->plane[best];
  if (best != kCurrent) {
    // In the drawn views it is measured already.
    HypothesisList list;
    list.Add(best);
    MeasureCosts<Lanes>(views, sources, row, col, list, num_distinct,
                        views.count, s);
    for (int m = Lanes::First(); m < views.count; m += Lanes::Step()) {
      s->cost[m] = s->hypothesis_cost[best * s->stride + m];
    }
  }

  TAPA_INDEPENDENT_ITERATIONS
  for (int m = Lanes::First(); m < views.padded_count; m += Lanes::Step()) {
    const float forward = ViewSelection::Forward(
        params.selection.Emission(s->cost[m]), s->forward[m]);
    s->prob[m] = ViewSelection::Probability(forward, s->backward[m], s->prob[m],
                                            params.prev_prob_weight);
    s->forward[m] = forward;
  }

  bool keep = true;
  if (params.filter) {
    keep = FindConsistentViews<Lanes>(
               params, views, chosen, ray,
               s->geom_cost + DepthIndex(best) * s->stride, s,
               &sources) >= params.filter_min_num_consistent;
  }
  return {chosen, static_cast<Hypothesis>(best), keep};
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_SWEEP_PIXEL_H_
