#include "src/colmap/consistency_graph.h"

#include <gtest/gtest.h>

namespace tapa {
namespace {

TEST(ConsistencyGraph, ListsSupportingViews) {
  // 2x1 pixels, 9 sources: two bytes per pixel.
  Estimate estimate;
  estimate.depth = Map<float>(2, 1);
  estimate.consistent = {0, 0, 0b00000101, 0b1};
  const std::vector<int> sources = {10, 11, 12, 13, 14, 15, 16, 17, 18};
  EXPECT_EQ(ConsistencyGraph(estimate, sources),
            (std::vector<int32_t>{1, 0, 3, 10, 12, 18}));
}

TEST(ConsistencyGraph, IsEmptyWithoutFilter) {
  Estimate estimate;
  estimate.depth = Map<float>(2, 1);
  EXPECT_TRUE(ConsistencyGraph(estimate, {10, 11}).empty());
}

}  // namespace
}  // namespace tapa
