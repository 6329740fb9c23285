#include "src/mvs/window_shape.h"

#include <algorithm>

namespace tapa {

WindowShape::WindowShape(const Options& options)
    : radius(options.window_radius),
      step(options.window_step),
      row_samples(2 * radius / step + 1),
      has_corners(step == 1 || row_samples < 4),
      // Sparse windows may have no sample in their centre: with a smaller
      // spread none would weigh anything.
      sigma_spatial(options.sigma_spatial > 0
                        ? std::max(options.sigma_spatial, 0.5)
                        : radius),
      sigma_textured(
          options.search.sigma_textured > 0
              ? std::min(options.search.sigma_textured, sigma_spatial)
              : sigma_spatial),
      sigma_color(options.sigma_color),
      near_radius(sigma_textured < sigma_spatial
                      ? static_cast<int>(std::min<double>(
                            std::max(2 * sigma_textured, 3.0), radius))
                      : radius) {
  const double sigma_intensity = 255 * sigma_color;
  spatial_scale = static_cast<float>(-0.5 / (sigma_spatial * sigma_spatial));
  textured_scale = static_cast<float>(-0.5 / (sigma_textured * sigma_textured));
  color_scale = static_cast<float>(-0.5 / (sigma_intensity * sigma_intensity));
}

}  // namespace tapa
