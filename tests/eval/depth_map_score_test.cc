#include "src/eval/depth_map_score.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

namespace tapa {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr Tolerance::Unit kMetres = Tolerance::Unit::kMetres;
constexpr Tolerance::Unit kPercent = Tolerance::Unit::kPercent;

Map<float> MakeMap(int width, int height, const std::vector<float>& values) {
  Map<float> map(width, height);
  std::copy(values.begin(), values.end(), map.data());
  return map;
}

DepthMapScore Score(const Map<float>& depth, const Map<float>& truth,
                    const std::vector<Tolerance>& tolerances,
                    const Map<uint8_t>* mask = nullptr) {
  return DepthMapScorer(tolerances).Add(depth, truth, mask);
}

TEST(DepthMapScoreTest, ByHand) {
  // Errors: 0, 0.25, 0.5; two measurements without estimate; one estimate
  // without measurement; one pixel of the map is negative.
  const Map<float> depth = MakeMap(4, 2, {1, 2.25f, 4.5f, 0, 3, -1, 0, 0});
  const Map<float> truth = MakeMap(4, 2, {1, 2, 4, 2, 0, 8, 0, 0});
  const DepthMapScore score =
      Score(depth, truth, {{0.25, kMetres}, {12.5, kPercent}, {1, kPercent}});
  EXPECT_EQ(score.num_maps, 1);
  EXPECT_EQ(score.num_pixels, 8);
  EXPECT_EQ(score.num_estimates, 4);
  EXPECT_EQ(score.num_invalid, 1);
  EXPECT_EQ(score.num_measurements, 5);
  EXPECT_EQ(score.num_measurements_covered, 3);
  EXPECT_EQ(score.num_estimates_measured, 3);
  EXPECT_DOUBLE_EQ(score.Coverage(), 0.5);
  EXPECT_DOUBLE_EQ(score.MeasurementCoverage(), 0.6);
  EXPECT_DOUBLE_EQ(score.median_absolute_error, 0.25);
  EXPECT_DOUBLE_EQ(score.median_relative_error, 0.125);
  // A tolerance includes its own value.
  EXPECT_DOUBLE_EQ(score.Completeness(0), 2.0 / 5);
  EXPECT_DOUBLE_EQ(score.Accuracy(0), 2.0 / 3);
  EXPECT_DOUBLE_EQ(score.F1(0), 0.5);
  EXPECT_DOUBLE_EQ(score.Completeness(1), 3.0 / 5);
  EXPECT_DOUBLE_EQ(score.Accuracy(1), 1);
  EXPECT_DOUBLE_EQ(score.F1(1), 0.75);
  EXPECT_DOUBLE_EQ(score.Completeness(2), 1.0 / 5);
  EXPECT_DOUBLE_EQ(score.Accuracy(2), 1.0 / 3);
  EXPECT_DOUBLE_EQ(score.F1(2), 0.25);
}

TEST(DepthMapScoreTest, MedianOfAnEvenNumberIsTheMeanOfTheMiddleTwo) {
  const DepthMapScore score =
      Score(MakeMap(4, 1, {1, 2, 5, 9}), MakeMap(4, 1, {1, 1, 1, 1}), {});
  EXPECT_DOUBLE_EQ(score.median_absolute_error, 2.5);
}

TEST(DepthMapScoreTest, WhatIsNoDepthIsNoEstimate) {
  const Map<float> depth = MakeMap(5, 1, {kNaN, kInf, -kInf, -2, 0});
  const Map<float> truth = MakeMap(5, 1, {1, 1, 1, 1, 1});
  const DepthMapScore score = Score(depth, truth, {{10, kMetres}});
  EXPECT_EQ(score.num_invalid, 4);
  EXPECT_EQ(score.num_estimates, 0);
  EXPECT_EQ(score.num_measurements, 5);
  EXPECT_EQ(score.Completeness(0), 0);
  EXPECT_TRUE(std::isnan(score.Accuracy(0)));
  EXPECT_EQ(score.F1(0), 0);
  EXPECT_TRUE(std::isnan(score.median_absolute_error));
}

TEST(DepthMapScoreTest, WhatIsNoDepthIsNoMeasurement) {
  const Map<float> depth = MakeMap(4, 1, {1, 1, 1, 1});
  const Map<float> truth = MakeMap(4, 1, {kNaN, kInf, -2, 0});
  const DepthMapScore score = Score(depth, truth, {{10, kMetres}});
  EXPECT_EQ(score.num_measurements, 0);
  EXPECT_EQ(score.num_estimates, 4);
  EXPECT_EQ(score.num_estimates_measured, 0);
  EXPECT_TRUE(std::isnan(score.Completeness(0)));
  EXPECT_TRUE(std::isnan(score.F1(0)));
}

TEST(DepthMapScoreTest, SmallMapAgainstLargeTruth) {
  // Every pixel of the map covers 2x2 measurements; the centre of a map pixel
  // lies on the corner of the lower right one of them.
  const Map<float> depth = MakeMap(2, 1, {1, 0});
  const Map<float> truth = MakeMap(4, 2,
                                   {1, 1, 1, 1,  //
                                    1, 3, 0, 1});
  const DepthMapScore score = Score(depth, truth, {{0.5, kMetres}});
  EXPECT_EQ(score.num_measurements, 7);
  EXPECT_EQ(score.num_measurements_covered, 4);
  EXPECT_EQ(score.num_complete[0], 3);
  EXPECT_EQ(score.num_estimates_measured, 1);
  EXPECT_EQ(score.num_accurate[0], 0);
}

TEST(DepthMapScoreTest, LargeMapAgainstSmallTruth) {
  const Map<float> depth = MakeMap(4, 2,
                                   {1, 1, 1, 1,  //
                                    1, 3, 0, 1});
  const Map<float> truth = MakeMap(2, 1, {1, 0});
  const DepthMapScore score = Score(depth, truth, {{0.5, kMetres}});
  EXPECT_EQ(score.num_pixels, 8);
  EXPECT_EQ(score.num_estimates, 7);
  EXPECT_EQ(score.num_estimates_measured, 4);
  EXPECT_EQ(score.num_accurate[0], 3);
  EXPECT_EQ(score.num_measurements, 1);
  EXPECT_EQ(score.num_complete[0], 0);
}

TEST(DepthMapScoreTest, MaskLeavesPixelsOut) {
  const Map<float> depth = MakeMap(2, 1, {1, 7});
  const Map<float> truth = MakeMap(4, 2,
                                   {1, 1, 1, 1,  //
                                    1, 1, 1, 1});
  Map<uint8_t> mask(4, 2, 0);
  mask.At(0, 0) = 1;
  mask.At(1, 1) = 255;
  const DepthMapScore score = Score(depth, truth, {{0.5, kMetres}}, &mask);
  EXPECT_EQ(score.num_pixels, 1);
  EXPECT_EQ(score.num_estimates, 1);
  EXPECT_EQ(score.num_measurements, 2);
  EXPECT_EQ(score.Completeness(0), 1);
  EXPECT_EQ(score.Accuracy(0), 1);
  EXPECT_EQ(score.median_absolute_error, 0);
}

TEST(DepthMapScoreTest, OverallCountsEveryPixelTheSame) {
  DepthMapScorer scorer({{0.5, kMetres}});
  EXPECT_EQ(scorer.Overall().num_maps, 0);
  EXPECT_TRUE(std::isnan(scorer.Overall().F1(0)));
  scorer.Add(MakeMap(3, 1, {2, 3, 4}), MakeMap(3, 1, {1, 1, 1}));
  const DepthMapScore second =
      scorer.Add(MakeMap(2, 2, {1, 1, 1, 6}), MakeMap(2, 2, {1, 1, 1, 1}));
  EXPECT_EQ(second.median_absolute_error, 0);
  const DepthMapScore overall = scorer.Overall();
  EXPECT_EQ(overall.num_maps, 2);
  EXPECT_EQ(overall.num_pixels, 7);
  EXPECT_DOUBLE_EQ(overall.Completeness(0), 3.0 / 7);
  EXPECT_DOUBLE_EQ(overall.Accuracy(0), 3.0 / 7);
  EXPECT_EQ(overall.median_absolute_error, 1);  // of 0 0 0 1 2 3 5
}

TEST(DepthMapScoreTest, SizesThatAreTheSameShape) {
  const struct {
    int width, height, truth_width, truth_height;
    bool same;
  } cases[] = {
      {768, 512, 1536, 1024, true},  {1, 1, 1, 1, true},
      {1536, 1024, 768, 512, true},  {667, 1000, 4000, 6000, true},
      {500, 333, 6000, 4000, true},  {500, 334, 6000, 4000, true},
      {512, 768, 1536, 1024, false}, {760, 480, 1536, 1024, false},
      {100, 50, 100, 100, false},    {500, 340, 6000, 4000, false},
  };
  for (const auto& c : cases) {
    const Map<float> depth(c.width, c.height);
    const Map<float> truth(c.truth_width, c.truth_height);
    if (c.same) {
      EXPECT_NO_THROW(Score(depth, truth, {})) << c.width << " " << c.height;
    } else {
      EXPECT_THROW(Score(depth, truth, {}), std::invalid_argument)
          << c.width << " " << c.height;
    }
  }
}

TEST(DepthMapScoreTest, RejectsEmptyMapsAndWrongMasks) {
  const Map<float> map(4, 3);
  const Map<uint8_t> mask(3, 4);
  EXPECT_THROW(Score(Map<float>(), map, {}), std::invalid_argument);
  EXPECT_THROW(Score(map, Map<float>(), {}), std::invalid_argument);
  EXPECT_THROW(Score(map, map, {}, &mask), std::invalid_argument);
}

TEST(DepthMapScoreTest, CorrespondingPixelsContainTheCentre) {
  EXPECT_EQ(CorrespondingPixels(4, 4), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(CorrespondingPixels(4, 2), (std::vector<int>{0, 0, 1, 1}));
  EXPECT_EQ(CorrespondingPixels(2, 4), (std::vector<int>{1, 3}));
  EXPECT_EQ(CorrespondingPixels(3, 5), (std::vector<int>{0, 2, 4}));
  EXPECT_EQ(CorrespondingPixels(3, 1), (std::vector<int>{0, 0, 0}));
}

// Independent of the code under test: pixels by floating-point centres, shares
// by their definitions, medians by sorting.
TEST(DepthMapScoreTest, AgreesWithBruteForce) {
  std::mt19937 generator(7);
  const auto random_map = [&generator](int width, int height) {
    std::uniform_real_distribution<float> depth(1, 3);
    std::uniform_int_distribution<int> kind(0, 9);
    Map<float> map(width, height);
    for (size_t i = 0; i < map.size(); ++i) {
      const int k = kind(generator);
      map.data()[i] = k == 0 ? 0 : k == 1 ? kNaN : depth(generator);
    }
    return map;
  };
  const auto is_depth = [](float value) { return value > 0; };
  const struct {
    int width, height, truth_width, truth_height;
  } sizes[] = {{31, 23, 31, 23}, {30, 20, 45, 30}, {50, 41, 23, 19}};
  const std::vector<Tolerance> tolerances = {{0.1, kMetres}, {20, kPercent}};
  for (const auto& size : sizes) {
    const Map<float> depth = random_map(size.width, size.height);
    const Map<float> truth = random_map(size.truth_width, size.truth_height);
    const auto at = [](const Map<float>& map, double x, double y) {
      return map.At(static_cast<int>(std::floor(y * map.height() + 1e-9)),
                    static_cast<int>(std::floor(x * map.width() + 1e-9)));
    };
    int measured = 0, covered = 0, judged = 0;
    std::vector<int> met(2), right(2);
    std::vector<double> errors;
    for (int row = 0; row < truth.height(); ++row) {
      for (int col = 0; col < truth.width(); ++col) {
        const double g = truth.At(row, col);
        if (!is_depth(truth.At(row, col))) continue;
        ++measured;
        const double d = at(depth, (col + 0.5) / truth.width(),
                            (row + 0.5) / truth.height());
        if (!(d > 0)) continue;
        ++covered;
        met[0] += std::abs(d - g) <= 0.1;
        met[1] += std::abs(d - g) <= 0.2 * g;
      }
    }
    for (int row = 0; row < depth.height(); ++row) {
      for (int col = 0; col < depth.width(); ++col) {
        const double d = depth.At(row, col);
        if (!(d > 0)) continue;
        const double g = at(truth, (col + 0.5) / depth.width(),
                            (row + 0.5) / depth.height());
        if (!(g > 0)) continue;
        ++judged;
        errors.push_back(std::abs(d - g));
        right[0] += std::abs(d - g) <= 0.1;
        right[1] += std::abs(d - g) <= 0.2 * g;
      }
    }
    std::sort(errors.begin(), errors.end());
    const double median =
        0.5 * (errors[(errors.size() - 1) / 2] + errors[errors.size() / 2]);

    const DepthMapScore score = Score(depth, truth, tolerances);
    EXPECT_EQ(score.num_measurements, measured);
    EXPECT_EQ(score.num_measurements_covered, covered);
    EXPECT_EQ(score.num_estimates_measured, judged);
    EXPECT_NEAR(score.median_absolute_error, median, 1e-6);
    for (int i = 0; i < 2; ++i) {
      EXPECT_EQ(score.num_complete[i], met[i]);
      EXPECT_EQ(score.num_accurate[i], right[i]);
      EXPECT_NEAR(score.F1(i),
                  2.0 / (1.0 * measured / met[i] + 1.0 * judged / right[i]),
                  1e-12);
    }
  }
}

}  // namespace
}  // namespace tapa
