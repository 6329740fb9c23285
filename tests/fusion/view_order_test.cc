#include "src/fusion/view_order.h"

#include <gtest/gtest.h>

namespace tapa {
namespace {

TEST(ViewOrderTest, GoesFromNeighborToNeighbor) {
  EXPECT_EQ(ViewOrder({{2, 1}, {2}, {1, 3}, {}}),
            (std::vector<int>{0, 2, 1, 3}));
}

TEST(ViewOrderTest, ReachesViewsWithoutNeighbors) {
  EXPECT_EQ(ViewOrder({{}, {}, {}}), (std::vector<int>{0, 1, 2}));
  EXPECT_TRUE(ViewOrder({}).empty());
}

}  // namespace
}  // namespace tapa
