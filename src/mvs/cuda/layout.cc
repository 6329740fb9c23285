#include "src/mvs/cuda/layout.h"

namespace tapa {

WindowShape WindowShape::FromOptions(const Options& options) {
  WindowShape shape;
  shape.radius = options.window_radius;
  shape.step = options.window_step;
  shape.row_samples = 2 * shape.radius / shape.step + 1;
  const double sigma_spatial =
      options.sigma_spatial > 0 ? options.sigma_spatial : shape.radius;
  const double sigma_color = 255 * options.sigma_color;
  shape.color_scale = static_cast<float>(-0.5 / (sigma_color * sigma_color));
  shape.spatial_scale =
      static_cast<float>(-0.5 / (sigma_spatial * sigma_spatial));
  return shape;
}

}  // namespace tapa
