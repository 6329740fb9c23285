#include "src/colmap/view_cache.h"

#include <gtest/gtest.h>

#include <vector>

namespace tapa {
namespace {

TEST(ViewCache, KeepsTheLastUsedWithinItsSize) {
  std::vector<int> reads;
  // Maps of 8 bytes, of which two fit.
  ViewCache<float> cache(16, [&reads](int index) {
    reads.push_back(index);
    return Map<float>(2, 1, 1.0f * index);
  });
  EXPECT_EQ(cache.Get(1)->At(0, 0), 1);
  EXPECT_EQ(cache.Get(2)->At(0, 0), 2);
  EXPECT_EQ(cache.Get(1)->At(0, 0), 1);
  EXPECT_EQ(reads, (std::vector<int>{1, 2}));
  cache.Get(3);  // In place of 2.
  cache.Get(1);
  EXPECT_EQ(reads, (std::vector<int>{1, 2, 3}));
  cache.Get(2);
  EXPECT_EQ(reads, (std::vector<int>{1, 2, 3, 2}));
  EXPECT_EQ(cache.Use().Describe("maps"), "33 % of 6 maps");
}

TEST(ViewCache, MapsOutliveIt) {
  std::shared_ptr<const Map<float>> map;
  {
    // Nothing fits.
    ViewCache<float> cache(1, [](int) { return Map<float>(2, 1, 5.0f); });
    map = cache.Get(0);
  }
  EXPECT_EQ(map->At(0, 1), 5);
}

}  // namespace
}  // namespace tapa
