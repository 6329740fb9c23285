#ifndef TAPA_SRC_MVS_SWEEP_HYPOTHESES_H_
#define TAPA_SRC_MVS_SWEEP_HYPOTHESES_H_

#include <cmath>
#include <cstdint>

#include "src/base/angle.h"
#include "src/mvs/sweep/math.h"
#include "src/mvs/sweep/pixel_context.h"
#include "src/mvs/sweep/random.h"

namespace tapa {

// Hypotheses of a pixel, see docs/design.md. The smallest cost wins; of equal
// ones the later.
enum Hypothesis {
  kCurrent,
  kPropagated,
  kRandom,
  kRandomNormal,
  kRandomDepth,
  // From outside the sweep: depth from elsewhere, and planes of a fine and a
  // coarse superpixel.
  kDepthPrior,
  kFinePlane,
  kCoarsePlane,
  kNumHypotheses
};

// Distinct depths among the hypotheses: current, propagated, random, and those
// from outside.
constexpr int kNumDepths = 6;

// Which of them a hypothesis has.
TAPA_INLINE int DepthIndex(int hypothesis) {
  return hypothesis == kPropagated                             ? 1
         : hypothesis == kRandom || hypothesis == kRandomDepth ? 2
         : hypothesis == kDepthPrior                           ? 3
         : hypothesis == kFinePlane                            ? 4
         : hypothesis == kCoarsePlane                          ? 5
                                                               : 0;
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

// Uniform in [min_depth, max_depth).
TAPA_INLINE float RandomDepth(const Random& random, float min_depth,
                              float max_depth) {
  return min_depth + random.Uniform(kDrawDepth) * (max_depth - min_depth);
}

// Uniform on the hemisphere of normals that face the camera.
inline Vec3 RandomNormal(const Random& random, const Vec3& ray) {
  const float z = 2.0f * random.Uniform(kDrawNormal) - 1.0f;
  const float angle =
      2.0f * static_cast<float>(kPi) * random.Uniform(kDrawNormal + 1);
  const float radius = std::sqrt(1.0f - z * z);
  const Vec3 normal = {radius * std::cos(angle), radius * std::sin(angle), z};
  return Dot(normal, ray) > 0.0f ? -normal : normal;
}

// Depth changed by at most the share `perturbation` of it.
TAPA_INLINE float PerturbDepth(const Random& random, float perturbation,
                               float depth) {
  return RandomDepth(random, (1.0f - perturbation) * depth,
                     (1.0f + perturbation) * depth);
}

// Normal rotated about the three axes by at most perturbation / 2 radians each
// (perturbation at most 1). Where the result would face away from the camera,
// tries again with half the angles, in the end keeps the normal.
TAPA_INLINE Vec3 PerturbNormal(const Random& random, float perturbation,
                               const Vec3& normal, const Vec3& ray) {
  constexpr int kMaxNormalTrials = 4;
  for (int trial = 0; trial < kMaxNormalTrials; ++trial) {
    float s[3];
    float c[3];
    for (int axis = 0; axis < 3; ++axis) {
      const float angle =
          (random.Uniform(kDrawNormal + 3 * trial + axis) - 0.5f) *
          perturbation;
      SinCosSmall(angle, &s[axis], &c[axis]);
    }
    // Rx Ry Rz n, one rotation after the other.
    const Vec3 z = {c[2] * normal.x - s[2] * normal.y,
                    s[2] * normal.x + c[2] * normal.y, normal.z};
    const Vec3 y = {c[1] * z.x + s[1] * z.z, z.y, c[1] * z.z - s[1] * z.x};
    const Vec3 x = {y.x, c[0] * y.y - s[0] * y.z, s[0] * y.y + c[0] * y.z};
    if (Dot(x, ray) < 0.0f) {
      return (1.0f / sqrtf(Dot(x, x))) * x;
    }
    perturbation *= 0.5f;
  }
  return normal;
}

// Whether a hypothesis can be true: in front of the camera, and facing it.
TAPA_INLINE bool IsVisible(const DepthNormal& hypothesis, const Vec3& ray) {
  return hypothesis.depth > 0.0f && Dot(hypothesis.normal, ray) < 0.0f;
}

// Which of the random hypotheses a pixel tries in this sweep: one of the three
// or, but for the share `share` of sweeps, none, which is kCurrent.
TAPA_INLINE int DrawRandomHypothesis(const Random& random, float share) {
  const float draw = random.Uniform(kDrawHypothesis);
  return draw < share ? kRandom + static_cast<int>(3 * draw / share) : kCurrent;
}

// Whether two estimates of a pixel are the same in all that can be measured:
// within a window they differ by a few hundredths of a pixel.
TAPA_INLINE bool IsSame(const DepthNormal& a, const DepthNormal& b) {
  constexpr float kMaxDepthChange = 1e-4f;
  constexpr float kMaxNormalChange = 1e-2f;
  const Vec3 difference = a.normal - b.normal;
  return fabsf(a.depth - b.depth) <= kMaxDepthChange * b.depth &&
         Dot(difference, difference) <= kMaxNormalChange * kMaxNormalChange;
}

// All hypotheses. What is none is not visible.
// drawn_cost: photometric cost of the current estimate, mean of the draws.
TAPA_INLINE void MakeHypotheses(const PixelContext& p,
                                const PreviousPixel& previous, float drawn_cost,
                                DepthNormal* hypotheses) {
  // NCC 0.5: what is not seen in the views is looked for farther away, such as
  // what a coarser level was too coarse for.
  constexpr float kLostCost = 0.5f;
  const float perturbation = drawn_cost > kLostCost ? p.params.lost_perturbation
                                                    : p.params.perturbation;
  const int drawn = DrawRandomHypothesis(p.random, p.params.random_share);
  const bool both = p.params.try_all || drawn == kRandom;
  const bool depth_alone = p.params.try_all || drawn == kRandomDepth;
  const bool normal_alone = p.params.try_all || drawn == kRandomNormal;
  const float random_depth =
      both || depth_alone
          ? PerturbDepth(p.random, perturbation, p.current.depth)
          : 0.0f;
  // A normal of zero faces nobody: such a hypothesis only lends its depth.
  const Vec3 random_normal =
      both || normal_alone
          ? PerturbNormal(p.random, perturbation, p.current.normal, p.ray)
          : Vec3();
  hypotheses[kCurrent] = p.current;
  DepthNormal& propagated = hypotheses[kPropagated];
  propagated = {PropagateDepth(previous.estimate, previous.ray, p.ray),
                previous.estimate.normal};
  if (!p.params.try_all && IsSame(propagated, p.current)) {
    propagated = DepthNormal();
  }
  hypotheses[kRandom] = {random_depth, both ? random_normal : Vec3()};
  hypotheses[kRandomNormal] = {p.current.depth,
                               normal_alone ? random_normal : Vec3()};
  hypotheses[kRandomDepth] = {random_depth,
                              depth_alone ? p.current.normal : Vec3()};
  hypotheses[kDepthPrior] = p.guide.depth_prior;
  hypotheses[kFinePlane] = p.guide.fine;
  hypotheses[kCoarsePlane] = p.guide.coarse;
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_HYPOTHESES_H_
