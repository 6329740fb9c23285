#ifndef TAPA_SRC_MVS_SWEEP_VIEW_SELECTION_H_
#define TAPA_SRC_MVS_SWEEP_VIEW_SELECTION_H_

#include <cmath>
#include <cstdint>

#include "src/base/angle.h"
#include "src/mvs/sweep/math.h"

namespace tapa {

// Per-pixel selection of source views: for every view a hidden Markov chain
// along the sweep's line says whether the view sees the pixel (Schoenberger et
// al., ECCV 2016, sections 3 and 4.1).
struct ViewSelection {
  // Probability of a cost where the view does not see the pixel.
  static constexpr float kUniform = 0.5f;
  // Probability that visibility changes from one pixel to the next.
  static constexpr float kChange = 1e-5f;
  static constexpr float kNoChange = 1.0f - kChange;
  // Message before the first and after the last pixel of a line: even odds.
  static constexpr float kBorderMessage = 1.0f;

  // Factors of the likelihood norm * exp(scale * cost^2).
  float scale = 0;
  float norm = 0;

  static ViewSelection FromSigma(double ncc_sigma) {
    ViewSelection selection;
    selection.scale = static_cast<float>(-0.5 / (ncc_sigma * ncc_sigma));
    selection.norm = static_cast<float>(
        2.0 / (std::sqrt(2.0 * kPi) * ncc_sigma *
               std::erf(2.0 / (ncc_sigma * std::sqrt(2.0)))));
    return selection;
  }

  // Likelihood of a photometric cost (1 - NCC, 0 to 2) where the view sees the
  // pixel. The paper's N cancels out.
  TAPA_INLINE float Emission(float cost) const {
    return norm * ExpNegative(scale * cost * cost);
  }

  // Messages and their product are kept as odds p / (1 - p): they come close to
  // 1, where 1 - p would lose all its digits in single precision.

  // Message from the pixels before to this one, given the message `previous`
  // that the pixel before received.
  TAPA_INLINE static float Forward(float emission, float previous) {
    return emission * (previous * kNoChange + kChange) /
           (kUniform * (previous * kChange + kNoChange));
  }

  // Message from the pixels after, this one's emission included.
  TAPA_INLINE static float Backward(float emission, float next) {
    const float seen = next * emission;
    return (seen * kNoChange + kUniform * kChange) /
           (seen * kChange + kUniform * kNoChange);
  }

  // Probability that the view sees the pixel. `previous` is the probability
  // from the sweep before, which counts with `previous_weight`.
  TAPA_INLINE static float Probability(float forward, float backward,
                                       float previous, float previous_weight) {
    const float odds = forward * backward;
    return previous_weight * previous +
           (1.0f - previous_weight) * (odds / (1.0f + odds));
  }
};

// Costs (0 to 2) and probabilities (0 to 1) are kept as 16-bit fixed point; the
// ends of both ranges are exact. A fresh cost is rounded the same way before it
// is compared, so that equal costs stay equal.
constexpr float kMaxCost = 2.0f;

TAPA_INLINE uint16_t EncodeCost(float cost) {
  return static_cast<uint16_t>(
      static_cast<int32_t>(cost * (65535.0f / kMaxCost) + 0.5f));
}

TAPA_INLINE float DecodeCost(uint16_t code) {
  return static_cast<float>(static_cast<int32_t>(code)) * (kMaxCost / 65535.0f);
}

TAPA_INLINE uint16_t EncodeProb(float prob) {
  return static_cast<uint16_t>(static_cast<int32_t>(prob * 65535.0f + 0.5f));
}

TAPA_INLINE float DecodeProb(uint16_t code) {
  return static_cast<float>(static_cast<int32_t>(code)) * (1.0f / 65535.0f);
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_VIEW_SELECTION_H_
