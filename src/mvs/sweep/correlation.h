#ifndef TAPA_SRC_MVS_SWEEP_CORRELATION_H_
#define TAPA_SRC_MVS_SWEEP_CORRELATION_H_

#include <cmath>

#include "src/mvs/sweep/host_device.h"
#include "src/mvs/sweep/view_selection.h"

namespace tapa {

// Variance (of intensities 0 to 255) below which a patch cannot be correlated.
constexpr float kMinVariance = 1e-5f * 255.0f * 255.0f;

// Sums over the window's samples, weighted with weights that sum up to 1: of
// the source image's intensity less the reference patch's mean, of its square,
// and of its product with the centred reference.
struct Moments {
  float sum;
  float squared_sum;
  float product_sum;
};

// 1 - NCC, 0 to 2; 2 where either patch has too little texture to tell.
TAPA_INLINE float CostOfMoments(float reference_variance,
                                const Moments& moments) {
  const float variance = moments.squared_sum - moments.sum * moments.sum;
  if (!(reference_variance >= kMinVariance) || !(variance >= kMinVariance)) {
    return kMaxCost;
  }
  const float cost =
      1.0f - moments.product_sum / sqrtf(reference_variance * variance);
  return cost < 0.0f ? 0.0f : cost > kMaxCost ? kMaxCost : cost;
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_CORRELATION_H_
