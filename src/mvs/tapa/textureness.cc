#include "src/mvs/tapa/textureness.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace tapa {
namespace {

// Sums over pixels of their intensities and of their squares.
struct Sums {
  int64_t first = 0;
  int64_t second = 0;

  Sums& operator+=(const Sums& other) {
    first += other.first;
    second += other.second;
    return *this;
  }
  Sums& operator-=(const Sums& other) {
    first -= other.first;
    second -= other.second;
    return *this;
  }
};

Sums SumsOf(int64_t intensity) { return {intensity, intensity * intensity}; }

void Check(const TexturenessOptions& options) {
  if (options.radius < 0 || options.radius > 1000) {
    throw std::invalid_argument("textureness radius must be 0 to 1000");
  }
  if (!(options.epsilon > 0) || !std::isfinite(options.epsilon)) {
    throw std::invalid_argument("textureness epsilon must be positive");
  }
  if (!(options.min_textureness > 0 && options.min_textureness <= 1)) {
    throw std::invalid_argument(
        "minimum textureness must be above 0 and at most 1");
  }
}

// Of a patch of `count` pixels.
float TexturenessOf(const Sums& patch, int64_t count,
                    const TexturenessOptions& options) {
  // Exact in integers: count^2 times the variance of 0 to 255.
  const int64_t scaled = count * patch.second - patch.first * patch.first;
  const double variance =
      scaled / (static_cast<double>(count) * count * 255.0 * 255.0);
  return static_cast<float>(
      (variance + options.epsilon) /
      (variance + options.epsilon / options.min_textureness));
}

// Of the patches around the pixels of a row: they slide to the right over the
// sums of the columns, over num_rows rows each.
void ComputeRow(const std::vector<Sums>& columns, int num_rows,
                const TexturenessOptions& options, float* textureness) {
  const int width = static_cast<int>(columns.size());
  const int radius = options.radius;
  Sums patch;
  for (int col = 0; col < std::min(radius, width); ++col) {
    patch += columns[col];
  }
  for (int col = 0; col < width; ++col) {
    if (col + radius < width) patch += columns[col + radius];
    if (col - radius > 0) patch -= columns[col - radius - 1];
    const int num_cols =
        std::min(col + radius, width - 1) - std::max(col - radius, 0) + 1;
    textureness[col] = TexturenessOf(
        patch, static_cast<int64_t>(num_rows) * num_cols, options);
  }
}

}  // namespace

TexturenessOptions TexturenessOf(const TapaOptions& options) {
  TexturenessOptions result;
  result.epsilon = options.textureness_variance;
  result.min_textureness = options.min_textureness;
  return result;
}

Map<float> ComputeTextureness(const Map<uint8_t>& image,
                              const TexturenessOptions& options) {
  Check(options);
  const int width = image.width();
  const int height = image.height();
  const int radius = options.radius;
  Map<float> textureness(width, height);

  // The patches slide down: every column keeps the sums of its rows in reach.
  std::vector<Sums> columns(width);
  const auto add_row = [&](int row) {
    for (int col = 0; col < width; ++col) {
      columns[col] += SumsOf(image.At(row, col));
    }
  };
  const auto remove_row = [&](int row) {
    for (int col = 0; col < width; ++col) {
      columns[col] -= SumsOf(image.At(row, col));
    }
  };
  for (int row = 0; row < std::min(radius, height); ++row) add_row(row);
  for (int row = 0; row < height; ++row) {
    if (row + radius < height) add_row(row + radius);
    if (row - radius > 0) remove_row(row - radius - 1);
    const int num_rows =
        std::min(row + radius, height - 1) - std::max(row - radius, 0) + 1;
    ComputeRow(columns, num_rows, options, textureness.Row(row));
  }
  return textureness;
}

}  // namespace tapa
