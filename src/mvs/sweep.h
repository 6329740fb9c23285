#ifndef TAPA_SRC_MVS_SWEEP_H_
#define TAPA_SRC_MVS_SWEEP_H_

#include "src/mvs/geometric_cost.h"
#include "src/mvs/hypotheses.h"
#include "src/mvs/plane.h"
#include "src/mvs/source_cameras.h"
#include "src/mvs/texture_weights.h"
#include "src/mvs/view_prior.h"
#include "src/mvs/view_selection.h"

// What a sweep does with one pixel. Written once for all backends: a backend
// brings `Lanes`, which says how the loops over source views are shared out,
// and `Sources`, which correlates patches and reads depth maps.

#if defined(__CUDACC__)
#define TAPA_INDEPENDENT_ITERATIONS
#else
#define TAPA_INDEPENDENT_ITERATIONS _Pragma("GCC ivdep")
#endif

namespace tapa {

// All loops over views run in one thread.
struct SerialLanes {
  static constexpr int First() { return 0; }
  static constexpr int Step() { return 1; }
};

// Parameters of one sweep.
struct SweepParams {
  // Number of the sweep since the estimation began; keys the random numbers.
  uint32_t index = 0;
  uint64_t seed = 0;
  // Relative size of the random changes, 1 in the first sweep.
  float perturbation = 1;
  // Weight of the selection probability of the sweep before, 0 to 1.
  float prev_prob_weight = 0;
  int num_samples = 15;
  // Half size of the correlation window, in pixels.
  float window_radius = 5;
  ViewSelection selection;
  ViewPrior prior;

  // The geometric pass.
  bool geometric = false;
  float geom_weight = 0.3f;
  float geom_max_cost = 3;

  // The last sweep, with the filter on.
  bool filter = false;
  float filter_min_prob = 0;
  float filter_cos_min_triangulation = 1;
  float filter_geom_max_cost = 1;
  int filter_min_num_consistent = 2;
};

// Hypotheses of a pixel, see docs/design.md. The smallest cost wins; of equal
// ones the later.
enum Hypothesis {
  kCurrent,
  kPropagated,
  kRandom,
  kRandomNormal,
  kRandomDepth,
  // From outside the sweep: planes of a fine and a coarse superpixel.
  kFinePlane,
  kCoarsePlane,
  kNumHypotheses
};

// What a pixel brings to the sweep from outside.
struct PixelGuide {
  TextureWeights weights;
  // Further hypotheses; depth 0: none.
  Plane fine;
  Plane coarse;
};

// The new estimate of a pixel.
struct Choice {
  Plane plane;
  Hypothesis hypothesis;
  // Whether it passed the filter, if that is on.
  bool keep;
};

// Distinct depths among the hypotheses: current, propagated, random, and those
// of the planes.
constexpr int kNumDepths = 5;

// Which of them a hypothesis has.
TAPA_INLINE int DepthIndex(int hypothesis) {
  return hypothesis == kPropagated                             ? 1
         : hypothesis == kRandom || hypothesis == kRandomDepth ? 2
         : hypothesis == kFinePlane                            ? 3
         : hypothesis == kCoarsePlane                          ? 4
                                                               : 0;
}

// Working memory for one pixel: arrays over the views, padded as in
// SourceCameras.
struct PixelScratch {
  // In and out: photometric cost of the pixel's estimate in every view.
  float* cost;
  // In: selection probability from the sweep before. Out: the new one.
  float* prob;
  // In: forward message (odds) of the pixel before. Out: this pixel's.
  float* forward;
  // In: backward message (odds).
  const float* backward;

  // Cumulative distribution of the sampled views, then how often each one was
  // drawn.
  float* cdf;
  float* num_drawn;
  // Views drawn at least once, most often drawn first.
  int* drawn;
  int num_distinct;

  // Photometric costs of the hypotheses where computed, otherwise negative.
  float* hypothesis_cost[kNumHypotheses];
  // Geometric costs of the distinct depths.
  float* geom_cost[kNumDepths];
  Projection* projection;
  float* source_depth;
};

// Probability of drawing each view: visible, with a good angle to measure the
// surface, and at a similar resolution. Leaves the cumulative distribution.
template <class Lanes>
TAPA_INLINE void ComputeSamplingDistribution(const SweepParams& params,
                                             const RefCamera& camera,
                                             const SourceCameras& views,
                                             float row, float col,
                                             const Plane& plane,
                                             const Vec3& ray, PixelScratch* s) {
  const Vec3 point = plane.depth * ray;
  const Vec3 h = HomographyVector(camera, plane, ray);
  TAPA_INDEPENDENT_ITERATIONS
  for (int m = Lanes::First(); m < views.padded_count; m += Lanes::Step()) {
    const float forward = ViewSelection::Forward(
        params.selection.Emission(s->cost[m]), s->forward[m]);
    const float visible = ViewSelection::Probability(
        forward, s->backward[m], s->prob[m], params.prev_prob_weight);
    const ViewingAngles angles =
        ComputeViewingAngles(views, m, point, plane.normal);
    s->cdf[m] = views.valid[m] * visible *
                params.prior.Triangulation(angles.cos_triangulation) *
                params.prior.Incident(angles.cos_incident) *
                ViewPrior::Resolution(ComputeWarp(views, m, row, col, h),
                                      params.window_radius);
  }
  float sum = 0.0f;
  for (int m = 0; m < views.count; ++m) {
    sum += s->cdf[m];
    s->cdf[m] = sum;
  }
  // Where no view has a chance, all have the same.
  const bool usable = sum > 0.0f;
  const float scale = usable ? 1.0f / sum : 1.0f / views.count;
  for (int m = 0; m < views.count; ++m) {
    s->cdf[m] = (usable ? s->cdf[m] : m + 1.0f) * scale;
  }
}

// Draws views with replacement. The same draws serve all hypotheses; a view
// drawn k times is measured once and counts k times.
template <class Lanes>
TAPA_INLINE void DrawViews(const SweepParams& params, const Random& random,
                           const SourceCameras& views, PixelScratch* s) {
  for (int m = Lanes::First(); m < views.padded_count; m += Lanes::Step()) {
    s->num_drawn[m] = 0.0f;
  }
  for (int i = 0; i < params.num_samples; ++i) {
    const float u = random.Uniform(kDrawSample + i);
    TAPA_INDEPENDENT_ITERATIONS
    for (int m = Lanes::First(); m < views.padded_count; m += Lanes::Step()) {
      s->num_drawn[m] += u < s->cdf[m] ? 1.0f : 0.0f;
    }
  }
  // So far num_drawn counts the draws below each step of the distribution.
  s->num_distinct = 0;
  float before = 0.0f;
  for (int m = 0; m < views.count; ++m) {
    const float below = s->num_drawn[m];
    const float drawn = below - before;
    before = below;
    s->num_drawn[m] = drawn;
    if (drawn > 0.0f) {
      int i = s->num_distinct++;
      for (; i > 0 && s->num_drawn[s->drawn[i - 1]] < drawn; --i) {
        s->drawn[i] = s->drawn[i - 1];
      }
      s->drawn[i] = m;
    }
  }
}

template <class Lanes, class Sources>
TAPA_INLINE void ComputeGeometricCosts(const SweepParams& params,
                                       const SourceCameras& views,
                                       const Sources& sources, float row,
                                       float col, float depth, PixelScratch* s,
                                       float* costs) {
  TAPA_INDEPENDENT_ITERATIONS
  for (int m = Lanes::First(); m < views.padded_count; m += Lanes::Step()) {
    s->projection[m] = ProjectToSource(views, m, row, col, depth);
  }
  for (int m = Lanes::First(); m < views.count; m += Lanes::Step()) {
    s->source_depth[m] = sources.Depth(m, s->projection[m]);
  }
  TAPA_INDEPENDENT_ITERATIONS
  for (int m = Lanes::First(); m < views.padded_count; m += Lanes::Step()) {
    costs[m] = ReprojectionError(views, m, row, col, s->projection[m],
                                 s->source_depth[m], params.geom_max_cost);
  }
}

// Whether a hypothesis can be true: in front of the camera, and facing it.
TAPA_INLINE bool IsVisible(const Plane& plane, const Vec3& ray) {
  return plane.depth > 0.0f && Dot(plane.normal, ray) < 0.0f;
}

// Weighted geometric costs of a hypothesis, summed over the drawn views.
TAPA_INLINE float SumGeometricCost(const SweepParams& params,
                                   const CostWeights& weights,
                                   const float* geom_cost,
                                   const PixelScratch& s) {
  const float weight = weights.geometric * params.geom_weight;
  float sum = 0.0f;
  for (int k = 0; k < s.num_distinct; ++k) {
    const int m = s.drawn[k];
    sum += s.num_drawn[m] * weight * geom_cost[m];
  }
  return sum;
}

// Summed cost of hypothesis i over the drawn views. Costs are not negative, so
// the sum only grows: once it exceeds `limit` the hypothesis cannot win any
// more, and the rest of its views need not be measured.
template <class Sources>
TAPA_INLINE float SumCost(const SweepParams& params, const RefCamera& camera,
                          const SourceCameras& views, Sources& sources,
                          float row, float col, const Plane& plane,
                          const Vec3& ray, int i, const CostWeights& weights,
                          float limit, PixelScratch* s) {
  float sum =
      params.geometric
          ? SumGeometricCost(params, weights, s->geom_cost[DepthIndex(i)], *s)
          : 0.0f;
  const Vec3 h = HomographyVector(camera, plane, ray);
  for (int k = 0; k < s->num_distinct && sum <= limit; ++k) {
    const int m = s->drawn[k];
    const float cost = DecodeCost(
        EncodeCost(sources.Cost(m, ComputeWarp(views, m, row, col, h))));
    s->hypothesis_cost[i][m] = cost;
    sum += s->num_drawn[m] * weights.photometric * cost;
  }
  return sum;
}

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
    if (consistent) {
      sources->SetConsistent(m);
      ++num_consistent;
    }
  }
  return num_consistent;
}

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
  DrawViews<Lanes>(params, random, views, s);

  const float random_depth =
      PerturbDepth(random, params.perturbation, current.depth);
  const Vec3 random_normal =
      PerturbNormal(random, params.perturbation, current.normal, ray);
  const Plane planes[kNumHypotheses] = {
      current,
      {PropagateDepth(previous, previous_ray, ray), previous.normal},
      {random_depth, random_normal},
      {current.depth, random_normal},
      {random_depth, current.normal},
      guide.fine,
      guide.coarse};

  if (params.geometric) {
    constexpr Hypothesis kDepths[kNumDepths] = {kCurrent, kPropagated, kRandom,
                                                kFinePlane, kCoarsePlane};
    for (int i = 0; i < kNumDepths; ++i) {
      const float depth = planes[kDepths[i]].depth;
      if (depth > 0.0f) {
        ComputeGeometricCosts<Lanes>(params, views, sources, row, col, depth, s,
                                     s->geom_cost[i]);
      }
    }
  }

  int best = kCurrent;
  const CostWeights& own = guide.weights.own;
  // Added up like those of the other hypotheses, so that equal costs are equal.
  float best_cost = params.geometric
                        ? SumGeometricCost(params, own, s->geom_cost[0], *s)
                        : 0.0f;
  for (int k = 0; k < s->num_distinct; ++k) {
    const int m = s->drawn[k];
    best_cost += s->num_drawn[m] * own.photometric * s->cost[m];
  }
  for (int i = kCurrent + 1; i < kNumHypotheses; ++i) {
    if (!IsVisible(planes[i], ray)) {
      continue;
    }
    for (int m = Lanes::First(); m < views.count; m += Lanes::Step()) {
      s->hypothesis_cost[i][m] = -1.0f;
    }
    const CostWeights& weights = i < kFinePlane ? own : guide.weights.planar;
    const float cost = SumCost(params, camera, views, sources, row, col,
                               planes[i], ray, i, weights, best_cost, s);
    if (cost <= best_cost) {
      best = i;
      best_cost = cost;
    }
  }

  const Plane chosen = planes[best];
  if (best != kCurrent) {
    const Vec3 h = HomographyVector(camera, chosen, ray);
    for (int m = 0; m < views.count; ++m) {
      const float known = s->hypothesis_cost[best][m];
      s->cost[m] = known >= 0.0f ? known
                                 : DecodeCost(EncodeCost(sources.Cost(
                                       m, ComputeWarp(views, m, row, col, h))));
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
               params, views, chosen, ray, s->geom_cost[DepthIndex(best)], s,
               &sources) >= params.filter_min_num_consistent;
  }
  return {chosen, static_cast<Hypothesis>(best), keep};
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_H_
