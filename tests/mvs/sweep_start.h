#ifndef TAPA_TESTS_MVS_SWEEP_START_H_
#define TAPA_TESTS_MVS_SWEEP_START_H_

#include <random>
#include <vector>

#include "src/mvs/cpu/problem_data.h"
#include "tests/mvs/synthetic.h"

namespace tapa {

// What tests of single sweeps start with.

// The plane of this depth on the optical axis.
Plane PlaneThrough(float depth, const Vec3& normal);

// Every pixel draws one of them or, at times, none.
PlaneSet DrawAtRandom(const std::vector<Plane>& planes, int width, int height,
                      std::mt19937* random);

// Planes near the truth and far from it, out of the range of depths and turned
// away, and a prior near the truth and off it.
GuideMaps MakeGuide(const SyntheticPlane& scene, std::mt19937* random);

struct Start {
  Map<float> depth;
  Map<Vec3> normal;
};

// Half of the pixels near the truth, so that propagation has something to
// spread.
Start StartNearTruth(const SyntheticPlane& scene);

}  // namespace tapa

#endif  // TAPA_TESTS_MVS_SWEEP_START_H_
