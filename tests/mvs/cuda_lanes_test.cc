// Sums across the lanes of a warp, on an emulated GPU.

#include "tests/mvs/emulated_cuda/device_code.h"
//
#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "src/mvs/cuda/lanes.h"

namespace tapa {
namespace {

TEST(WarpLanes, SumAcrossLanes) {
  for (const int count : {1, 5, 20, 32, 33, 64, 77}) {
    std::vector<float> values(count);
    std::iota(values.begin(), values.end(), 1.0f);
    const float total = 0.5f * count * (count + 1);
    emulated_cuda::RunWarp(3, [&] {
      const float sum = WarpLanes::Accumulate(count, values.data());
      EXPECT_EQ(sum, total);
    });
    for (int i = 0; i < count; ++i) {
      EXPECT_EQ(values[i], 0.5f * (i + 1) * (i + 2));
    }
  }
  emulated_cuda::RunWarp(0, [] {
    const int lane = WarpLanes::First();
    EXPECT_EQ(WarpLanes::Sum(lane), 496);
    EXPECT_EQ(WarpLanes::Sum(0.5f * lane), 248);
    const int first = WarpLanes::Group() * WarpLanes::kGroupSize;
    EXPECT_EQ(WarpLanes::GroupSum(1.0f * lane), 4 * first + 6);
  });
}

}  // namespace
}  // namespace tapa
