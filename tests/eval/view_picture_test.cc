#include "src/eval/view_picture.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace tapa {
namespace {

TEST(DrawView, AnySizeAndAnyPanels) {
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

TEST(DrawView, PhotographAndDepthAreRequired) {
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
