#ifndef TAPA_SRC_COLMAP_CONSISTENCY_GRAPH_H_
#define TAPA_SRC_COLMAP_CONSISTENCY_GRAPH_H_

#include <cstdint>
#include <vector>

#include "src/mvs/problem.h"

namespace tapa {

// Lists the source views that support each pixel, as COLMAP stores it: for
// every pixel with any, its column, its row, their number, their indices.
// source_indices: index in the model of each of the problem's source views.
// Empty if the estimate was not filtered.
std::vector<int32_t> ConsistencyGraph(const Estimate& estimate,
                                      const std::vector<int>& source_indices);

// What a graph lists of the pixels whose depth is still what it was: other
// estimates are not those that source views supported.
std::vector<int32_t> KeepUnchanged(const std::vector<int32_t>& graph,
                                   const Map<float>& before,
                                   const Map<float>& after);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_CONSISTENCY_GRAPH_H_
