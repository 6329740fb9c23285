#ifndef TAPA_SRC_MVS_SWEEP_RANDOM_H_
#define TAPA_SRC_MVS_SWEEP_RANDOM_H_

#include <cstdint>

#include "src/mvs/sweep/host_device.h"

namespace tapa {

// Random numbers as a function of (seed, pixel, sweep, draw). There is no state
// to carry along, so results depend neither on the number of threads nor on the
// backend. The mixer is the finalizer of SplitMix64 (Steele et al., "Fast
// Splittable Pseudorandom Number Generators", OOPSLA 2014).
class Random {
 public:
  TAPA_INLINE Random(uint64_t seed, uint64_t pixel, uint32_t sweep)
      : key_(Mix(Mix(seed + kGamma * (sweep + 1)) + kGamma * (pixel + 1))) {}

  // Uniform in [0, 1), different for every draw.
  TAPA_INLINE float Uniform(uint32_t draw) const {
    return static_cast<float>(
               static_cast<int32_t>(Mix(key_ + kGamma * (draw + 1)) >> 40)) *
           (1.0f / 16777216.0f);
  }

 private:
  static constexpr uint64_t kGamma = 0x9E3779B97F4A7C15ull;

  static TAPA_INLINE uint64_t Mix(uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }

  uint64_t key_;
};

// What a draw is used for. Every purpose has numbers of its own, so that adding
// a draw to one does not change the others.
enum Draw : uint32_t {
  kDrawDepth = 0,
  // Up to kMaxNormalTrials trials of three numbers.
  kDrawNormal = 1,
  kDrawHypothesis = 60,
  // One for every sampled source view.
  kDrawSample = 64,
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_RANDOM_H_
