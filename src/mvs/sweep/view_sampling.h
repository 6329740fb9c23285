#ifndef TAPA_SRC_MVS_SWEEP_VIEW_SAMPLING_H_
#define TAPA_SRC_MVS_SWEEP_VIEW_SAMPLING_H_

#include "src/mvs/sweep/pixel_context.h"
#include "src/mvs/sweep/view_prior.h"
#include "src/mvs/sweep/view_selection.h"

namespace tapa {

// Probability of drawing each view: visible, with a good angle to measure the
// surface, and at a similar resolution. Leaves the cumulative distribution.
template <class Lanes>
TAPA_INLINE void ComputeSamplingDistribution(const PixelContext& p) {
  const SweepParams& params = p.params;
  const SourceCameras& views = p.views;
  const PixelScratch& s = p.scratch;
  const Vec3 point = p.current.depth * p.ray;
  const Vec3 h = HomographyVector(p.camera, p.current, p.ray);
  TAPA_INDEPENDENT_ITERATIONS
  for (int m = Lanes::First(); m < views.padded_count; m += Lanes::Step()) {
    const float forward = ViewSelection::Forward(
        params.selection.Emission(s.cost[m]), s.forward[m]);
    const float visible = ViewSelection::Probability(
        forward, s.backward[m], s.prob[m], params.prev_prob_weight);
    const ViewingAngles angles =
        ComputeViewingAngles(views, m, point, p.current.normal);
    s.cdf[m] = views.valid[m] * visible *
               params.prior.Triangulation(angles.cos_triangulation) *
               params.prior.Incident(angles.cos_incident) *
               ViewPrior::Resolution(ComputeWarp(views, m, p.row, p.col, h),
                                     params.window_radius);
  }
  Lanes::Sync();
  const float sum = Lanes::Accumulate(views.count, s.cdf);
  // Where no view has a chance, all have the same.
  const bool usable = sum > 0.0f;
  const float scale = usable ? 1.0f / sum : 1.0f / views.count;
  for (int m = Lanes::First(); m < views.count; m += Lanes::Step()) {
    s.cdf[m] = (usable ? s.cdf[m] : m + 1.0f) * scale;
  }
}

// Turns num_drawn, which counts the draws below each step of the distribution,
// into the number of draws of each view. Uses up the distribution.
template <class Lanes>
TAPA_INLINE void CountDraws(const SourceCameras& views, const PixelScratch& s) {
  for (int m = Lanes::First(); m < views.count; m += Lanes::Step()) {
    s.cdf[m] = s.num_drawn[m];
  }
  Lanes::Sync();
  for (int m = Lanes::First(); m < views.count; m += Lanes::Step()) {
    s.num_drawn[m] = s.cdf[m] - (m > 0 ? s.cdf[m - 1] : 0.0f);
  }
  Lanes::Sync();
}

// Draws views with replacement. The same draws serve all hypotheses; a view
// drawn k times is measured once and counts k times. Returns the number of
// distinct views, which come first in the order.
template <class Lanes>
TAPA_INLINE int DrawViews(const PixelContext& p) {
  const SourceCameras& views = p.views;
  const PixelScratch& s = p.scratch;
  for (int m = Lanes::First(); m < views.padded_count; m += Lanes::Step()) {
    s.num_drawn[m] = 0.0f;
  }
  for (int first = 0; first < p.params.num_samples; first += kDrawBlock) {
    const int rest = p.params.num_samples - first;
    const int count = rest < kDrawBlock ? rest : kDrawBlock;
    for (int i = Lanes::First(); i < count; i += Lanes::Step()) {
      s.uniform[i] = p.random.Uniform(kDrawSample + first + i);
    }
    Lanes::Sync();
    for (int i = 0; i < count; ++i) {
      const float u = s.uniform[i];
      TAPA_INDEPENDENT_ITERATIONS
      for (int m = Lanes::First(); m < views.padded_count; m += Lanes::Step()) {
        s.num_drawn[m] += u < s.cdf[m] ? 1.0f : 0.0f;
      }
    }
    Lanes::Sync();
  }
  CountDraws<Lanes>(views, s);

  int num_distinct = 0;
  for (int m = Lanes::First(); m < views.count; m += Lanes::Step()) {
    const float drawn = s.num_drawn[m];
    num_distinct += drawn > 0.0f ? 1 : 0;
    int rank = 0;
    for (int k = 0; k < views.count; ++k) {
      const float other = s.num_drawn[k];
      rank += (other > drawn) | ((other == drawn) & (k < m)) ? 1 : 0;
    }
    s.order[rank] = m;
  }
  Lanes::Sync();
  return Lanes::Sum(num_distinct);
}

// Photometric cost of the current estimate, mean of the draws.
template <class Lanes>
TAPA_INLINE float MeanDrawnCost(const PixelContext& p) {
  const PixelScratch& s = p.scratch;
  float sum = 0.0f;
  for (int m = Lanes::First(); m < p.views.count; m += Lanes::Step()) {
    sum += s.num_drawn[m] * s.cost[m];
  }
  return Lanes::Sum(sum) / p.params.num_samples;
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_VIEW_SAMPLING_H_
