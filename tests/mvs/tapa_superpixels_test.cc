#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <future>
#include <random>
#include <thread>
#include <vector>

#include "src/mvs/tapa/superpixels.h"
#include "tests/mvs/tapa_reference.h"

namespace tapa {
namespace {

Map<Rgb> FlatImage(int width, int height) {
  return Map<Rgb>(width, height, {90, 140, 200});
}

Map<Rgb> NoiseImage(int width, int height, int range, unsigned seed) {
  std::mt19937 random(seed);
  Map<Rgb> image(width, height);
  for (size_t i = 0; i < image.size(); ++i) {
    image.data()[i] = {static_cast<uint8_t>(random() % range),
                       static_cast<uint8_t>(random() % range),
                       static_cast<uint8_t>(random() % range)};
  }
  return image;
}

// Waves of colour and tiles, as in a photograph.
Map<Rgb> SmoothImage(int width, int height) {
  Map<Rgb> image(width, height);
  for (int row = 0; row < height; ++row) {
    for (int col = 0; col < width; ++col) {
      const double wave =
          128 + 60 * std::sin(0.013 * col) + 50 * std::cos(0.021 * row);
      image.At(row, col) = {
          static_cast<uint8_t>(wave), static_cast<uint8_t>(255 - wave),
          static_cast<uint8_t>((col / 97 + row / 61) % 2 * 120)};
    }
  }
  return image;
}

void ExpectSound(const Superpixels& superpixels, const Map<Rgb>& image) {
  ASSERT_EQ(superpixels.labels.width(), image.width());
  ASSERT_EQ(superpixels.labels.height(), image.height());
  ASSERT_GE(superpixels.count(), 1);
  std::vector<int> sizes(superpixels.count(), 0);
  for (size_t i = 0; i < image.size(); ++i) {
    ASSERT_LT(superpixels.labels.data()[i], superpixels.count());
    ++sizes[superpixels.labels.data()[i]];
  }
  for (const int size : sizes) {
    EXPECT_GT(size, 0);
  }
  for (int k = 0; k < superpixels.count(); ++k) {
    int last = -1;
    for (const Neighbor& neighbor : superpixels.neighbors[k]) {
      EXPECT_GT(neighbor.index, last);
      EXPECT_LT(neighbor.index, superpixels.count());
      EXPECT_NE(neighbor.index, k);
      EXPECT_GE(neighbor.similarity, 0);
      EXPECT_LE(neighbor.similarity, 1);
      last = neighbor.index;
      const auto& back = superpixels.neighbors[neighbor.index];
      EXPECT_TRUE(std::any_of(back.begin(), back.end(), [&](const auto& n) {
        return n.index == k && n.similarity == neighbor.similarity;
      }));
    }
  }
}

void ExpectSameNeighbors(const std::vector<std::vector<Neighbor>>& actual,
                         const std::vector<std::vector<Neighbor>>& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (size_t k = 0; k < actual.size(); ++k) {
    ASSERT_EQ(actual[k].size(), expected[k].size()) << k;
    for (size_t i = 0; i < actual[k].size(); ++i) {
      EXPECT_EQ(actual[k][i].index, expected[k][i].index) << k;
      EXPECT_NEAR(actual[k][i].similarity, expected[k][i].similarity, 1e-5);
    }
  }
}

TEST(FindNeighbors, AgreesWithExhaustiveSearch) {
  std::mt19937 random(1);
  const struct {
    int width, height;
  } sizes[] = {{1, 1}, {1, 20}, {20, 1}, {9, 7}, {30, 20}};
  for (const auto& size : sizes) {
    for (const int count : {1, 2, 5, 12}) {
      for (const int range : {1, 40, 256}) {
        const Map<Rgb> image =
            NoiseImage(size.width, size.height, range, random());
        // Blocks and single pixels; some labels may not occur.
        Map<uint16_t> labels(size.width, size.height);
        for (int row = 0; row < size.height; ++row) {
          for (int col = 0; col < size.width; ++col) {
            labels.At(row, col) = random() % 10 == 0
                                      ? random() % count
                                      : (row / 4 * 3 + col / 5) % count;
          }
        }
        ExpectSameNeighbors(FindNeighbors(image, labels, count),
                            reference::FindNeighbors(image, labels, count));
      }
    }
  }
}

TEST(FindNeighbors, ComparesColors) {
  // Three stripes: two alike, one of other colours; only stripes side by side
  // touch.
  Map<Rgb> image(9, 4, {10, 10, 10});
  Map<uint16_t> labels(9, 4);
  for (int row = 0; row < 4; ++row) {
    for (int col = 0; col < 9; ++col) {
      labels.At(row, col) = col / 3;
      if (col >= 6) {
        image.At(row, col) = {200, 10, 10};
      }
    }
  }
  auto neighbors = FindNeighbors(image, labels, 3);
  ASSERT_EQ(neighbors[0].size(), 1u);
  EXPECT_EQ(neighbors[0][0].index, 1);
  EXPECT_EQ(neighbors[0][0].similarity, 1);
  ASSERT_EQ(neighbors[1].size(), 2u);
  EXPECT_EQ(neighbors[1][1].index, 2);
  EXPECT_EQ(neighbors[1][1].similarity, 0);
  // A half in common: sqrt(1 * 0.5).
  for (int row = 0; row < 2; ++row) {
    for (int col = 6; col < 9; ++col) {
      image.At(row, col) = {10, 10, 10};
    }
  }
  neighbors = FindNeighbors(image, labels, 3);
  EXPECT_NEAR(neighbors[1][1].similarity, std::sqrt(0.5), 1e-6);
  // All three channels count.
  image.At(0, 0).g = 250;
  image.At(0, 1).b = 250;
  ExpectSameNeighbors(FindNeighbors(image, labels, 3),
                      reference::FindNeighbors(image, labels, 3));
}

TEST(ComputeSuperpixels, LabelsAndNeighborsAreSound) {
  for (const int count : {2, 10, 25, 100}) {
    for (const Map<Rgb>& image :
         {FlatImage(160, 120), NoiseImage(160, 120, 256, 1),
          SmoothImage(160, 120)}) {
      const Superpixels superpixels = ComputeSuperpixels(image, count);
      ExpectSound(superpixels, image);
      ExpectSameNeighbors(superpixels.neighbors,
                          reference::FindNeighbors(image, superpixels.labels,
                                                   superpixels.count()));
    }
  }
}

TEST(ComputeSuperpixels, AnEmptyImageHasNone) {
  const Superpixels superpixels = ComputeSuperpixels(Map<Rgb>(), 10);
  EXPECT_EQ(superpixels.count(), 0);
  EXPECT_TRUE(superpixels.labels.empty());
}

TEST(ComputeSuperpixels, ATinyImageIsOneRegion) {
  const struct {
    int width, height;
  } sizes[] = {{1, 1}, {1, 300}, {300, 1}, {15, 15}, {15, 400}, {400, 15}};
  for (const auto& size : sizes) {
    for (const int count : {-3, 0, 1, 5, 100000}) {
      for (const Map<Rgb>& image :
           {FlatImage(size.width, size.height),
            NoiseImage(size.width, size.height, 256, 1)}) {
        const Superpixels superpixels = ComputeSuperpixels(image, count);
        ExpectSound(superpixels, image);
        EXPECT_EQ(superpixels.count(), 1);
      }
    }
  }
}

TEST(ComputeSuperpixels, OneIsOne) {
  const Map<Rgb> image = SmoothImage(200, 100);
  EXPECT_EQ(ComputeSuperpixels(image, 1).count(), 1);
  EXPECT_EQ(ComputeSuperpixels(image, 0).count(), 1);
  EXPECT_EQ(ComputeSuperpixels(image, -1).count(), 1);
}

// Shapes that OpenCV's SEEDS has no grid for, and some near them.
TEST(ComputeSuperpixels, WorksForEveryShape) {
  const struct {
    int width, height;
  } sizes[] = {{16, 16},   {17, 31},  {31, 17},  {16, 1000}, {1000, 16},
               {100, 33},  {33, 100}, {31, 500}, {500, 31},  {2000, 20},
               {20, 2000}, {64, 64},  {97, 16},  {16, 97},   {640, 40}};
  for (const auto& size : sizes) {
    for (const int count : {1, 2, 3, 5, 10, 30, 200, 100000}) {
      SCOPED_TRACE(testing::Message()
                   << size.width << "x" << size.height << " " << count);
      const Map<Rgb> image = SmoothImage(size.width, size.height);
      const Superpixels superpixels = ComputeSuperpixels(image, count);
      ExpectSound(superpixels, image);
      // 8 x 8 pixels on average.
      EXPECT_LE(superpixels.count(), size.width * size.height / 64);
    }
  }
}

TEST(ComputeSuperpixels, CountIsNearWhatIsAsked) {
  const struct {
    int width, height, count;
  } cases[] = {{540, 360, 27},    {540, 360, 18},   {720, 480, 36},
               {720, 480, 24},    {1536, 1024, 77}, {1536, 1024, 51},
               {3200, 2130, 160}, {3200, 2130, 107}};
  for (const auto& c : cases) {
    SCOPED_TRACE(testing::Message()
                 << c.width << "x" << c.height << " " << c.count);
    const Map<Rgb> image = SmoothImage(c.width, c.height);
    const Superpixels superpixels = ComputeSuperpixels(image, c.count);
    EXPECT_GE(superpixels.count(), 0.45 * c.count);
    EXPECT_LE(superpixels.count(), 2 * c.count);
    // As many where there is nothing to segment.
    const Map<Rgb> flat = FlatImage(c.width, c.height);
    EXPECT_EQ(ComputeSuperpixels(flat, c.count).count(), superpixels.count());
  }
}

TEST(ComputeSuperpixels, FollowsAStrongEdge) {
  // A slanted edge between blue and orange of the same brightness.
  Map<Rgb> image(240, 180);
  const auto is_left = [](int row, int col) { return col < 80 + row / 3; };
  for (int row = 0; row < 180; ++row) {
    for (int col = 0; col < 240; ++col) {
      image.At(row, col) =
          is_left(row, col) ? Rgb{70, 120, 210} : Rgb{190, 105, 40};
    }
  }
  const Superpixels superpixels = ComputeSuperpixels(image, 24);
  ExpectSound(superpixels, image);
  std::vector<int> left(superpixels.count(), 0);
  std::vector<int> right(superpixels.count(), 0);
  for (int row = 0; row < 180; ++row) {
    for (int col = 0; col < 240; ++col) {
      ++(is_left(row, col) ? left : right)[superpixels.labels.At(row, col)];
    }
  }
  int num_wrong = 0;
  for (int k = 0; k < superpixels.count(); ++k) {
    num_wrong += std::min(left[k], right[k]);
  }
  EXPECT_LT(num_wrong, 0.01 * image.size());
}

TEST(ComputeSuperpixels, IsDeterministic) {
  const Map<Rgb> image = NoiseImage(200, 150, 256, 3);
  const Superpixels a = ComputeSuperpixels(image, 30);
  ComputeSuperpixels(SmoothImage(100, 100), 12);
  const Superpixels b = ComputeSuperpixels(image, 30);
  EXPECT_EQ(std::memcmp(a.labels.data(), b.labels.data(),
                        a.labels.size() * sizeof(uint16_t)),
            0);
  ExpectSameNeighbors(a.neighbors, b.neighbors);
}

// OpenCV fills its tables of colours at their first use, which must not be that
// of several threads. To be run in a process of its own.
TEST(ComputeSuperpixels, FirstUsesMayBeAtTheSameTime) {
  constexpr int kNumThreads = 4;
  const Map<Rgb> image = NoiseImage(64, 64, 256, 4);
  std::atomic<int> num_ready = 0;
  std::vector<std::future<Superpixels>> results;
  for (int i = 0; i < kNumThreads; ++i) {
    results.push_back(std::async(std::launch::async, [&] {
      ++num_ready;
      while (num_ready < kNumThreads) {
        std::this_thread::yield();
      }
      return ComputeSuperpixels(image, 12);
    }));
  }
  std::vector<Superpixels> found;
  for (std::future<Superpixels>& result : results) {
    found.push_back(result.get());
  }
  const Superpixels expected = ComputeSuperpixels(image, 12);
  for (const Superpixels& superpixels : found) {
    EXPECT_EQ(std::memcmp(superpixels.labels.data(), expected.labels.data(),
                          expected.labels.size() * sizeof(uint16_t)),
              0);
  }
}

}  // namespace
}  // namespace tapa
