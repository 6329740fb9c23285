#include "src/mvs/cpu/window.h"

#include <cmath>
#include <cstring>

namespace tapa {
namespace {

// Widest vector of any supported processor, in floats.
constexpr int kMaxLanes = 16;

}  // namespace

Window::Window(const Options& options) : WindowShape(options) {
  num_samples = NumSamples();
  padded_samples = (num_samples + kMaxLanes - 1) / kMaxLanes * kMaxLanes;
  dx = MakeAligned<float>(padded_samples);
  dy = MakeAligned<float>(padded_samples);
  spatial_weight = MakeAligned<float>(padded_samples);
  textured_weight = MakeAligned<float>(padded_samples);
  color_weight = MakeAligned<float>(256);

  for (int i = 0; i < num_samples; ++i) {
    const int place = PlaceOfSample(i);
    const int x = place % row_samples * step - radius;
    const int y = place / row_samples * step - radius;
    dx[i] = static_cast<float>(x);
    dy[i] = static_cast<float>(y);
    const double squared_distance = x * x + y * y;
    spatial_weight[i] =
        static_cast<float>(std::exp(spatial_scale * squared_distance));
    textured_weight[i] =
        static_cast<float>(std::exp(textured_scale * squared_distance));
  }
  for (int difference = 0; difference < 256; ++difference) {
    const double d = difference / 255.0 / sigma_color;
    color_weight[difference] = static_cast<float>(std::exp(-0.5 * d * d));
  }
}

Patch::Patch(const Window& window)
    : weight(MakeAligned<float>(window.padded_samples)),
      weighted_intensity(MakeAligned<float>(window.padded_samples)),
      mean(0),
      variance(0) {}

RefImage::RefImage(const Map<uint8_t>& image, const Window& window)
    : border_(window.radius),
      padded_(image.width() + 2 * border_, image.height() + 2 * border_ + 1, 0),
      offsets_(MakeAligned<int32_t>(window.padded_samples)) {
  for (int row = 0; row < image.height(); ++row) {
    std::memcpy(padded_.Row(row + border_) + border_, image.Row(row),
                image.width());
  }
  for (int i = 0; i < window.num_samples; ++i) {
    offsets_[i] = static_cast<int32_t>(window.dy[i]) * stride() +
                  static_cast<int32_t>(window.dx[i]);
  }
}

}  // namespace tapa
