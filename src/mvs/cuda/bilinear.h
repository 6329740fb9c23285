#ifndef TAPA_SRC_MVS_CUDA_BILINEAR_H_
#define TAPA_SRC_MVS_CUDA_BILINEAR_H_

#include <cmath>

#include "src/mvs/sweep/host_device.h"

namespace tapa {

// Bilinear sample at (x, y), pixel centres being at integers plus one half,
// from pixel(col, row). Not kPrecise: fractions are rounded to 8 bits, as a
// GPU's texture units do.
template <bool kPrecise, class PixelAt>
TAPA_INLINE float BilinearSample(float x, float y, const PixelAt& pixel) {
  const float left = floorf(x - 0.5f);
  const float top = floorf(y - 0.5f);
  float fx = x - 0.5f - left;
  float fy = y - 0.5f - top;
  if (!kPrecise) {
    fx = floorf(fx * 256.0f + 0.5f) * (1.0f / 256.0f);
    fy = floorf(fy * 256.0f + 0.5f) * (1.0f / 256.0f);
  }
  const int col = static_cast<int>(left);
  const int row = static_cast<int>(top);
  const float top_left = pixel(col, row);
  const float bottom_left = pixel(col, row + 1);
  const float upper = top_left + fx * (pixel(col + 1, row) - top_left);
  const float lower =
      bottom_left + fx * (pixel(col + 1, row + 1) - bottom_left);
  return upper + fy * (lower - upper);
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CUDA_BILINEAR_H_
