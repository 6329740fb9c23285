#include "src/mvs/cuda/memory_plan.h"

#include <algorithm>
#include <cmath>

#include "src/mvs/sweep/packed_depth_normal.h"

namespace tapa {
namespace {

// A launch sweeps at least a piece, which is to take longer than to launch it.
constexpr int kMinPieceLength = 16;

}  // namespace

MemoryPlan::MemoryPlan(const Options& options, const Problem& problem)
    : width(problem.reference.image->width()),
      height(problem.reference.image->height()),
      num_views(static_cast<int>(problem.sources.size())),
      geometric(options.geom_consistency),
      tapa(options.tapa.enabled),
      prior(!problem.prior.empty()),
      pixels(problem.reference.image->size()) {
  for (const View& view : problem.sources) {
    max_source_width = std::max(max_source_width, view.image->width());
    max_source_height = std::max(max_source_height, view.image->height());
  }
  const size_t longer = std::max(width, height);
  const size_t n = num_views;
  piece_length =
      std::max(kMinPieceLength, static_cast<int>(std::sqrt(double(longer))));
  const auto num_pieces = [&](size_t length) {
    return (length + piece_length - 1) / piece_length;
  };
  pixel_views = pixels * n;
  source_pixels = static_cast<size_t>(max_source_width) * max_source_height * n;
  backward = longer * piece_length * n;
  // The last piece of a line needs none.
  checkpoints = std::max((num_pieces(height) - 1) * width,
                         (num_pieces(width) - 1) * height) *
                n;
  forward = longer * n;
  previous = longer;
}

size_t MemoryPlan::Bytes() const {
  size_t bytes = pixels * (sizeof(PackedDepthNormal) + sizeof(uint8_t)) +
                 pixel_views * 2 * sizeof(uint16_t) + source_pixels +
                 (backward + checkpoints + forward) * sizeof(float) +
                 previous * sizeof(DepthNormal);
  if (geometric) {
    bytes += source_pixels * sizeof(float);
  }
  if (tapa) {
    bytes += pixels * 3 * sizeof(uint16_t);
  }
  if (prior) {
    bytes += pixels * sizeof(PackedDepthNormal);
  }
  return bytes;
}

size_t EstimateDepthDeviceMemory(const Options& options,
                                 const Problem& problem) {
  return MemoryPlan(options, problem).Bytes();
}

}  // namespace tapa
