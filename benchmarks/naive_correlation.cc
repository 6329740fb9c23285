#include "benchmarks/naive_correlation.h"

#include <algorithm>
#include <cmath>

namespace tapa {
namespace {

float Pixel(const Map<uint8_t>& image, int row, int col) {
  const bool inside =
      row >= 0 && col >= 0 && row < image.height() && col < image.width();
  return inside ? image.At(row, col) : 0.0f;
}

float Bilinear(const Map<uint8_t>& image, float x, float y) {
  if (!(x > -1 && y > -1 && x < image.width() && y < image.height())) {
    return 0;
  }
  const float left = std::floor(x);
  const float top = std::floor(y);
  const int col = static_cast<int>(left);
  const int row = static_cast<int>(top);
  const float fx = x - left;
  const float fy = y - top;
  return (1 - fy) * ((1 - fx) * Pixel(image, row, col) +
                     fx * Pixel(image, row, col + 1)) +
         fy * ((1 - fx) * Pixel(image, row + 1, col) +
               fx * Pixel(image, row + 1, col + 1));
}

}  // namespace

float NaiveCorrelationCost(const Window& window, const Patch& patch,
                           const Map<uint8_t>& source, const Warp& warp) {
  constexpr float kMinVariance = 1e-5f * 255 * 255;
  float sum = 0;
  float squared_sum = 0;
  float product_sum = 0;
  const int num_samples = std::min(window.num_samples, patch.padded_samples);
  for (int i = 0; i < num_samples; ++i) {
    const Vec3 p = warp.At(window.dx[i], window.dy[i]);
    const float value =
        (p.z > 0 ? Bilinear(source, p.x / p.z, p.y / p.z) : 0) - patch.mean;
    sum += patch.weight[i] * value;
    squared_sum += patch.weight[i] * value * value;
    product_sum += patch.weighted_intensity[i] * value;
  }
  const float variance = squared_sum - sum * sum;
  if (patch.variance < kMinVariance || variance < kMinVariance) {
    return 2;
  }
  return std::clamp(1 - product_sum / std::sqrt(patch.variance * variance),
                    0.0f, 2.0f);
}

}  // namespace tapa
