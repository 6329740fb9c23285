#include "src/eval/error_colors.h"

#include <gtest/gtest.h>

#include <limits>

#include "src/pictures/color_map.h"

namespace tapa {
namespace {

TEST(ErrorColors, MissingPixels) {
  Map<float> depth(4, 1, 0.0f);
  depth.At(0, 1) = std::numeric_limits<float>::quiet_NaN();
  depth.At(0, 2) = -1;
  depth.At(0, 3) = 2;
  Map<float> truth(4, 1, 2.0f);
  const cv::Mat error = ColorError(depth, truth);
  for (int col = 0; col < 3; ++col) {
    EXPECT_EQ(error.at<cv::Vec3b>(0, col), kNoEstimateColor);
  }
  EXPECT_EQ(error.at<cv::Vec3b>(0, 3), ErrorColor(0));
  truth.At(0, 3) = 0;
  EXPECT_EQ(ColorError(depth, truth).at<cv::Vec3b>(0, 3), kNoMeasurementColor);
}

TEST(ErrorColors, GoesFromGreenToRed) {
  const cv::Vec3b low = ErrorColor(0);
  const cv::Vec3b high = ErrorColor(0.5f);
  EXPECT_GT(low[1], low[2]);
  EXPECT_GT(high[2], high[1]);
  EXPECT_EQ(ErrorColor(kLeastError), low);
  EXPECT_EQ(ErrorColor(kMostError), high);
  EXPECT_EQ(ErrorColor(std::numeric_limits<float>::infinity()), high);
}

}  // namespace
}  // namespace tapa
