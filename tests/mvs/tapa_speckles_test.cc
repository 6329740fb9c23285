#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "src/base/depth.h"
#include "src/mvs/tapa/speckles.h"
#include "tests/mvs/tapa_reference.h"

namespace tapa {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

void ExpectReference(const Continuity& continuity, int max_size,
                     const Map<float>& depth) {
  Map<float> actual = depth;
  Map<float> expected = depth;
  RemoveSpeckles(continuity, max_size, &actual);
  reference::RemoveSpeckles(continuity, max_size, &expected);
  for (size_t i = 0; i < depth.size(); ++i) {
    ASSERT_EQ(actual.data()[i], expected.data()[i]) << "pixel " << i;
  }
}

int CountDepths(const Map<float>& depth) {
  return static_cast<int>(
      std::count_if(depth.data(), depth.data() + depth.size(), IsDepth));
}

// Returns the number of pixels that lost a depth.
int CountRemoved(const Continuity& continuity, int max_size,
                 Map<float>* depth) {
  const int num_before = CountDepths(*depth);
  RemoveSpeckles(continuity, max_size, depth);
  return num_before - CountDepths(*depth);
}

// Few levels of depth make regions of all sizes; some pixels have none.
Map<float> RandomDepth(int width, int height, int num_levels,
                       std::mt19937* random) {
  const float invalid[] = {0.0f, -1.0f, -0.0f, kNan, kInf, -kInf};
  Map<float> depth(width, height);
  for (size_t i = 0; i < depth.size(); ++i) {
    depth.data()[i] = (*random)() % 8 == 0 ? invalid[(*random)() % 6]
                                           : 1 + (*random)() % num_levels;
  }
  return depth;
}

TEST(RemoveSpeckles, AgreesWithFloodFill) {
  const struct {
    int width, height;
  } sizes[] = {{1, 1}, {1, 50}, {50, 1}, {2, 3}, {33, 27}, {64, 64}};
  const Continuity continuities[] = {{0, 0},    {0.5f, 0},  {1, 0},
                                     {1.5f, 0}, {0, 0.4f},  {0, 0.5f},
                                     {1, 0.5f}, {100, 100}, {kInf, 0}};
  std::mt19937 random(1);
  for (const auto& size : sizes) {
    for (const int num_levels : {1, 2, 3, 5}) {
      const Map<float> depth =
          RandomDepth(size.width, size.height, num_levels, &random);
      for (const Continuity& continuity : continuities) {
        for (const int max_size : {-1, 0, 1, 2, 10, 100, 1000000}) {
          SCOPED_TRACE(testing::Message()
                       << size.width << "x" << size.height << " levels "
                       << num_levels << " step " << continuity.step << " share "
                       << continuity.share << " max size " << max_size);
          ExpectReference(continuity, max_size, depth);
        }
      }
    }
  }
}

TEST(RemoveSpeckles, AgreesWithFloodFillOnSmoothDepth) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> uniform(0, 1);
  Map<float> depth(61, 47);
  for (int row = 0; row < 47; ++row) {
    for (int col = 0; col < 61; ++col) {
      depth.At(row, col) = 3 + 0.01f * col + 0.02f * row +
                           (uniform(random) < 0.4f ? uniform(random) : 0);
    }
  }
  for (const float share : {0.001f, 0.01f, 0.05f}) {
    ExpectReference({0, share}, 20, depth);
    ExpectReference({3 * share, 0}, 20, depth);
  }
}

TEST(RemoveSpeckles, AcceptsAnEmptyMap) {
  Map<float> depth;
  EXPECT_EQ(CountRemoved({1, 1}, 10, &depth), 0);
}

TEST(RemoveSpeckles, RemovesNothingFromOneRegionAboveTheSize) {
  Map<float> depth(7, 5, 2.0f);
  EXPECT_EQ(CountRemoved({0, 0}, 34, &depth), 0);
  EXPECT_EQ(CountRemoved({0, 0}, 35, &depth), 35);
  for (size_t i = 0; i < depth.size(); ++i) {
    EXPECT_EQ(depth.data()[i], 0);
  }
  // What is removed does not count again.
  EXPECT_EQ(CountRemoved({0, 0}, 35, &depth), 0);
}

TEST(RemoveSpeckles, ZeroesWhatIsNoDepthWithoutCountingIt) {
  Map<float> depth(5, 1, 2.0f);
  depth.At(0, 1) = kNan;
  depth.At(0, 2) = -3;
  depth.At(0, 3) = kInf;
  EXPECT_EQ(CountRemoved({kInf, 0}, 0, &depth), 0);
  EXPECT_EQ(depth.At(0, 0), 2);
  EXPECT_EQ(depth.At(0, 1), 0);
  EXPECT_EQ(depth.At(0, 2), 0);
  EXPECT_EQ(depth.At(0, 3), 0);
  EXPECT_EQ(depth.At(0, 4), 2);
  // They do not connect their neighbours either.
  EXPECT_EQ(CountRemoved({kInf, 0}, 1, &depth), 2);
}

TEST(RemoveSpeckles, ContinuityIsTheLargerOfStepAndShareOfTheSmallerDepth) {
  const auto num_removed = [](const Continuity& continuity, float a, float b) {
    Map<float> depth(2, 1, a);
    depth.At(0, 1) = b;
    return CountRemoved(continuity, 1, &depth);
  };
  EXPECT_EQ(num_removed({0.5f, 0}, 1, 1.5f), 0);
  EXPECT_EQ(num_removed({0.5f, 0}, 1.5f, 1), 0);
  EXPECT_EQ(num_removed({0.5f, 0}, 1, 1.5001f), 2);
  EXPECT_EQ(num_removed({0, 0.5f}, 2, 3), 0);
  EXPECT_EQ(num_removed({0, 0.5f}, 3, 2), 0);
  EXPECT_EQ(num_removed({0, 0.5f}, 3, 2 - 1e-3f), 2);
  EXPECT_EQ(num_removed({0.5f, 0.5f}, 2, 3), 0);
  EXPECT_EQ(num_removed({1, 0.1f}, 2, 3), 0);
}

TEST(RemoveSpeckles, DiagonalPixelsAreNotConnected) {
  Map<float> depth(8, 8);
  for (int row = 0; row < 8; ++row) {
    for (int col = 0; col < 8; ++col) {
      depth.At(row, col) = (row + col) % 2 ? 1 : 0;
    }
  }
  EXPECT_EQ(CountRemoved({10, 0}, 1, &depth), 32);
}

// A long thin region: a slow or recursive search would show here.
TEST(RemoveSpeckles, FollowsASnakeThroughALargeImage) {
  constexpr int kSize = 1501;
  Map<float> depth(kSize, kSize, 0.0f);
  int length = 0;
  for (int row = 0; row < kSize; ++row) {
    for (int col = 0; col < kSize; ++col) {
      const bool joint = row / 2 % 2 ? col == 0 : col == kSize - 1;
      if (row % 2 == 0 || joint) {
        depth.At(row, col) = 1;
        ++length;
      }
    }
  }
  const Map<float> before = depth;
  EXPECT_EQ(CountRemoved({0, 0}, length - 1, &depth), 0);
  EXPECT_EQ(CountRemoved({0, 0}, length, &depth), length);
  ExpectReference({0, 0}, length - 1, before);
}

}  // namespace
}  // namespace tapa
