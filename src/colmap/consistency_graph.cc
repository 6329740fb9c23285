#include "src/colmap/consistency_graph.h"

#include <bitset>

namespace tapa {
namespace {

// Number of elements of the graph: three and one per view for every pixel with
// a consistent view.
size_t GraphSize(const std::vector<uint8_t>& bits, size_t bytes_per_pixel) {
  size_t size = 0;
  for (size_t pixel = 0; pixel < bits.size(); pixel += bytes_per_pixel) {
    size_t num_consistent = 0;
    for (size_t i = 0; i < bytes_per_pixel; ++i) {
      num_consistent += std::bitset<8>(bits[pixel + i]).count();
    }
    size += num_consistent > 0 ? 3 + num_consistent : 0;
  }
  return size;
}

}  // namespace

std::vector<int32_t> ConsistencyGraph(const Estimate& estimate,
                                      const std::vector<int>& source_indices) {
  std::vector<int32_t> graph;
  if (estimate.consistent.empty()) {
    return graph;
  }
  const size_t num_sources = source_indices.size();
  const size_t bytes_per_pixel = (num_sources + 7) / 8;
  const uint8_t* bits = estimate.consistent.data();
  graph.reserve(GraphSize(estimate.consistent, bytes_per_pixel));
  for (int row = 0; row < estimate.depth.height(); ++row) {
    for (int col = 0; col < estimate.depth.width(); ++col) {
      const size_t begin = graph.size();
      graph.insert(graph.end(), {col, row, 0});
      for (size_t m = 0; m < num_sources; ++m) {
        if ((bits[m / 8] >> (m % 8)) & 1) {
          graph.push_back(source_indices[m]);
        }
      }
      const size_t num_consistent = graph.size() - begin - 3;
      if (num_consistent == 0) {
        graph.resize(begin);
      } else {
        graph[begin + 2] = static_cast<int32_t>(num_consistent);
      }
      bits += bytes_per_pixel;
    }
  }
  return graph;
}

std::vector<int32_t> KeepUnchanged(const std::vector<int32_t>& graph,
                                   const Map<float>& before,
                                   const Map<float>& after) {
  std::vector<int32_t> kept;
  auto at = graph.begin();
  while (at != graph.end()) {
    const int col = at[0];
    const int row = at[1];
    const auto end = at + 3 + at[2];
    if (before.At(row, col) == after.At(row, col)) {
      kept.insert(kept.end(), at, end);
    }
    at = end;
  }
  return kept;
}

}  // namespace tapa
