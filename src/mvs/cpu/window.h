#ifndef TAPA_SRC_MVS_CPU_WINDOW_H_
#define TAPA_SRC_MVS_CPU_WINDOW_H_

#include <cstdint>

#include "src/base/map.h"
#include "src/mvs/cpu/aligned.h"
#include "src/mvs/window_shape.h"

namespace tapa {

// The samples of the correlation window, the near ones first and both row by
// row, padded to whole SIMD vectors with samples of weight 0.
struct Window : WindowShape {
  explicit Window(const Options& options);

  // Samples in the window, and with padding.
  int num_samples;
  int padded_samples;
  // So many from the first on hold all that are near, in whole SIMD vectors.
  int padded_near_samples;
  // Offsets of the samples from the centre, in pixels.
  hwy::AlignedFreeUniquePtr<float[]> dx;
  hwy::AlignedFreeUniquePtr<float[]> dy;
  // The factor of the weight for a sample's distance from the centre (0 in the
  // padding), without texture and with, and the one for a difference in
  // intensity of 0 to 255.
  hwy::AlignedFreeUniquePtr<float[]> spatial_weight;
  hwy::AlignedFreeUniquePtr<float[]> textured_weight;
  hwy::AlignedFreeUniquePtr<float[]> color_weight;
};

// The reference patch around one pixel with its weights, which sum up to 1.
// Intensities are 0 to 255 here.
struct Patch {
  explicit Patch(const Window& window);

  // Weight of each sample, and weight times (intensity - mean).
  hwy::AlignedFreeUniquePtr<float[]> weight;
  hwy::AlignedFreeUniquePtr<float[]> weighted_intensity;
  // How many of the window's samples these are: all that count.
  int padded_samples;
  float mean;
  float variance;
};

// Reference image with a black border as wide as the window's radius, and one
// row more, for what vectors read past a pixel.
class RefImage {
 public:
  RefImage(const Map<uint8_t>& image, const Window& window);

  // Pointer to the pixel, around which the whole window can be read.
  const uint8_t* At(int row, int col) const {
    return padded_.data() + static_cast<size_t>(row + border_) * stride() +
           col + border_;
  }
  // Where the window's samples lie, in pixels from the one in its centre; 0 in
  // the padding.
  const int32_t* offsets() const { return offsets_.get(); }

 private:
  int stride() const { return padded_.width(); }

  int border_;
  Map<uint8_t> padded_;
  hwy::AlignedFreeUniquePtr<int32_t[]> offsets_;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CPU_WINDOW_H_
