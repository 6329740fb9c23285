#include "src/eval/pictures.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <vector>

#include "src/eval/color_map.h"

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
  Map<float> truth(4, 1, 2.0f);
  const cv::Mat colors = ColorDepth(depth, {1, 4});
  const cv::Mat error = ColorError(depth, truth);
  for (int col = 0; col < 3; ++col) {
    EXPECT_EQ(colors.at<cv::Vec3b>(0, col), kNoEstimateColor);
    EXPECT_EQ(error.at<cv::Vec3b>(0, col), kNoEstimateColor);
  }
  EXPECT_EQ(error.at<cv::Vec3b>(0, 3), ErrorColor(0));
  truth.At(0, 3) = 0;
  EXPECT_EQ(ColorError(depth, truth).at<cv::Vec3b>(0, 3), kNoMeasurementColor);
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

TEST(ColorMapTest, ErrorGoesFromGreenToRed) {
  const cv::Vec3b low = ErrorColor(0);
  const cv::Vec3b high = ErrorColor(0.5f);
  EXPECT_GT(low[1], low[2]);
  EXPECT_GT(high[2], high[1]);
  EXPECT_EQ(ErrorColor(kLeastError), low);
  EXPECT_EQ(ErrorColor(kMostError), high);
  EXPECT_EQ(ErrorColor(std::numeric_limits<float>::infinity()), high);
}

TEST(PicturesTest, AnySizeAndAnyPanels) {
  const struct {
    int width, height;
  } sizes[] = {{1, 1}, {5, 3000}, {3000, 5}, {720, 480}, {480, 720}};
  for (const auto& size : sizes) {
    const Map<float> depth(size.width, size.height, 2.0f);
    const Map<Vec3> normal(size.width, size.height, {0, 0, -1});
    const Map<float> truth(2 * size.width, 2 * size.height, 2.0f);
    for (int panels = 0; panels < 4; ++panels) {
      ViewPicture view;
      view.title = "a/very/long/name/of/a/photograph/in/many/folders/0001.jpg";
      view.photograph =
          cv::Mat(size.height, size.width, CV_8UC3, cv::Scalar(1, 2, 3));
      view.depth = &depth;
      if (panels % 2 == 1) view.normal = &normal;
      if (panels / 2 == 1) view.ground_truth = &truth;
      view.notes = {"coverage 100 %", "median error 0 %"};
      const cv::Mat picture = DrawView(view);
      EXPECT_EQ(picture.type(), CV_8UC3);
      EXPECT_LE(picture.cols, 2000);
      EXPECT_GT(picture.cols, 300);
      EXPECT_LE(picture.rows, 2000);
    }
  }
}

TEST(PicturesTest, PhotographAndDepthAreRequired) {
  const Map<float> depth(2, 2, 1.0f);
  ViewPicture view;
  view.depth = &depth;
  EXPECT_THROW(DrawView(view), std::invalid_argument);
  view.photograph = cv::Mat(2, 2, CV_8UC3, cv::Scalar(1, 2, 3));
  EXPECT_NO_THROW(DrawView(view));
  view.depth = nullptr;
  EXPECT_THROW(DrawView(view), std::invalid_argument);
}

}  // namespace
}  // namespace tapa
