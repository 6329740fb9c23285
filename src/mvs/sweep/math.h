#ifndef TAPA_SRC_MVS_SWEEP_MATH_H_
#define TAPA_SRC_MVS_SWEEP_MATH_H_

#include <cmath>
#include <cstdint>
#include <cstring>

#include "src/mvs/sweep/host_device.h"

namespace tapa {

// e^x for x <= 0 with a relative error below 3e-7, 0 below -87. Unlike
// std::exp, a loop over it can be vectorized.
TAPA_INLINE float ExpNegative(float x) {
#if defined(TAPA_ON_DEVICE)
  return __expf(x);
#else
  // e^x = 2^n e^r with |r| <= ln(2) / 2. Adding 1.5 * 2^23 rounds to integer.
  constexpr float kRound = 12582912.0f;
  const float clamped = x > -87.0f ? x : -87.0f;
  const float n = (clamped * 1.44269504f + kRound) - kRound;
  const float r = (clamped - n * 0.693359375f) + n * 2.12194440e-4f;
  float p = 1.0f / 720.0f;
  p = p * r + 1.0f / 120.0f;
  p = p * r + 1.0f / 24.0f;
  p = p * r + 1.0f / 6.0f;
  p = p * r + 0.5f;
  p = p * r + 1.0f;
  p = p * r + 1.0f;
  const int32_t bits = (static_cast<int32_t>(n) + 127) << 23;
  float power;
  std::memcpy(&power, &bits, sizeof(power));
  return x > -87.0f ? p * power : 0.0f;
#endif
}

// 1 / x, on a GPU with an error of one unit in the last place, and without
// denormals, which take five instructions more.
TAPA_INLINE float Reciprocal(float x) {
#if defined(__CUDA_ARCH__)
  float result;
  asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(result) : "f"(x));
  return result;
#else
  return 1.0f / x;
#endif
}

// Sine and cosine of an angle in [-0.5, 0.5], in radians, to float precision.
TAPA_INLINE void SinCosSmall(float a, float* sin_a, float* cos_a) {
  const float s = a * a;
  *sin_a = a * (1.0f - s * (1.0f / 6 - s * (1.0f / 120 - s * (1.0f / 5040))));
  *cos_a =
      1.0f - s * (0.5f - s * (1.0f / 24 - s * (1.0f / 720 - s / 40320.0f)));
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_MATH_H_
