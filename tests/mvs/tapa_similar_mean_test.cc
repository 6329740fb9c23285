#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "src/mvs/tapa/similar_mean.h"

namespace tapa {
namespace {

constexpr int kRadius = 2;
constexpr double kVariance = 0.001;

struct Line {
  double slope;
  double offset;
};

// Of the guide's intensities to the values, by least squares in the square
// around a pixel.
Line FitLine(const Map<uint8_t>& image, const Map<float>& values, int row,
             int col) {
  double n = 0;
  double sum_i = 0;
  double sum_v = 0;
  double sum_ii = 0;
  double sum_iv = 0;
  for (int r = row - kRadius; r <= row + kRadius; ++r) {
    for (int c = col - kRadius; c <= col + kRadius; ++c) {
      const double i = image.At(r, c) / 255.0;
      const double v = values.At(r, c);
      n += 1;
      sum_i += i;
      sum_v += v;
      sum_ii += i * i;
      sum_iv += i * v;
    }
  }
  const double covariance = sum_iv / n - sum_i / n * (sum_v / n);
  const double variance = sum_ii / n - sum_i / n * (sum_i / n);
  const double slope = covariance / (variance + kVariance);
  return {slope, sum_v / n - slope * sum_i / n};
}

// Far from the border.
double NaiveGuidedFilter(const Map<uint8_t>& image, const Map<float>& values,
                         int row, int col) {
  double sum = 0;
  double n = 0;
  for (int r = row - kRadius; r <= row + kRadius; ++r) {
    for (int c = col - kRadius; c <= col + kRadius; ++c) {
      const Line line = FitLine(image, values, r, c);
      sum += line.slope * image.At(row, col) / 255.0 + line.offset;
      n += 1;
    }
  }
  return sum / n;
}

TEST(SimilarMean, IsThatOfTheGuidedFilter) {
  std::mt19937 random(1);
  Map<uint8_t> image(30, 20);
  Map<float> values(30, 20);
  Map<float> weights(30, 20);
  for (size_t i = 0; i < image.size(); ++i) {
    image.data()[i] = static_cast<uint8_t>(random() % 256);
    weights.data()[i] = random() % 4 == 0 ? 0.0f : 1.0f;
    values.data()[i] =
        weights.data()[i] * static_cast<float>(random() % 100) / 10;
  }
  const Map<float> means =
      MeanOverSimilarPixels(image, values, weights, kRadius, kVariance);
  for (int row = 2 * kRadius; row < 20 - 2 * kRadius; ++row) {
    for (int col = 2 * kRadius; col < 30 - 2 * kRadius; ++col) {
      const double expected = NaiveGuidedFilter(image, values, row, col) /
                              NaiveGuidedFilter(image, weights, row, col);
      EXPECT_NEAR(means.At(row, col), expected, 0.01);
    }
  }
}

// An even surface on the left, another on the right.
TEST(SimilarMean, SpreadsOverASurfaceAndEndsAtItsEdge) {
  Map<uint8_t> image(40, 20, 50);
  Map<float> values(40, 20);
  const Map<float> weights(40, 20, 1);
  for (int row = 0; row < 20; ++row) {
    for (int col = 0; col < 40; ++col) {
      if (col >= 20) {
        image.At(row, col) = 200;
      }
      // On the left nine on the mean, but in every other pixel.
      values.At(row, col) = col >= 20 ? -5.0f : (row + col) % 2 == 0 ? 18 : 0;
    }
  }
  const Map<float> means =
      MeanOverSimilarPixels(image, values, weights, 5, 0.00005);
  for (int row = 0; row < 20; ++row) {
    EXPECT_NEAR(means.At(row, 10), 9, 0.5);
    EXPECT_NEAR(means.At(row, 19), 9, 0.5);
    EXPECT_NEAR(means.At(row, 20), -5, 0.5);
  }
}

TEST(SimilarMean, LeavesOutWhatDoesNotCount) {
  const Map<uint8_t> image(20, 20, 50);
  Map<float> values(20, 20);
  Map<float> weights(20, 20);
  for (int row = 0; row < 20; ++row) {
    for (int col = 0; col < 10; ++col) {
      values.At(row, col) = 4;
      weights.At(row, col) = 1;
    }
  }
  const Map<float> means =
      MeanOverSimilarPixels(image, values, weights, 3, 0.00005);
  for (int row = 0; row < 20; ++row) {
    for (int col = 0; col < 12; ++col) {
      EXPECT_NEAR(means.At(row, col), 4, 1e-3);
    }
    // None around counts.
    EXPECT_EQ(means.At(row, 19), 0);
  }
}

// completion_radius may be 0 or all of the width, and images may be tiny.
TEST(SimilarMean, TakesAnyRadius) {
  const Map<uint8_t> image(7, 1, 50);
  Map<float> values(7, 1);
  const Map<float> weights(7, 1, 1);
  for (int col = 0; col < 7; ++col) {
    values.At(0, col) = static_cast<float>(col);
  }
  const Map<float> same =
      MeanOverSimilarPixels(image, values, weights, 0, 0.00005);
  const Map<float> wide =
      MeanOverSimilarPixels(image, values, weights, 700, 0.00005);
  for (int col = 0; col < 7; ++col) {
    EXPECT_NEAR(same.At(0, col), values.At(0, col), 1e-3);
    EXPECT_NEAR(wide.At(0, col), 3, 0.05);
  }
}

}  // namespace
}  // namespace tapa
