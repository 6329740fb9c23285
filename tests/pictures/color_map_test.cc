#include "src/pictures/color_map.h"

#include <gtest/gtest.h>

#include <limits>

namespace tapa {
namespace {

TEST(ColorMapTest, RobustDepthRange) {
  Map<float> depth(101, 2, 0.0f);
  for (int i = 0; i <= 100; ++i) depth.At(1, i) = 1.0f + i;
  depth.At(0, 0) = std::numeric_limits<float>::quiet_NaN();
  depth.At(0, 1) = -5;
  EXPECT_EQ(RobustDepthRange(depth).near, 3);
  EXPECT_EQ(RobustDepthRange(depth).far, 99);
  EXPECT_EQ(RobustDepthRange(Map<float>(3, 3, 0.0f)).near, 1);
}

TEST(ColorMapTest, DepthIsRedNearAndBlueFar) {
  const DepthRange range = {1, 4};
  const cv::Vec3b near = DepthColor(1, range);
  const cv::Vec3b far = DepthColor(4, range);
  EXPECT_GT(near[2], near[0]);
  EXPECT_GT(far[0], far[2]);
  EXPECT_EQ(DepthColor(0.5f, range), near);
  EXPECT_EQ(DepthColor(100, range), far);
  // Neither a range of no extent nor the least of floats may go astray.
  const float least = std::numeric_limits<float>::denorm_min();
  const float most = std::numeric_limits<float>::max();
  EXPECT_EQ(DepthColor(3, {3, 3}), DepthColor(5, {3, 3}));
  EXPECT_EQ(DepthColor(least, {least, most}), near);
}

TEST(ColorMapTest, MissingPixels) {
  Map<float> depth(4, 1, 0.0f);
  depth.At(0, 1) = std::numeric_limits<float>::quiet_NaN();
  depth.At(0, 2) = -1;
  depth.At(0, 3) = 2;
  const cv::Mat colors = ColorDepth(depth, {1, 4});
  for (int col = 0; col < 3; ++col) {
    EXPECT_EQ(colors.at<cv::Vec3b>(0, col), kNoEstimateColor);
  }
  EXPECT_EQ(colors.at<cv::Vec3b>(0, 3), DepthColor(2, {1, 4}));
}

TEST(ColorMapTest, Normals) {
  // OpenCV's order: blue, green, red.
  EXPECT_EQ(NormalColor({0, 0, -1}), cv::Vec3b(255, 128, 128));
  EXPECT_EQ(NormalColor({1, 0, 0}), cv::Vec3b(128, 128, 255));
  EXPECT_EQ(NormalColor({0, -1, 0}), cv::Vec3b(128, 255, 128));
  EXPECT_EQ(NormalColor({0, 0, 0}), kNoEstimateColor);
  EXPECT_EQ(NormalColor({std::numeric_limits<float>::quiet_NaN(), 0, 0}),
            kNoEstimateColor);
}

}  // namespace
}  // namespace tapa
