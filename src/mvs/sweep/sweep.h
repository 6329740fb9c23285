#ifndef TAPA_SRC_MVS_SWEEP_SWEEP_H_
#define TAPA_SRC_MVS_SWEEP_SWEEP_H_

#include <cmath>

#include "src/mvs/sweep/geometric_cost.h"
#include "src/mvs/sweep/hypotheses.h"
#include "src/mvs/sweep/plane.h"
#include "src/mvs/sweep/source_cameras.h"
#include "src/mvs/sweep/texture_weights.h"
#include "src/mvs/sweep/view_prior.h"
#include "src/mvs/sweep/view_selection.h"

// What a sweep does with one pixel. Written once for all backends: a backend
// brings `Lanes`, which says how the work is shared out, and `Sources`, which
// correlates patches and reads depth maps.
//
// All lanes of a pixel run the functions below together, with the same
// arguments, and get the same results. They share the scratch: what one lane
// wrote there, others may read after Sync().

#if defined(__CUDACC__)
#define TAPA_INDEPENDENT_ITERATIONS
#else
#define TAPA_INDEPENDENT_ITERATIONS _Pragma("GCC ivdep")
#endif

namespace tapa {

// One lane: everything runs in one thread.
struct SerialLanes {
  // A lane's share of a loop: First(), First() + Step(), ...
  static constexpr TAPA_INLINE int First() { return 0; }
  static constexpr TAPA_INLINE int Step() { return 1; }
  static TAPA_INLINE void Sync() {}
  // Sums over all lanes, and over those of a group (see below).
  static TAPA_INLINE int Sum(int value) { return value; }
  static TAPA_INLINE float Sum(float value) { return value; }
  static TAPA_INLINE float GroupSum(float value) { return value; }
  // Replaces values by their cumulative sums, whose last one is returned.
  static TAPA_INLINE float Accumulate(int count, float* values) {
    float sum = 0.0f;
    for (int i = 0; i < count; ++i) {
      sum += values[i];
      values[i] = sum;
    }
    return sum;
  }

  // Correlations are shared out, too: a group of lanes measures one at a time.
  // All groups do so together, see ShareOfGroup.
  static constexpr int kGroupSize = 1;
  static constexpr int kNumGroups = 1;
  static constexpr TAPA_INLINE int Group() { return 0; }
  static constexpr TAPA_INLINE int GroupLane() { return 0; }
  // How many hypotheses are measured side by side. Side by side they fill the
  // groups, one after the other each knows how good those before were.
  static constexpr int kNumSideBySide = 1;
  // In how many views so many hypotheses are measured before those that cannot
  // win any more drop out.
  static constexpr TAPA_INLINE int NumViewsAtOnce(int /*num_hypotheses*/) {
    return 1;
  }
};

// What a group does of the kNumGroups items of a loop that come next.
struct GroupShare {
  int item;
  // Whether this lane stores the result.
  bool stores;
};

// A group for which none is left repeats the last one, so that all lanes go the
// same way and sum across groups with one instruction.
template <class Lanes>
TAPA_INLINE GroupShare ShareOfGroup(int first, int count) {
  const int item = first + Lanes::Group();
  const bool is_mine = item < count;
  return {is_mine ? item : count - 1, is_mine && Lanes::GroupLane() == 0};
}

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

// Number of random numbers that DrawViews makes at a time.
constexpr int kDrawBlock = 32;

// Working memory for one pixel: arrays over the views, padded as in
// SourceCameras, if nothing else is said.
struct PixelScratch {
  // In and out: photometric cost of the pixel's estimate in every view.
  float* cost;
  // In: selection probability from the sweep before. Out: the new one.
  float* prob;
  // In: forward message (odds) of the pixel before. Out: this pixel's.
  float* forward;
  // In: backward message (odds).
  const float* backward;

  // Cumulative distribution of the sampled views.
  float* cdf;
  // How often each one was drawn.
  float* num_drawn;
  // All views, those drawn most often first, of equal ones the first.
  int* order;
  // kDrawBlock random numbers.
  float* uniform;

  // Of each hypothesis: its plane, its HomographyVector, and the cost that is
  // added up so far.
  Plane* plane;
  Vec3* homography;
  float* sum;
  // Elements between the arrays of two hypotheses below.
  int stride;
  // Photometric costs at [hypothesis * stride + view], where measured. Not of
  // kCurrent: they are in `cost`.
  float* hypothesis_cost;
  // Geometric costs of the distinct depths at [DepthIndex * stride + view].
  float* geom_cost;
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
  Lanes::Sync();
  const float sum = Lanes::Accumulate(views.count, s->cdf);
  // Where no view has a chance, all have the same.
  const bool usable = sum > 0.0f;
  const float scale = usable ? 1.0f / sum : 1.0f / views.count;
  for (int m = Lanes::First(); m < views.count; m += Lanes::Step()) {
    s->cdf[m] = (usable ? s->cdf[m] : m + 1.0f) * scale;
  }
}

// Turns num_drawn, which counts the draws below each step of the distribution,
// into the number of draws of each view. Uses up the distribution.
template <class Lanes>
TAPA_INLINE void CountDraws(const SourceCameras& views, PixelScratch* s) {
  for (int m = Lanes::First(); m < views.count; m += Lanes::Step()) {
    s->cdf[m] = s->num_drawn[m];
  }
  Lanes::Sync();
  for (int m = Lanes::First(); m < views.count; m += Lanes::Step()) {
    s->num_drawn[m] = s->cdf[m] - (m > 0 ? s->cdf[m - 1] : 0.0f);
  }
  Lanes::Sync();
}

// Draws views with replacement. The same draws serve all hypotheses; a view
// drawn k times is measured once and counts k times. Returns the number of
// distinct views, which come first in the order.
template <class Lanes>
TAPA_INLINE int DrawViews(const SweepParams& params, const Random& random,
                          const SourceCameras& views, PixelScratch* s) {
  for (int m = Lanes::First(); m < views.padded_count; m += Lanes::Step()) {
    s->num_drawn[m] = 0.0f;
  }
  for (int first = 0; first < params.num_samples; first += kDrawBlock) {
    const int rest = params.num_samples - first;
    const int count = rest < kDrawBlock ? rest : kDrawBlock;
    for (int i = Lanes::First(); i < count; i += Lanes::Step()) {
      s->uniform[i] = random.Uniform(kDrawSample + first + i);
    }
    Lanes::Sync();
    for (int i = 0; i < count; ++i) {
      const float u = s->uniform[i];
      TAPA_INDEPENDENT_ITERATIONS
      for (int m = Lanes::First(); m < views.padded_count; m += Lanes::Step()) {
        s->num_drawn[m] += u < s->cdf[m] ? 1.0f : 0.0f;
      }
    }
    Lanes::Sync();
  }
  CountDraws<Lanes>(views, s);

  int num_distinct = 0;
  for (int m = Lanes::First(); m < views.count; m += Lanes::Step()) {
    const float drawn = s->num_drawn[m];
    num_distinct += drawn > 0.0f ? 1 : 0;
    int rank = 0;
    for (int k = 0; k < views.count; ++k) {
      const float other = s->num_drawn[k];
      rank += (other > drawn) | ((other == drawn) & (k < m)) ? 1 : 0;
    }
    s->order[rank] = m;
  }
  Lanes::Sync();
  return Lanes::Sum(num_distinct);
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

// Geometric costs of the depths of all hypotheses that have one.
template <class Lanes, class Sources>
TAPA_INLINE void ComputeGeometricCostsOfAll(const SweepParams& params,
                                            const SourceCameras& views,
                                            const Sources& sources, float row,
                                            float col, PixelScratch* s) {
  constexpr Hypothesis kDepths[kNumDepths] = {kCurrent, kPropagated, kRandom,
                                              kFinePlane, kCoarsePlane};
  for (int i = 0; i < kNumDepths; ++i) {
    const float depth = s->plane[kDepths[i]].depth;
    if (depth > 0.0f) {
      ComputeGeometricCosts<Lanes>(params, views, sources, row, col, depth, s,
                                   s->geom_cost + i * s->stride);
    }
  }
  Lanes::Sync();
}

// Weighted geometric costs of hypothesis i, summed over the drawn views.
TAPA_INLINE float SumGeometricCosts(const SweepParams& params,
                                    const CostWeights& weights, int i,
                                    int num_distinct, const PixelScratch& s) {
  if (!params.geometric) {
    return 0.0f;
  }
  const float* geom_cost = s.geom_cost + DepthIndex(i) * s.stride;
  const float weight = weights.geometric * params.geom_weight;
  float sum = 0.0f;
  for (int k = 0; k < num_distinct; ++k) {
    const int m = s.order[k];
    sum += s.num_drawn[m] * weight * geom_cost[m];
  }
  return sum;
}

// The sum so far and the photometric costs of the views at [begin, end) of the
// order.
TAPA_INLINE float AddPhotometricCosts(const CostWeights& weights,
                                      const float* cost, int begin, int end,
                                      float sum, const PixelScratch& s) {
  for (int k = begin; k < end; ++k) {
    const int m = s.order[k];
    sum += s.num_drawn[m] * weights.photometric * cost[m];
  }
  return sum;
}

// A few hypotheses.
struct HypothesisList {
  static_assert(kNumHypotheses <= 8, "there are four bits for each");
  uint32_t items = 0;
  int count = 0;

  TAPA_INLINE void Add(int hypothesis) {
    items |= static_cast<uint32_t>(hypothesis) << (4 * count);
    ++count;
  }
  TAPA_INLINE int At(int i) const { return (items >> (4 * i)) & 15u; }
};

// Measures the photometric costs of the listed hypotheses in the views at
// [begin, end) of the order.
template <class Lanes, class Sources>
TAPA_INLINE void MeasureCosts(const SourceCameras& views, Sources& sources,
                              float row, float col, const HypothesisList& list,
                              int begin, int end, PixelScratch* s) {
  const int count = list.count * (end - begin);
  for (int first = 0; first < count; first += Lanes::kNumGroups) {
    const GroupShare share = ShareOfGroup<Lanes>(first, count);
    const int i = list.At(share.item % list.count);
    const int m = s->order[begin + share.item / list.count];
    const Warp warp = ComputeWarp(views, m, row, col, s->homography[i]);
    const float cost = DecodeCost(EncodeCost(sources.Cost(m, warp)));
    if (share.stores) {
      s->hypothesis_cost[i * s->stride + m] = cost;
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

// Adds up, in s->sum, the costs of hypotheses [first, last) over the drawn
// views. Costs are not negative, so a sum only grows: once it exceeds `limit`
// the hypothesis cannot win any more, and the rest of its views is not
// measured.
template <class Lanes, class Sources>
TAPA_INLINE void SumCosts(const SweepParams& params, const RefCamera& camera,
                          const SourceCameras& views, Sources& sources,
                          float row, float col, const Vec3& ray, int first,
                          int last, const TextureWeights& weights, float limit,
                          int num_distinct, PixelScratch* s) {
  for (int i = first + Lanes::First(); i < last; i += Lanes::Step()) {
    s->homography[i] = HomographyVector(camera, s->plane[i], ray);
    s->sum[i] = IsVisible(s->plane[i], ray)
                    ? SumGeometricCosts(params, WeightsOf(weights, i), i,
                                        num_distinct, *s)
                    : INFINITY;
  }
  int begin = 0;
  while (true) {
    Lanes::Sync();
    HypothesisList running;
    for (int i = first; i < last; ++i) {
      if (s->sum[i] <= limit) {
        running.Add(i);
      }
    }
    if (running.count == 0 || begin == num_distinct) {
      return;
    }
    const int next = begin + Lanes::NumViewsAtOnce(running.count);
    const int end = next < num_distinct ? next : num_distinct;
    MeasureCosts<Lanes>(views, sources, row, col, running, begin, end, s);
    for (int n = Lanes::First(); n < running.count; n += Lanes::Step()) {
      const int i = running.At(n);
      s->sum[i] = AddPhotometricCosts(WeightsOf(weights, i),
                                      s->hypothesis_cost + i * s->stride, begin,
                                      end, s->sum[i], *s);
    }
    begin = end;
  }
}

// The hypothesis of the smallest cost.
template <class Lanes, class Sources>
TAPA_INLINE int ChooseHypothesis(const SweepParams& params,
                                 const RefCamera& camera,
                                 const SourceCameras& views, Sources& sources,
                                 float row, float col, const Vec3& ray,
                                 const TextureWeights& weights,
                                 int num_distinct, PixelScratch* s) {
  int best = kCurrent;
  // Added up like those of the other hypotheses, so that equal costs are equal.
  float best_cost = AddPhotometricCosts(
      weights.own, s->cost, 0, num_distinct,
      SumGeometricCosts(params, weights.own, kCurrent, num_distinct, *s), *s);
  for (int first = kCurrent + 1; first < kNumHypotheses;
       first += Lanes::kNumSideBySide) {
    const int end = first + Lanes::kNumSideBySide;
    const int last = end < kNumHypotheses ? end : +kNumHypotheses;
    SumCosts<Lanes>(params, camera, views, sources, row, col, ray, first, last,
                    weights, best_cost, num_distinct, s);
    for (int i = first; i < last; ++i) {
      if (s->sum[i] <= best_cost) {
        best = i;
        best_cost = s->sum[i];
      }
    }
  }
  return best;
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
    sources->SetConsistent(m, consistent);
    num_consistent += consistent ? 1 : 0;
  }
  return Lanes::Sum(num_consistent);
}

// The planes of all hypotheses. What is no hypothesis has no visible plane.
TAPA_INLINE void MakeHypotheses(const SweepParams& params, const Random& random,
                                const Plane& current, const Plane& previous,
                                const Vec3& previous_ray, const Vec3& ray,
                                const PixelGuide& guide, Plane* planes) {
  const float random_depth =
      PerturbDepth(random, params.perturbation, current.depth);
  const Vec3 random_normal =
      PerturbNormal(random, params.perturbation, current.normal, ray);
  planes[kCurrent] = current;
  planes[kPropagated] = {PropagateDepth(previous, previous_ray, ray),
                         previous.normal};
  planes[kRandom] = {random_depth, random_normal};
  planes[kRandomNormal] = {current.depth, random_normal};
  planes[kRandomDepth] = {random_depth, current.normal};
  planes[kFinePlane] = guide.fine;
  planes[kCoarsePlane] = guide.coarse;
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

#endif  // TAPA_SRC_MVS_SWEEP_SWEEP_H_
