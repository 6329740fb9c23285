#ifndef TAPA_SRC_MVS_WINDOW_SHAPE_H_
#define TAPA_SRC_MVS_WINDOW_SHAPE_H_

#include "src/mvs/options.h"
#include "src/mvs/sweep/host_device.h"

namespace tapa {

// The correlation window and its weights: that of a sample for its distance
// from the centre times that for its difference in intensity from it. The first
// falls off with sigma_spatial where there is no texture, and where there is
// enough with sigma_textured. The share of the latter is
//
//   min(1, Var / kTexture),
//
// with the variance of intensities, 0 to 1, under the weights of sigma_textured
// alone. A surface that shows little needs a large window, others are told
// apart better by a small one (Kanade and Okutomi, "A Stereo Matching Algorithm
// with an Adaptive Window", PAMI 1994). Where sigma_textured is the smaller of
// the two, its weights end at twice that, but not within 3 pixels, so that
// sparse windows keep 16 samples. Where the share is 1 the samples further away
// weigh nothing, and the CPU does not look at them.
struct WindowShape {
  WindowShape() = default;
  explicit WindowShape(const Options& options);

  // In pixels, as in the options.
  int radius = 5;
  int step = 1;
  // Samples in a row and in a column.
  int row_samples = 11;
  // Sparse windows go without their corners, the samples that are farthest
  // away: of 36 samples 32 are left, a whole number of SIMD vectors.
  bool has_corners = true;
  // Standard deviations of the weights: over distance in pixels, and over
  // difference in intensity (0 to 1).
  double sigma_spatial = 5;
  double sigma_textured = 5;
  double sigma_color = 0.2;
  // How far samples are from the centre, in rows or columns, that count however
  // much texture there is.
  int near_radius = 5;
  // For kernels, factors in the exponent of the weight: of the squared distance
  // in pixels and of the squared difference in intensity (0 to 255).
  float spatial_scale = 0;
  float textured_scale = 0;
  float color_scale = 0;

  // Share of sigma_textured. variance: of intensities of 0 to 255.
  static TAPA_INLINE float Texture(float variance) {
    // A standard deviation of 5.7 grey levels: e / t_min of TapaOptions.
    constexpr float kTexture = 0.0005f * 255 * 255;
    return variance < kTexture ? variance / kTexture : 1.0f;
  }

  // Of a sample's distance from the centre, in columns and rows.
  TAPA_INLINE bool IsNear(int dx, int dy) const {
    return dx <= near_radius && -dx <= near_radius && dy <= near_radius &&
           -dy <= near_radius;
  }

  // Samples are numbered row by row, without the corners that are missing.
  TAPA_INLINE int NumSamples() const {
    return row_samples * row_samples - (has_corners ? 0 : 4);
  }
  // Of a sample its place among row_samples * row_samples.
  TAPA_INLINE int PlaceOfSample(int i) const {
    const int before_last_row = row_samples * (row_samples - 1) - 2;
    return has_corners           ? i
           : i < row_samples - 2 ? i + 1
           : i < before_last_row ? i + 2
                                 : i + 3;
  }
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_WINDOW_SHAPE_H_
