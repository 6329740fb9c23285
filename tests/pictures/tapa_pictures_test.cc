#include "src/pictures/tapa_pictures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "src/mvs/sweep/hypotheses.h"
#include "src/pictures/color_map.h"

namespace tapa {
namespace {

constexpr int kWidth = 120;
constexpr int kHeight = 60;

bool AreEqual(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() &&
         cv::norm(a, b, cv::NORM_INF) == 0;
}

// A view whose parts are all there: a superpixel with a plane on the left, one
// without on the right.
class TapaPicturesTest : public testing::Test {
 protected:
  TapaPicturesTest()
      : photograph_(kWidth, kHeight, {10, 20, 30}),
        depth_(kWidth, kHeight, 2.0f),
        normal_(kWidth, kHeight, {0, 0, -1}) {
    record_.textureness = Map<float>(kWidth, kHeight, 0.5f);
    record_.textureness.At(0, 1) = 0.75f;
    record_.textureness.At(0, 2) = 1;
    Map<uint16_t> labels(kWidth, kHeight, 0);
    for (int row = 0; row < kHeight; ++row) {
      std::fill(labels.Row(row) + kWidth / 2, labels.Row(row) + kWidth, 1);
    }
    for (Segmentation* segmentation : {&record_.fine, &record_.coarse}) {
      segmentation->superpixels.labels = labels;
      segmentation->superpixels.neighbors.resize(2);
      segmentation->planes.resize(2);
      segmentation->planes[0].plane.normal = {0, 0, -1};
      segmentation->planes[0].inlier_ratio = 0.5f;
    }
    record_.chosen = Map<uint8_t>(kWidth, kHeight, kCurrent);
    record_.chosen.At(0, 1) = kFinePlane;
    record_.swept_depth = Map<float>(kWidth, kHeight, 2.0f);
    record_.swept_depth.At(0, 1) = 4;
    record_.filtered_depth = record_.swept_depth;
    record_.filtered_depth.At(0, 1) = 0;
    record_.agreement = Map<float>(kWidth, kHeight, 1.0f);
    record_.agreement.At(0, 1) = 0;
    record_.origin = Map<uint8_t>(kWidth, kHeight, kSwept);
    record_.origin.At(0, 1) = kFilled;
    record_.origin.At(0, 2) = kNoEstimate;
    // Enough for the robust range.
    for (int col = 0; col < kWidth; ++col) {
      depth_.At(1, col) = depth_.At(2, col) = 4;
    }
    depth_.At(0, 2) = 0;
    normal_.At(0, 2) = Vec3();
    view_.title = "a photograph";
    view_.photograph = &photograph_;
    view_.record = &record_;
    view_.depth = &depth_;
    view_.normal = &normal_;
  }

  std::map<std::string, cv::Mat> Draw() const {
    std::map<std::string, cv::Mat> pictures;
    for (const NamedPicture& picture : DrawTapaPictures(view_)) {
      EXPECT_EQ(picture.image.type(), CV_8UC3) << picture.name;
      EXPECT_TRUE(pictures.emplace(picture.name, picture.image).second);
    }
    return pictures;
  }

  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const NamedPicture& picture : DrawTapaPictures(view_)) {
      names.push_back(picture.name);
    }
    return names;
  }

  std::vector<std::string> AllNamesBut(const std::set<std::string>& missing) {
    std::vector<std::string> names;
    for (const std::string& name : TapaPictureNames()) {
      if (missing.count(name) == 0) {
        names.push_back(name);
      }
    }
    return names;
  }

  Map<Rgb> photograph_;
  Map<float> depth_;
  Map<Vec3> normal_;
  TapaRecord record_;
  TapaView view_;
};

cv::Vec3b At(const cv::Mat& image, int row, int col) {
  return image.at<cv::Vec3b>(row, col);
}

TEST_F(TapaPicturesTest, AllHaveTheSizeOfTheView) {
  EXPECT_EQ(Names(), TapaPictureNames());
  for (const auto& [name, image] : Draw()) {
    if (name != "00_legend") {
      EXPECT_EQ(image.size(), cv::Size(kWidth, kHeight)) << name;
    }
  }
}

TEST_F(TapaPicturesTest, KnownPixels) {
  std::map<std::string, cv::Mat> pictures = Draw();
  // OpenCV's order: blue, green, red.
  EXPECT_EQ(At(pictures["01_photograph"], 0, 0), cv::Vec3b(30, 20, 10));

  const cv::Mat& textureness = pictures["02_textureness"];
  EXPECT_EQ(At(textureness, 0, 0), cv::Vec3b(0, 0, 0));
  EXPECT_EQ(At(textureness, 0, 1), cv::Vec3b(128, 128, 128));
  EXPECT_EQ(At(textureness, 0, 2), cv::Vec3b(255, 255, 255));

  for (const char* name : {"03_fine_superpixels", "04_coarse_superpixels"}) {
    for (int col = 0; col < kWidth; ++col) {
      EXPECT_EQ(At(pictures[name], 5, col),
                col == kWidth / 2 - 1 ? kBorderColor : cv::Vec3b(30, 20, 10))
          << name << ", column " << col;
    }
  }
  for (const char* name : {"05_fine_planes", "06_coarse_planes"}) {
    // Half as bright as NormalColor: half of the points are inliers.
    EXPECT_EQ(At(pictures[name], 1, 1), cv::Vec3b(128, 64, 64)) << name;
    EXPECT_EQ(At(pictures[name], 1, kWidth - 1), kNoEstimateColor) << name;
    // The inlier ratio stands in the middle of the left one only.
    std::set<std::tuple<int, int, int>> left, right;
    for (int row = 0; row < kHeight; ++row) {
      for (int col = 0; col < kWidth; ++col) {
        const cv::Vec3b color = At(pictures[name], row, col);
        (col < kWidth / 2 - 1 ? left : right)
            .insert({color[0], color[1], color[2]});
      }
    }
    EXPECT_GT(left.size(), 2) << name;
    EXPECT_EQ(right.size(), 2) << name;
  }

  const cv::Mat& chosen = pictures["07_chosen_hypotheses"];
  EXPECT_EQ(At(chosen, 0, 0), HypothesisColor(kCurrent));
  EXPECT_EQ(At(chosen, 0, 1), HypothesisColor(kFinePlane));

  const DepthRange range = {2, 4};
  for (const char* name : {"08_swept_depth", "09_filtered_depth"}) {
    EXPECT_EQ(At(pictures[name], 0, 0), DepthColor(2, range)) << name;
  }
  EXPECT_EQ(At(pictures["08_swept_depth"], 0, 1), DepthColor(4, range));
  EXPECT_EQ(At(pictures["09_filtered_depth"], 0, 1), kNoEstimateColor);
  EXPECT_EQ(At(pictures["12_final_depth"], 0, 0), DepthColor(2, range));
  EXPECT_EQ(At(pictures["12_final_depth"], 1, 0), DepthColor(4, range));
  EXPECT_EQ(At(pictures["12_final_depth"], 0, 2), kNoEstimateColor);

  EXPECT_EQ(At(pictures["10_plane_agreement"], 0, 0), cv::Vec3b(255, 255, 255));
  EXPECT_EQ(At(pictures["10_plane_agreement"], 0, 1), cv::Vec3b(0, 0, 0));
  EXPECT_EQ(At(pictures["11_origin"], 0, 0), OriginColor(kSwept));
  EXPECT_EQ(At(pictures["11_origin"], 0, 1), OriginColor(kFilled));
  EXPECT_EQ(At(pictures["11_origin"], 0, 2), OriginColor(kNoEstimate));
  EXPECT_EQ(At(pictures["13_final_normals"], 0, 0), NormalColor({0, 0, -1}));
  EXPECT_EQ(At(pictures["13_final_normals"], 0, 2), kNoEstimateColor);
}

TEST_F(TapaPicturesTest, EveryCategoryHasAColorOfItsOwn) {
  std::set<std::tuple<int, int, int>> colors;
  for (int i = 0; i < kNumHypotheses; ++i) {
    const cv::Vec3b color = HypothesisColor(i);
    EXPECT_TRUE(colors.insert({color[0], color[1], color[2]}).second) << i;
  }
  colors.clear();
  for (int i = kNoEstimate; i <= kFilled; ++i) {
    const cv::Vec3b color = OriginColor(i);
    EXPECT_TRUE(colors.insert({color[0], color[1], color[2]}).second) << i;
  }
  EXPECT_EQ(OriginColor(kNoEstimate), kNoEstimateColor);
  // There is no such hypothesis.
  EXPECT_EQ(HypothesisColor(255), kNoEstimateColor);
  EXPECT_EQ(HypothesisColor(-1), kNoEstimateColor);
}

TEST_F(TapaPicturesTest, PartsThatAreOff) {
  record_.coarse = Segmentation();
  EXPECT_EQ(Names(),
            AllNamesBut({"04_coarse_superpixels", "06_coarse_planes"}));
  record_.fine = Segmentation();
  record_.agreement = Map<float>();
  EXPECT_EQ(Names(), AllNamesBut({"03_fine_superpixels",
                                  "04_coarse_superpixels", "05_fine_planes",
                                  "06_coarse_planes", "10_plane_agreement"}));
  record_ = TapaRecord();
  EXPECT_EQ(Names(),
            (std::vector<std::string>{"00_legend", "01_photograph",
                                      "12_final_depth", "13_final_normals"}));
}

TEST_F(TapaPicturesTest, NoPlanesYet) {
  record_.fine.planes.clear();
  EXPECT_EQ(Names(), AllNamesBut({"05_fine_planes"}));
}

TEST_F(TapaPicturesTest, LegendSaysWhatIsThere) {
  const cv::Mat all = Draw()["00_legend"];
  for (int col = 0; col < kWidth; ++col) {
    record_.chosen.At(3, col) = kRandom;
  }
  EXPECT_FALSE(AreEqual(Draw()["00_legend"], all))
      << "shares of the hypotheses";
  record_.chosen = Map<uint8_t>();
  record_.origin = Map<uint8_t>();
  EXPECT_LT(Draw()["00_legend"].rows, all.rows);
  // The longest title fits.
  view_.title = std::string(300, 'x');
  EXPECT_EQ(Draw()["00_legend"].cols, all.cols);
}

TEST_F(TapaPicturesTest, NoFinalDepth) {
  // The depth after the last sweep still shows its range.
  depth_ = Map<float>(kWidth, kHeight, 0.0f);
  for (int col = 0; col < kWidth; ++col) {
    record_.swept_depth.At(1, col) = record_.swept_depth.At(2, col) = 4;
  }
  std::map<std::string, cv::Mat> pictures = Draw();
  EXPECT_EQ(At(pictures["08_swept_depth"], 0, 0), DepthColor(2, {2, 4}));
  EXPECT_EQ(At(pictures["08_swept_depth"], 1, 0), DepthColor(4, {2, 4}));
  EXPECT_EQ(At(pictures["12_final_depth"], 0, 0), kNoEstimateColor);
}

TEST_F(TapaPicturesTest, OddValues) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  view_.min_textureness = 1;
  record_.textureness.At(0, 0) = nan;
  record_.agreement.At(0, 0) = infinity;
  record_.swept_depth.At(0, 0) = nan;
  record_.fine.planes[0].inlier_ratio = nan;
  record_.coarse.planes[0].inlier_ratio = 2;
  depth_.At(0, 0) = infinity;
  normal_.At(0, 0) = {nan, 0, 0};
  std::map<std::string, cv::Mat> pictures = Draw();
  EXPECT_EQ(At(pictures["12_final_depth"], 0, 0), kNoEstimateColor);
  EXPECT_EQ(At(pictures["05_fine_planes"], 1, 1), kNoEstimateColor);
}

TEST_F(TapaPicturesTest, SmallAndLargeViews) {
  const cv::Size sizes[] = {{1, 1}, {1, 40}, {3, 2}, {1500, 20}};
  for (const cv::Size& size : sizes) {
    photograph_ = Map<Rgb>(size.width, size.height);
    depth_ = Map<float>(size.width, size.height, 1.0f);
    normal_ = Map<Vec3>(size.width, size.height);
    record_ = TapaRecord();
    record_.fine.superpixels.labels = Map<uint16_t>(size.width, size.height, 0);
    record_.fine.superpixels.neighbors.resize(1);
    record_.fine.planes.resize(1);
    record_.fine.planes[0].inlier_ratio = 1;
    record_.fine.planes[0].plane.normal = {0, 0, -1};
    EXPECT_EQ(Draw()["05_fine_planes"].size(), size);
  }
}

TEST_F(TapaPicturesTest, RefusesWhatDoesNotFit) {
  record_.origin = Map<uint8_t>(kWidth, kHeight - 1, 0);
  EXPECT_THROW(DrawTapaPictures(view_), std::invalid_argument);
  record_.origin = Map<uint8_t>();
  record_.fine.planes.resize(1);
  EXPECT_THROW(DrawTapaPictures(view_), std::invalid_argument);
  record_.fine.planes.clear();
  EXPECT_NO_THROW(DrawTapaPictures(view_));
  depth_ = Map<float>();
  EXPECT_THROW(DrawTapaPictures(view_), std::invalid_argument);
  view_.depth = nullptr;
  EXPECT_THROW(DrawTapaPictures(view_), std::invalid_argument);
}

}  // namespace
}  // namespace tapa
