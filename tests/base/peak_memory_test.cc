#include "src/base/peak_memory.h"

#include <gtest/gtest.h>

#include <vector>

namespace tapa {
namespace {

TEST(PeakMemory, StaysWhenMemoryIsGivenBack) {
  constexpr double kSize = 64 << 20;
  const double before = PeakMemory();
  { const std::vector<char> block(static_cast<size_t>(kSize), 1); }
  EXPECT_GT(PeakMemory(), before + 0.9 * kSize);
  EXPECT_EQ(DescribePeakMemory().find("Peak memory: "), 0u);
}

}  // namespace
}  // namespace tapa
