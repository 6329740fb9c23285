#include "src/mvs/tapa/fill.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "src/base/depth.h"

namespace tapa {
namespace {

constexpr int kNumBins = 3;

// Bilateral weights of the window, by place and by difference in intensity.
struct Weights {
  explicit Weights(const FillOptions& options) : radius(options.radius) {
    const float spatial =
        0.5f / (options.sigma_spatial * options.sigma_spatial);
    for (int dy = -radius; dy <= radius; ++dy) {
      for (int dx = -radius; dx <= radius; ++dx) {
        by_place.push_back(std::exp(-spatial * (dx * dx + dy * dy)));
      }
    }
    const float color = 0.5f / (options.sigma_color * options.sigma_color);
    for (int difference = 0; difference < 256; ++difference) {
      const float d = difference / 255.0f;
      by_difference.push_back(std::exp(-color * d * d));
    }
  }

  int radius;
  std::vector<float> by_place;
  std::vector<float> by_difference;
};

// An estimate in the window.
struct Sample {
  float depth;
  Vec3 normal;
  float weight;
};

// The window around one pixel, clipped to the image.
void CollectSamples(const Weights& weights, const Map<uint8_t>& image,
                    const Map<float>& depth, const Map<Vec3>& normal, int row,
                    int col, std::vector<Sample>* samples) {
  samples->clear();
  const int radius = weights.radius;
  const int size = 2 * radius + 1;
  const int top = std::max(row - radius, 0);
  const int bottom = std::min(row + radius, image.height() - 1);
  const int left = std::max(col - radius, 0);
  const int right = std::min(col + radius, image.width() - 1);
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      if (IsDepth(depth.At(y, x))) {
        const int difference = std::abs(image.At(y, x) - image.At(row, col));
        const int place = (y - row + radius) * size + x - col + radius;
        samples->push_back(
            {depth.At(y, x), normal.At(y, x),
             weights.by_place[place] * weights.by_difference[difference]});
      }
    }
  }
}

// Depth 0 if the samples give no estimate.
DepthNormal MeanOfFullestBin(const std::vector<Sample>& samples,
                             const Vec3& ray, double min_size) {
  const auto by_depth = [](const Sample& a, const Sample& b) {
    return a.depth < b.depth;
  };
  const auto [low, high] =
      std::minmax_element(samples.begin(), samples.end(), by_depth);
  const float min_depth = low->depth;
  const float range = high->depth - min_depth;
  const auto bin_of = [&](const Sample& sample) {
    return range > 0 ? std::min(kNumBins - 1,
                                static_cast<int>((sample.depth - min_depth) /
                                                 range * kNumBins))
                     : 0;
  };
  int sizes[kNumBins] = {};
  for (const Sample& sample : samples) {
    ++sizes[bin_of(sample)];
  }
  const int fullest =
      static_cast<int>(std::max_element(sizes, sizes + kNumBins) - sizes);

  if (sizes[fullest] < min_size) {
    return DepthNormal();
  }

  double sum = 0;
  double depth = 0;
  Vec3 normal;
  for (const Sample& sample : samples) {
    if (bin_of(sample) == fullest) {
      sum += sample.weight;
      depth += static_cast<double>(sample.weight) * sample.depth;
      normal = normal - (-sample.weight) * sample.normal;
    }
  }
  const float norm = std::sqrt(Dot(normal, normal));
  if (!(sum > 0) || !(Dot(normal, ray) < 0)) {
    return DepthNormal();
  }
  return {static_cast<float>(depth / sum), (1.0f / norm) * normal};
}

struct Fill {
  int row;
  int col;
  DepthNormal estimate;
};

// What the missing pixels become, as the maps are.
std::vector<Fill> FindFills(const FillOptions& options, const Weights& weights,
                            const RefCamera& camera, const Map<uint8_t>& image,
                            const Map<float>& depth, const Map<Vec3>& normal) {
  const double min_size =
      options.min_share * (2 * options.radius + 1) * (2 * options.radius + 1);
  const bool has_mask = options.mask != nullptr && !options.mask->empty();
  std::vector<Fill> fills;
  std::vector<Sample> samples;
  for (int row = 0; row < image.height(); ++row) {
    for (int col = 0; col < image.width(); ++col) {
      if (IsDepth(depth.At(row, col)) ||
          (has_mask && options.mask->At(row, col) != 0)) {
        continue;
      }
      CollectSamples(weights, image, depth, normal, row, col, &samples);
      if (samples.empty()) {
        continue;
      }
      const DepthNormal mean =
          MeanOfFullestBin(samples, camera.Ray(row, col), min_size);
      if (mean.depth > 0) {
        fills.push_back({row, col, mean});
      }
    }
  }
  return fills;
}

}  // namespace

void FillMissing(const FillOptions& options, const RefCamera& camera,
                 const Map<uint8_t>& image, Map<float>* depth,
                 Map<Vec3>* normal) {
  const Weights weights(options);
  for (int round = 0; round < options.num_rounds; ++round) {
    const std::vector<Fill> fills =
        FindFills(options, weights, camera, image, *depth, *normal);
    if (fills.empty()) {
      break;
    }
    for (const Fill& fill : fills) {
      depth->At(fill.row, fill.col) = fill.estimate.depth;
      normal->At(fill.row, fill.col) = fill.estimate.normal;
    }
  }
}

}  // namespace tapa
