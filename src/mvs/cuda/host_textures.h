#ifndef TAPA_SRC_MVS_CUDA_HOST_TEXTURES_H_
#define TAPA_SRC_MVS_CUDA_HOST_TEXTURES_H_

#include <cmath>

#include "src/mvs/cuda/bilinear.h"
#include "src/mvs/estimate_depth.h"

namespace tapa {

// Textures (see patch.h) on the host, for tests: as a GPU's units filter them,
// with fractions of 8 bits, or precisely.
template <bool kPrecise>
class HostTextures {
 public:
  // Borrows the problem's images.
  explicit HostTextures(const Problem& problem) : problem_(problem) {}

  float Reference(int col, int row) const {
    return Pixel(*problem_.reference.image, col, row);
  }

  float Source(int m, float x, float y) const {
    // Far away, or not a number: black, as on a device.
    constexpr float kFar = 1e6f;
    if (!(std::abs(x) < kFar && std::abs(y) < kFar)) {
      return 0.0f;
    }
    const Map<uint8_t>& image = *problem_.sources[m].image;
    return BilinearSample<kPrecise>(
        x, y, [&](int col, int row) { return Pixel(image, col, row); });
  }

  float SourceDepth(int m, float x, float y) const {
    constexpr float kFar = 1e6f;
    if (!(std::abs(x) < kFar && std::abs(y) < kFar)) {
      return 0.0f;
    }
    return Pixel(*problem_.sources[m].depth, static_cast<int>(std::floor(x)),
                 static_cast<int>(std::floor(y)));
  }

 private:
  template <typename T>
  static float Pixel(const Map<T>& map, int col, int row) {
    const bool inside =
        col >= 0 && row >= 0 && col < map.width() && row < map.height();
    return inside ? static_cast<float>(map.At(row, col)) : 0.0f;
  }

  const Problem& problem_;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CUDA_HOST_TEXTURES_H_
