#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "src/mvs/tapa/even_regions.h"

namespace tapa {
namespace {

TEST(MeasureSteps, AreAsHighAsTheirColours) {
  Map<Rgb> color(60, 40, {50, 60, 70});
  for (int row = 0; row < 40; ++row) {
    for (int col = 30; col < 60; ++col) {
      color.At(row, col) = {55, 100, 71};
    }
  }
  const Map<float> steps = MeasureSteps(color);
  for (int row = 0; row < 40; ++row) {
    EXPECT_NEAR(std::max(steps.At(row, 29), steps.At(row, 30)), 40, 5) << row;
    EXPECT_NEAR(steps.At(row, 10), 0, 0.01);
    EXPECT_NEAR(steps.At(row, 50), 0, 0.01);
  }
}

TEST(MeasureSteps, HardlySeeNoise) {
  std::mt19937 random(1);
  std::normal_distribution<float> noise(100, 2);
  Map<Rgb> color(200, 100);
  for (size_t i = 0; i < color.size(); ++i) {
    const auto draw = [&] { return static_cast<uint8_t>(noise(random)); };
    color.data()[i] = {draw(), draw(), draw()};
  }
  const Map<float> steps = MeasureSteps(color);
  const auto num_below_3 =
      std::count_if(steps.data(), steps.data() + steps.size(),
                    [](float step) { return step < 3; });
  EXPECT_GT(num_below_3, 0.99 * steps.size());
}

// Of a map of steps: the definition in the header, one pixel after the other.
struct NaiveRegions {
  explicit NaiveRegions(const Map<float>& steps)
      : label(steps.width(), steps.height()) {
    for (int row = 0; row < steps.height(); ++row) {
      for (int col = 0; col < steps.width(); ++col) {
        if (label.At(row, col) == 0 && IsCore(steps, row, col)) {
          Flood(steps, row, col);
        }
      }
    }
  }

  // Two pixels away from all steps; what is outside of the image is none.
  static bool IsCore(const Map<float>& steps, int row, int col) {
    for (int y = std::max(row - 2, 0);
         y <= std::min(row + 2, steps.height() - 1); ++y) {
      for (int x = std::max(col - 2, 0);
           x <= std::min(col + 2, steps.width() - 1); ++x) {
        // OpenCV's ellipse of 5x5: one pixel in each of the outer rows.
        const bool is_in = std::abs(y - row) < 2 || x == col;
        if (is_in && steps.At(y, x) >= 3) {
          return false;
        }
      }
    }
    return true;
  }

  void Flood(const Map<float>& steps, int row, int col) {
    ++count;
    sizes.push_back(0);
    std::vector<std::pair<int, int>> open = {{row, col}};
    label.At(row, col) = count;
    while (!open.empty()) {
      const auto [y, x] = open.back();
      open.pop_back();
      ++sizes.back();
      for (const auto& [r, c] : std::vector<std::pair<int, int>>{
               {y - 1, x}, {y + 1, x}, {y, x - 1}, {y, x + 1}}) {
        if (r >= 0 && c >= 0 && r < steps.height() && c < steps.width() &&
            label.At(r, c) == 0 && IsCore(steps, r, c)) {
          label.At(r, c) = count;
          open.push_back({r, c});
        }
      }
    }
  }

  Map<int32_t> label;
  int count = 0;
  std::vector<int> sizes;
};

TEST(FindEvenRegions, AgreeWithNaiveReference) {
  constexpr int kWidth = 120;
  constexpr int kHeight = 90;
  std::mt19937 random(3);
  Map<float> steps(kWidth, kHeight, 1);
  const auto line = [&](int row, int col, int rows, int cols) {
    for (int y = row; y < std::min(row + rows, kHeight); ++y) {
      for (int x = col; x < std::min(col + cols, kWidth); ++x) {
        steps.At(y, x) = 9;
      }
    }
  };
  for (int i = 0; i < 30; ++i) {
    const bool upright = random() % 2 == 0;
    line(random() % kHeight, random() % kWidth, upright ? 50 : 1,
         upright ? 1 : 60);
  }
  const Map<float> textureness(kWidth, kHeight, 0.2f);
  const EvenRegions regions = FindEvenRegions(steps, textureness, 3);
  const NaiveRegions naive(steps);
  EXPECT_GT(regions.count, 3);

  std::vector<int32_t> label_of(naive.count + 1, 0);
  int num_checked = 0;
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; ++col) {
      const int32_t expected = naive.label.At(row, col);
      const int32_t label = regions.labels.At(row, col);
      ASSERT_GE(label, 0);
      ASSERT_LE(label, regions.count);
      if (expected > 0 &&
          naive.sizes[expected - 1] >= kWidth * kHeight / 500.0) {
        ASSERT_GT(label, 0) << row << " " << col;
        ASSERT_TRUE(label_of[expected] == 0 || label_of[expected] == label);
        label_of[expected] = label;
        ++num_checked;
      }
    }
  }
  EXPECT_GT(num_checked, kWidth * kHeight / 4);
  // Each region of the reference is one, and each one is.
  std::set<int32_t> found(label_of.begin(), label_of.end());
  found.erase(0);
  EXPECT_EQ(static_cast<int>(found.size()), regions.count);
  EXPECT_EQ(std::count_if(label_of.begin(), label_of.end(),
                          [](int32_t label) { return label > 0; }),
            regions.count);
  // All others: as the nearest of these, up to eight pixels away. OpenCV's
  // distances are not quite exact.
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; ++col) {
      std::vector<double> nearest(regions.count + 1, 1e9);
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
          double& distance = nearest[label_of[naive.label.At(y, x)]];
          distance = std::min(distance, std::hypot(y - row, x - col));
        }
      }
      nearest[0] = 1e9;
      const auto least = std::min_element(nearest.begin(), nearest.end());
      const int32_t label = regions.labels.At(row, col);
      if (std::abs(*least - 8) > 0.4) {
        ASSERT_EQ(label > 0, *least < 8) << row << " " << col;
      }
      if (label > 0) {
        ASSERT_LT(nearest[label], *least + 0.4) << row << " " << col;
      }
    }
  }
}

TEST(FindEvenRegions, EndAtTextureAndAreNotSmall) {
  const Map<float> steps(100, 60, 0.5f);
  Map<float> textureness(100, 60, 0.2f);
  for (int row = 0; row < 60; ++row) {
    for (int col = 40; col < 60; ++col) {
      textureness.At(row, col) = 0.5f;
    }
  }
  // Wide enough for 3x3 pixels only.
  for (int row = 20; row < 27; ++row) {
    for (int col = 46; col < 53; ++col) {
      textureness.At(row, col) = 0.2f;
    }
  }
  const EvenRegions regions = FindEvenRegions(steps, textureness, 3);
  EXPECT_EQ(regions.count, 2);
  EXPECT_NE(regions.labels.At(10, 10), regions.labels.At(10, 90));
  EXPECT_EQ(regions.labels.At(23, 49), EvenRegions::kNone);
}

TEST(FindEvenRegions, MayBeNoneOrAll) {
  const Map<float> low(30, 20, 0.2f);
  EXPECT_EQ(FindEvenRegions(Map<float>(30, 20, 9), low, 3).count, 0);
  EXPECT_EQ(FindEvenRegions(low, Map<float>(30, 20, 0.9f), 3).count, 0);
  EXPECT_EQ(FindEvenRegions(Map<float>(), Map<float>(), 3).count, 0);
  EXPECT_TRUE(MeasureSteps(Map<Rgb>()).empty());
  const EvenRegions all = FindEvenRegions(low, low, 3);
  EXPECT_EQ(all.count, 1);
  EXPECT_EQ(std::count(all.labels.data(), all.labels.data() + 600, 1), 600);
  EXPECT_EQ(FindEvenRegions(Map<float>(1, 1), Map<float>(1, 1), 3).count, 1);
}

}  // namespace
}  // namespace tapa
