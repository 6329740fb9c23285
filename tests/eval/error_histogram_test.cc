#include "src/eval/error_histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace tapa {
namespace {

TEST(ErrorHistogramTest, FewValuesAreExact) {
  ErrorHistogram histogram;
  EXPECT_TRUE(std::isnan(histogram.Median()));
  histogram.Add(4);
  EXPECT_EQ(histogram.Median(), 4);
  histogram.Add(0);
  EXPECT_EQ(histogram.Median(), 2);
  histogram.Add(0.25f);
  EXPECT_EQ(histogram.Median(), 0.25);
  histogram.Add(0.001f);
  EXPECT_DOUBLE_EQ(histogram.Median(), 0.5 * (0.25 + 0.001f));
}

TEST(ErrorHistogramTest, ExtremesHaveAPlace) {
  ErrorHistogram histogram;
  histogram.Add(1e-30f);
  EXPECT_EQ(histogram.Median(), 0);
  histogram.Add(std::numeric_limits<float>::max());
  histogram.Add(std::numeric_limits<float>::infinity());
  EXPECT_EQ(histogram.Median(), std::numeric_limits<double>::infinity());
}

TEST(ErrorHistogramTest, AgreesWithSorting) {
  std::mt19937 generator(3);
  std::lognormal_distribution<float> distribution(-5, 3);
  for (const int count : {1000, 1001, 100000}) {
    ErrorHistogram histogram;
    std::vector<float> values(count);
    for (float& value : values) {
      value = distribution(generator);
      histogram.Add(value);
    }
    std::sort(values.begin(), values.end());
    const double median = 0.5 * (static_cast<double>(values[(count - 1) / 2]) +
                                 static_cast<double>(values[count / 2]));
    EXPECT_NEAR(histogram.Median(), median, 5e-4 * median) << count;
  }
}

}  // namespace
}  // namespace tapa
