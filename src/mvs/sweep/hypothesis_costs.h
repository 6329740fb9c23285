#ifndef TAPA_SRC_MVS_SWEEP_HYPOTHESIS_COSTS_H_
#define TAPA_SRC_MVS_SWEEP_HYPOTHESIS_COSTS_H_

#include <cmath>

#include "src/mvs/sweep/geometric_cost.h"
#include "src/mvs/sweep/hypotheses.h"
#include "src/mvs/sweep/lanes.h"
#include "src/mvs/sweep/pixel_context.h"
#include "src/mvs/sweep/view_selection.h"

namespace tapa {

// Geometric costs of a depth in the first num_views of the order; what stands
// for the others means nothing.
template <class Lanes, class Sources>
TAPA_INLINE void ComputeGeometricCosts(const PixelContext& p,
                                       const Sources& sources, int num_views,
                                       float depth, float* costs) {
  const PixelScratch& s = p.scratch;
  TAPA_INDEPENDENT_ITERATIONS
  for (int m = Lanes::First(); m < p.views.padded_count; m += Lanes::Step()) {
    s.projection[m] = ProjectToSource(p.views, m, p.row, p.col, depth);
  }
  Lanes::Sync();
  // Depth maps are large, so each read may have to wait for memory.
  for (int k = Lanes::First(); k < num_views; k += Lanes::Step()) {
    const int m = s.order[k];
    s.source_depth[m] = sources.Depth(m, s.projection[m]);
  }
  Lanes::Sync();
  TAPA_INDEPENDENT_ITERATIONS
  for (int m = Lanes::First(); m < p.views.padded_count; m += Lanes::Step()) {
    costs[m] = ReprojectionError(p.views, m, p.row, p.col, s.projection[m],
                                 s.source_depth[m], p.params.geom_max_cost);
  }
}

// Geometric costs of the depths of all hypotheses that have one.
template <class Lanes, class Sources>
TAPA_INLINE void ComputeGeometricCostsOfAll(const PixelContext& p,
                                            const Sources& sources,
                                            int num_distinct) {
  constexpr Hypothesis kDepths[kNumDepths] = {
      kCurrent, kPropagated, kRandom, kDepthPrior, kFinePlane, kCoarsePlane};
  const int num_views = p.params.NeedsAllViews() ? p.views.count : num_distinct;
  for (int i = 0; i < kNumDepths; ++i) {
    const float depth = p.scratch.hypothesis[kDepths[i]].depth;
    if (depth > 0.0f) {
      ComputeGeometricCosts<Lanes>(p, sources, num_views, depth,
                                   p.scratch.geom_cost + i * p.scratch.stride);
    }
  }
  Lanes::Sync();
}

// Weighted geometric costs of hypothesis i, summed over the drawn views.
TAPA_INLINE float SumGeometricCosts(const PixelContext& p,
                                    const CostWeights& weights, int i,
                                    int num_distinct) {
  if (!p.params.geometric) {
    return 0.0f;
  }
  const PixelScratch& s = p.scratch;
  const float* geom_cost = s.geom_cost + DepthIndex(i) * s.stride;
  const float weight = weights.geometric * p.params.geom_weight;
  float sum = 0.0f;
  for (int k = 0; k < num_distinct; ++k) {
    const int m = s.order[k];
    sum += s.num_drawn[m] * weight * geom_cost[m];
  }
  return sum;
}

// The sum so far and the photometric costs of the views at [begin, end) of the
// order.
TAPA_INLINE float AddPhotometricCosts(const PixelScratch& s,
                                      const CostWeights& weights,
                                      const float* cost, int begin, int end,
                                      float sum) {
  for (int k = begin; k < end; ++k) {
    const int m = s.order[k];
    sum += s.num_drawn[m] * weights.photometric * cost[m];
  }
  return sum;
}

// Measures the photometric costs of the listed hypotheses in the views at
// [begin, end) of the order.
template <class Lanes, class Sources>
TAPA_INLINE void MeasureCosts(const PixelContext& p, Sources& sources,
                              const HypothesisList& list, int begin, int end) {
  const PixelScratch& s = p.scratch;
  const int count = list.count * (end - begin);
  for (int first = 0; first < count; first += Lanes::kNumGroups) {
    const GroupShare share = ShareOfGroup<Lanes>(first, count);
    const int i = list.At(share.item % list.count);
    const int m = s.order[begin + share.item / list.count];
    const Warp warp = ComputeWarp(p.views, m, p.row, p.col, s.homography[i]);
    const float cost = DecodeCost(EncodeCost(sources.Cost(m, warp)));
    if (share.stores) {
      s.hypothesis_cost[i * s.stride + m] = cost;
    }
  }
  Lanes::Sync();
}

// Weights of the costs of a hypothesis. As values: what is behind a reference
// that is chosen would have to lie in memory.
TAPA_INLINE CostWeights WeightsOf(const TextureWeights& weights,
                                  int hypothesis) {
  const bool own = hypothesis < kFinePlane;
  return {own ? weights.own.photometric : weights.planar.photometric,
          own ? weights.own.geometric : weights.planar.geometric};
}

// What a hypothesis costs more than the current estimate, in the sum over all
// draws, so that it wins only if it is clearly better. Where there is little
// texture noise decides between hypotheses of nearly the same cost: what a
// coarser level or another pass has seen there better shall not be lost to it.
// Not so for planes from outside, which are made for such places. variance:
// that of the reference patch's intensities (0 to 255).
TAPA_INLINE float Hysteresis(const SweepParams& params, int hypothesis,
                             float variance) {
  // As TapaOptions::textureness_variance.
  constexpr float kLittleTexture = 0.00005f * 255.0f * 255.0f;
  if (hypothesis >= kFinePlane) {
    return 0.0f;
  }
  const float share = kLittleTexture / (kLittleTexture + variance);
  return params.hysteresis * params.num_samples * share * share;
}

// Adds up, in the scratch's `sum`, the costs of hypotheses [first, last) over
// the drawn views. Costs are not negative, so a sum only grows: once it exceeds
// `limit` the hypothesis cannot win any more, and the rest of its views is not
// measured.
template <class Lanes, class Sources>
TAPA_INLINE void SumCosts(const PixelContext& p, Sources& sources, int first,
                          int last, float limit, int num_distinct) {
  const PixelScratch& s = p.scratch;
  const float variance = sources.PatchVariance();
  for (int i = first + Lanes::First(); i < last; i += Lanes::Step()) {
    s.homography[i] = HomographyVector(p.camera, s.hypothesis[i], p.ray);
    s.sum[i] = IsVisible(s.hypothesis[i], p.ray)
                   ? Hysteresis(p.params, i, variance) +
                         SumGeometricCosts(p, WeightsOf(p.guide.weights, i), i,
                                           num_distinct)
                   : INFINITY;
  }
  int begin = 0;
  while (true) {
    Lanes::Sync();
    HypothesisList running;
    for (int i = first; i < last; ++i) {
      if (s.sum[i] <= limit) {
        running.Add(i);
      }
    }
    if (running.count == 0 || begin == num_distinct) {
      return;
    }
    const int next = begin + Lanes::NumViewsAtOnce(running.count);
    const int end = next < num_distinct ? next : num_distinct;
    MeasureCosts<Lanes>(p, sources, running, begin, end);
    for (int n = Lanes::First(); n < running.count; n += Lanes::Step()) {
      const int i = running.At(n);
      s.sum[i] = AddPhotometricCosts(s, WeightsOf(p.guide.weights, i),
                                     s.hypothesis_cost + i * s.stride, begin,
                                     end, s.sum[i]);
    }
    begin = end;
  }
}

// The hypothesis of the smallest cost.
template <class Lanes, class Sources>
TAPA_INLINE int ChooseHypothesis(const PixelContext& p, Sources& sources,
                                 int num_distinct) {
  const PixelScratch& s = p.scratch;
  const CostWeights& own = p.guide.weights.own;
  int best = kCurrent;
  // Added up like those of the other hypotheses, so that equal costs are equal.
  float best_cost =
      AddPhotometricCosts(s, own, s.cost, 0, num_distinct,
                          SumGeometricCosts(p, own, kCurrent, num_distinct));
  for (int first = kCurrent + 1; first < kNumHypotheses;
       first += Lanes::kNumSideBySide) {
    const int end = first + Lanes::kNumSideBySide;
    const int last = end < kNumHypotheses ? end : +kNumHypotheses;
    SumCosts<Lanes>(p, sources, first, last, best_cost, num_distinct);
    for (int i = first; i < last; ++i) {
      if (s.sum[i] <= best_cost) {
        best = i;
        best_cost = s.sum[i];
      }
    }
  }
  return best;
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_HYPOTHESIS_COSTS_H_
