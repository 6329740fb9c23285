#ifndef TAPA_SRC_MVS_SWEEP_SWEEP_PIXEL_H_
#define TAPA_SRC_MVS_SWEEP_SWEEP_PIXEL_H_

#include "src/mvs/sweep/consistent_views.h"
#include "src/mvs/sweep/hypotheses.h"
#include "src/mvs/sweep/hypothesis_costs.h"
#include "src/mvs/sweep/lanes.h"
#include "src/mvs/sweep/pixel_context.h"
#include "src/mvs/sweep/view_sampling.h"
#include "src/mvs/sweep/view_selection.h"

// What a sweep does with one pixel. Written once for all backends: a backend
// brings `Lanes`, see lanes.h, and `Sources`, which correlates patches and
// reads depth maps.

namespace tapa {

// The new estimate of a pixel.
struct Choice {
  DepthNormal estimate;
  Hypothesis hypothesis;
  // Whether enough views are consistent with it, or nobody asks.
  bool is_consistent;
};

// Gives the pixel the costs of the hypothesis that it has chosen, which the
// drawn views have measured already. The others keep theirs, of an estimate
// that was the pixel's before: nearly the same one in most sweeps, and a view
// that sees the pixel is drawn soon.
template <class Lanes, class Sources>
TAPA_INLINE void TakeCosts(const PixelContext& p, Sources& sources, int chosen,
                           int num_distinct) {
  const PixelScratch& s = p.scratch;
  int num_measured = num_distinct;
  if (p.params.measure_all) {
    HypothesisList list;
    list.Add(chosen);
    MeasureCosts<Lanes>(p, sources, list, num_distinct, p.views.count);
    num_measured = p.views.count;
  }
  for (int k = Lanes::First(); k < num_measured; k += Lanes::Step()) {
    const int m = s.order[k];
    s.cost[m] = s.hypothesis_cost[chosen * s.stride + m];
  }
  Lanes::Sync();
}

// Messages and selection probabilities from the costs of the new estimate.
template <class Lanes>
TAPA_INLINE void UpdateSelection(const PixelContext& p) {
  const PixelScratch& s = p.scratch;
  TAPA_INDEPENDENT_ITERATIONS
  for (int m = Lanes::First(); m < p.views.padded_count; m += Lanes::Step()) {
    const float forward = ViewSelection::Forward(
        p.params.selection.Emission(s.cost[m]), s.forward[m]);
    s.prob[m] = ViewSelection::Probability(forward, s.backward[m], s.prob[m],
                                           p.params.prev_prob_weight);
    s.forward[m] = forward;
  }
}

// Chooses among the hypotheses of the pixel and updates its costs, messages and
// selection probabilities. The choice is that before filtering.
template <class Lanes, class Sources>
TAPA_INLINE Choice SweepPixel(const PixelContext& p,
                              const PreviousPixel& previous, Sources& sources) {
  const PixelScratch& s = p.scratch;
  ComputeSamplingDistribution<Lanes>(p);
  const int num_distinct = DrawViews<Lanes>(p);

  const float drawn_cost = MeanDrawnCost<Lanes>(p);
  if (Lanes::First() == 0) {
    MakeHypotheses(p, previous, drawn_cost, s.hypothesis);
  }
  Lanes::Sync();
  if (p.params.geometric) {
    ComputeGeometricCostsOfAll<Lanes>(p, sources, num_distinct);
  }
  const int best = ChooseHypothesis<Lanes>(p, sources, num_distinct);
  const DepthNormal chosen = s.hypothesis[best];
  if (best != kCurrent) {
    TakeCosts<Lanes>(p, sources, best, num_distinct);
  }
  UpdateSelection<Lanes>(p);

  bool is_consistent = true;
  if (p.params.check_consistency) {
    is_consistent = CountConsistentViews<Lanes>(
                        p, chosen, s.geom_cost + DepthIndex(best) * s.stride,
                        sources) >= p.params.filter_min_num_consistent;
  }
  return {chosen, static_cast<Hypothesis>(best), is_consistent};
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_SWEEP_PIXEL_H_
