#include "src/colmap/priors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "src/base/failure.h"
#include "tests/colmap/test_folder.h"

namespace tapa {
namespace {

constexpr int kWidth = 60;
constexpr int kHeight = 40;

// The floor z = 2 + y of the camera's frame: depth by the place in the image,
// in shares of its height.
double DepthAt(double y) { return 2 / (1 - (y - 0.5) * 0.8); }

SceneView SomeView(const std::string& name) {
  SceneView view;
  view.name = name;
  view.photo_width = 2 * kWidth;
  view.photo_height = 2 * kHeight;
  view.width = kWidth;
  view.height = kHeight;
  view.camera.fx = view.camera.fy = kHeight / 0.8;
  view.camera.cx = 0.5 * kWidth;
  view.camera.cy = 0.5 * kHeight;
  return view;
}

// Points that all views see, from the same place.
colmap::mvs::Model SomeModel(int num_points, const std::vector<int>& views) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> share(0.01f, 0.99f);
  colmap::mvs::Model model;
  for (int i = 0; i < num_points; ++i) {
    const float x = share(random);
    const float y = share(random);
    colmap::mvs::Model::Point point;
    point.z = static_cast<float>(DepthAt(y));
    point.x = point.z * (x - 0.5f) * kWidth / kHeight * 0.8f;
    point.y = point.z * (y - 0.5f) * 0.8f;
    point.track = views;
    model.points.push_back(point);
  }
  return model;
}

// scale * depth + shift, as an NPY file; scale 0: a slope from left to right.
void WritePrior(const std::string& path, int width, int height,
                double scale = 1, double shift = 0) {
  std::filesystem::create_directories(
      std::filesystem::path(path).parent_path());
  const std::string header =
      "{'descr': '<f4', 'fortran_order': False, 'shape': (" +
      std::to_string(height) + ", " + std::to_string(width) + "), }\n";
  std::ofstream file(path, std::ios::binary);
  file << "\x93NUMPY" << '\1' << '\0' << static_cast<char>(header.size())
       << '\0' << header;
  for (int i = 0; i < width * height; ++i) {
    const double depth = DepthAt((i / width + 0.5) / height);
    const float value =
        static_cast<float>(scale == 0 ? 1 + i % width : scale * depth + shift);
    file.write(reinterpret_cast<const char*>(&value), sizeof(value));
  }
}

class Priors : public testing::Test {
 protected:
  // Of views a.jpg, b.jpg and so on, which see so many points; what is printed
  // goes to output_.
  std::map<int, FittedPrior> Fit(int num_views, int num_points = 100) {
    std::vector<SceneView> scene;
    std::vector<int> views;
    for (int i = 0; i < num_views; ++i) {
      scene.push_back(
          SomeView(std::string(1, static_cast<char>('a' + i)) + ".jpg"));
      views.push_back(i);
    }
    testing::internal::CaptureStdout();
    std::map<int, FittedPrior> priors;
    try {
      priors = FitPriors(folder_.Path(""), SomeModel(num_points, views), scene,
                         views);
    } catch (...) {
      output_ = testing::internal::GetCapturedStdout();
      throw;
    }
    output_ = testing::internal::GetCapturedStdout();
    return priors;
  }

  std::string ErrorOfFit(int num_views) {
    try {
      Fit(num_views);
    } catch (const Failure& error) {
      return error.what();
    }
    return "";
  }

  bool Prints(const std::string& text) const {
    return output_.find(text) != std::string::npos;
  }

  const TestFolder folder_;
  std::string output_;
};

TEST_F(Priors, HaveTheNameOfTheirImage) {
  for (const std::string name : {"a.npy", "left/a.exr", "left/a.jpg.png"}) {
    std::filesystem::create_directories(folder_.Path("left"));
    std::ofstream(folder_.Path(name)) << "x";
    EXPECT_EQ(PriorPath(folder_.Path(""), "left/a.jpg"), folder_.Path(name));
    EXPECT_EQ(PriorPath(folder_.Path(""), "left/b.jpg"), "");
    EXPECT_EQ(PriorPath("", "left/a.jpg"), "");
  }
}

TEST_F(Priors, AreInSceneUnitsWhateverTheirSizeAndUnit) {
  for (const double scale : {0.01, 1.0, 1000.0}) {
    for (const int size : {1, 3}) {
      const int width = kWidth / 2 * size;
      const int height = kHeight / 2 * size;
      WritePrior(folder_.Path("a.npy"), width, height, scale, 3 * scale);
      const auto priors = Fit(1);
      ASSERT_EQ(priors.size(), 1u) << output_;
      EXPECT_TRUE(Prints("1 of 1 views have one, and 1 of them fit"));
      const Map<float> map = ReadPrior(priors.at(0));
      ASSERT_EQ(map.width(), width);
      ASSERT_EQ(map.height(), height);
      for (int row = 0; row < height; ++row) {
        EXPECT_NEAR(map.At(row, width / 2) / DepthAt((row + 0.5) / height), 1,
                    0.02);
      }
    }
  }
}

TEST_F(Priors, ThatDoNotFitAreLeftOut) {
  WritePrior(folder_.Path("a.npy"), kWidth, kHeight);
  WritePrior(folder_.Path("b.npy"), kWidth, kHeight, 0);
  const auto priors = Fit(3);
  ASSERT_EQ(priors.size(), 1u);
  EXPECT_EQ(priors.count(0), 1u);
  EXPECT_TRUE(Prints("b.npy does not fit")) << output_;
  EXPECT_TRUE(Prints("2 of 3 views have one, and 1 of them fit")) << output_;
}

TEST_F(Priors, NeedPoints) {
  WritePrior(folder_.Path("a.npy"), kWidth, kHeight);
  EXPECT_TRUE(Fit(1, 19).empty());
  EXPECT_TRUE(Prints("values at 19 sparse points")) << output_;
  EXPECT_TRUE(Fit(1, 0).empty());
}

TEST_F(Priors, OfOtherShapesAreRefused) {
  WritePrior(folder_.Path("a.npy"), kHeight, kWidth);
  EXPECT_NE(ErrorOfFit(1).find("has 40x60 pixels"), std::string::npos);
}

TEST_F(Priors, AreNotForgotten) {
  EXPECT_NE(ErrorOfFit(1).find("no depth maps in"), std::string::npos);
  const auto none = FitPriors("", {}, {SomeView("a.jpg")}, {0});
  EXPECT_TRUE(none.empty());
}

TEST_F(Priors, AreOfOneView) {
  WritePrior(folder_.Path("a.npy"), kWidth, kHeight);
  const std::vector<SceneView> scene = {SomeView("left/a.jpg"),
                                        SomeView("right/a.jpg")};
  try {
    FitPriors(folder_.Path(""), SomeModel(100, {0, 1}), scene, {0, 1});
    FAIL();
  } catch (const Failure& error) {
    EXPECT_NE(std::string(error.what()).find("both left/a.jpg and right/a.jpg"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace tapa
