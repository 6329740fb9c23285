#include "src/mvs/cpu/window.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace tapa {
namespace {

// Widest vector of any supported processor, in floats.
constexpr int kMaxLanes = 16;

int Padded(int num_samples) {
  return (num_samples + kMaxLanes - 1) / kMaxLanes * kMaxLanes;
}

struct Offset {
  int x, y;
};

std::vector<Offset> SampleOffsets(const WindowShape& window) {
  std::vector<Offset> offsets;
  for (int i = 0; i < window.NumSamples(); ++i) {
    const int place = window.PlaceOfSample(i);
    offsets.push_back(
        {place % window.row_samples * window.step - window.radius,
         place / window.row_samples * window.step - window.radius});
  }
  return offsets;
}

}  // namespace

Window::Window(const Options& options) : WindowShape(options) {
  num_samples = NumSamples();
  padded_samples = Padded(num_samples);
  dx = MakeAligned<float>(padded_samples);
  dy = MakeAligned<float>(padded_samples);
  spatial_weight = MakeAligned<float>(padded_samples);
  textured_weight = MakeAligned<float>(padded_samples);
  color_weight = MakeAligned<float>(256);

  std::vector<Offset> offsets = SampleOffsets(*this);
  const auto is_near = [this](const Offset& o) { return IsNear(o.x, o.y); };
  const auto first_far =
      std::stable_partition(offsets.begin(), offsets.end(), is_near);
  padded_near_samples = Padded(static_cast<int>(first_far - offsets.begin()));
  for (int i = 0; i < num_samples; ++i) {
    const Offset& o = offsets[i];
    dx[i] = static_cast<float>(o.x);
    dy[i] = static_cast<float>(o.y);
    const double squared_distance = o.x * o.x + o.y * o.y;
    spatial_weight[i] =
        static_cast<float>(std::exp(spatial_scale * squared_distance));
    if (is_near(o)) {
      textured_weight[i] =
          static_cast<float>(std::exp(textured_scale * squared_distance));
    }
  }
  for (int difference = 0; difference < 256; ++difference) {
    const double d = difference / 255.0 / sigma_color;
    color_weight[difference] = static_cast<float>(std::exp(-0.5 * d * d));
  }
}

Patch::Patch(const Window& window)
    : weight(MakeAligned<float>(window.padded_samples)),
      weighted_intensity(MakeAligned<float>(window.padded_samples)),
      padded_samples(window.padded_samples),
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
