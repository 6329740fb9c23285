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

TEST(ConsistencyGraph, LosesPixelsThatHaveChanged) {
  // 3x1 pixels: one that stays, one that has moved, one that is gone.
  Map<float> before(3, 1, 2);
  Map<float> after = before;
  after.At(0, 1) = 2.5f;
  after.At(0, 2) = 0;
  const std::vector<int32_t> graph = {0, 0,  2, 10, 12, 1, 0,
                                      1, 11, 2, 0,  1,  12};
  EXPECT_EQ(KeepUnchanged(graph, before, after),
            (std::vector<int32_t>{0, 0, 2, 10, 12}));
  EXPECT_EQ(KeepUnchanged(graph, before, before), graph);
  EXPECT_TRUE(KeepUnchanged({}, before, after).empty());
}

}  // namespace
}  // namespace tapa
