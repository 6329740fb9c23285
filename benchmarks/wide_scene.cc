#include "benchmarks/wide_scene.h"

#include <cmath>
#include <random>

namespace tapa {
namespace {

constexpr int kTile = 1024;

// Noise with detail of 4 pixels and more, repeated endlessly.
Map<uint8_t> MakeTile() {
  constexpr int kDetail = 4;
  std::mt19937 random(1);
  Map<uint8_t> coarse(kTile / kDetail, kTile / kDetail);
  for (size_t i = 0; i < coarse.size(); ++i) {
    coarse.data()[i] = static_cast<uint8_t>(random() % 256);
  }
  Map<uint8_t> tile(kTile, kTile);
  for (int row = 0; row < kTile; ++row) {
    for (int col = 0; col < kTile; ++col) {
      const int y = row / kDetail;
      const int x = col / kDetail;
      const float fy = static_cast<float>(row % kDetail) / kDetail;
      const float fx = static_cast<float>(col % kDetail) / kDetail;
      const auto at = [&](int i, int j) {
        return static_cast<float>(
            coarse.At(i % coarse.height(), j % coarse.width()));
      };
      const float top = at(y, x) * (1 - fx) + at(y, x + 1) * fx;
      const float bottom = at(y + 1, x) * (1 - fx) + at(y + 1, x + 1) * fx;
      tile.At(row, col) = static_cast<uint8_t>(top * (1 - fy) + bottom * fy);
    }
  }
  return tile;
}

Map<uint8_t> Shifted(const Map<uint8_t>& tile, int width, int height,
                     int shift_x, int shift_y) {
  Map<uint8_t> image(width, height);
  for (int row = 0; row < height; ++row) {
    for (int col = 0; col < width; ++col) {
      image.At(row, col) = tile.At((row + shift_y + 8 * kTile) % kTile,
                                   (col + shift_x + 8 * kTile) % kTile);
    }
  }
  return image;
}

}  // namespace

WideScene::WideScene(int width, int height, int num_sources)
    : source_depth_(width, height, depth()) {
  Camera camera;
  camera.fx = camera.fy = width;
  camera.cx = 0.5 * width;
  camera.cy = 0.5 * height;
  const Map<uint8_t> tile = MakeTile();
  images_.push_back(Shifted(tile, width, height, 0, 0));
  for (int m = 0; m < num_sources; ++m) {
    // On circles, in whole pixels.
    const double radius = width * (0.03 + 0.03 * (m % 3));
    const double angle = 2.4 * m;
    const int x = static_cast<int>(std::lround(radius * std::cos(angle)));
    const int y = static_cast<int>(std::lround(radius * std::sin(angle)));
    images_.push_back(Shifted(tile, width, height, x, y));
    Camera source = camera;
    source.t = {-x * depth() / camera.fx, -y * depth() / camera.fy, 0};
    problem_.sources.push_back({source, nullptr, &source_depth_});
  }
  problem_.reference = {camera, &images_[0], nullptr};
  for (int m = 0; m < num_sources; ++m) {
    problem_.sources[m].image = &images_[m + 1];
  }
  problem_.depth_min = 0.5f * depth();
  problem_.depth_max = 2.0f * depth();
}

}  // namespace tapa
