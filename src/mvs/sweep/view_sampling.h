#ifndef TAPA_SRC_MVS_SWEEP_VIEW_SAMPLING_H_
#define TAPA_SRC_MVS_SWEEP_VIEW_SAMPLING_H_

#include "src/mvs/sweep/pixel_context.h"
#include "src/mvs/sweep/view_prior.h"
#include "src/mvs/sweep/view_selection.h"

namespace tapa {

// A step of the cumulative distribution that no draw reaches.
constexpr float kNeverDrawn = 2.0f;

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
  for (int m = Lanes::First(); m < views.padded_count; m += Lanes::Step()) {
    const float step = (usable ? s.cdf[m] : m + 1.0f) * scale;
    s.cdf[m] = m < views.count ? step : kNeverDrawn;
  }
}

// The order of views: those drawn most often first, of equal ones the first.
TAPA_INLINE bool ComesBefore(const PixelScratch& s, int m, int other) {
  const float drawn = s.num_drawn[m];
  const float other_drawn = s.num_drawn[other];
  return (drawn > other_drawn) | ((drawn == other_drawn) & (m < other));
}

// Draws views with replacement. One lane finds the step of the distribution
// that a draw meets by counting those below, and sorts the views that it has
// drawn, which are few.
TAPA_INLINE int DrawViewsOneByOne(const PixelContext& p) {
  const SourceCameras& views = p.views;
  const PixelScratch& s = p.scratch;
  for (int m = 0; m < views.padded_count; ++m) {
    s.num_drawn[m] = 0.0f;
  }
  int num_distinct = 0;
  for (int i = 0; i < p.params.num_samples; ++i) {
    const float u = p.random.Uniform(kDrawSample + i);
    int m = 0;
    for (int k = 0; k < views.padded_count; ++k) {
      m += s.cdf[k] <= u ? 1 : 0;
    }
    // Rounding can leave the last step below 1.
    if (m < views.count) {
      if (s.num_drawn[m] == 0.0f) {
        s.order[num_distinct++] = m;
      }
      s.num_drawn[m] += 1.0f;
    }
  }
  for (int k = 1; k < num_distinct; ++k) {
    const int m = s.order[k];
    int rank = k;
    for (; rank > 0 && ComesBefore(s, m, s.order[rank - 1]); --rank) {
      s.order[rank] = s.order[rank - 1];
    }
    s.order[rank] = m;
  }
  if (p.params.NeedsAllViews()) {
    int next = num_distinct;
    for (int m = 0; m < views.count; ++m) {
      if (s.num_drawn[m] == 0.0f) {
        s.order[next++] = m;
      }
    }
  }
  return num_distinct;
}

// Many lanes have a view each, and count the draws below its step. Uses up the
// distribution.
template <class Lanes>
TAPA_INLINE void CountDraws(const PixelContext& p) {
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
      for (int m = Lanes::First(); m < views.padded_count; m += Lanes::Step()) {
        s.num_drawn[m] += u < s.cdf[m] ? 1.0f : 0.0f;
      }
    }
    Lanes::Sync();
  }
  for (int m = Lanes::First(); m < views.count; m += Lanes::Step()) {
    s.cdf[m] = s.num_drawn[m];
  }
  Lanes::Sync();
  for (int m = Lanes::First(); m < views.count; m += Lanes::Step()) {
    s.num_drawn[m] = s.cdf[m] - (m > 0 ? s.cdf[m - 1] : 0.0f);
  }
  Lanes::Sync();
}

// And they find the ranks of all views at once.
template <class Lanes>
TAPA_INLINE int OrderViews(int count, const PixelScratch& s) {
  int num_distinct = 0;
  for (int m = Lanes::First(); m < count; m += Lanes::Step()) {
    num_distinct += s.num_drawn[m] > 0.0f ? 1 : 0;
    int rank = 0;
    for (int k = 0; k < count; ++k) {
      rank += ComesBefore(s, k, m) ? 1 : 0;
    }
    s.order[rank] = m;
  }
  Lanes::Sync();
  return Lanes::Sum(num_distinct);
}

// Draws views with replacement. The same draws serve all hypotheses; a view
// drawn k times is measured once and counts k times. Returns the number of
// distinct views, which come first in the order.
template <class Lanes>
TAPA_INLINE int DrawViews(const PixelContext& p) {
  if constexpr (Lanes::Step() == 1) {
    return DrawViewsOneByOne(p);
  } else {
    CountDraws<Lanes>(p);
    return OrderViews<Lanes>(p.views.count, p.scratch);
  }
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
