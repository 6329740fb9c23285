#include "src/colmap/masks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "src/base/failure.h"
#include "tests/colmap/test_folder.h"
#include "util/bitmap.h"

namespace tapa {
namespace {

SceneView SomeView() {
  SceneView view;
  view.name = "left/a.jpg";
  view.photo_width = view.width = 12;
  view.photo_height = view.height = 8;
  return view;
}

// Black in the columns up to `num_black`, otherwise of this grey value.
void WriteMask(const std::string& path, int width, int height, int num_black,
               uint8_t grey = 255) {
  std::filesystem::create_directories(
      std::filesystem::path(path).parent_path());
  colmap::Bitmap bitmap;
  bitmap.Allocate(width, height, /* as_rgb */ false);
  for (int row = 0; row < height; ++row) {
    for (int col = 0; col < width; ++col) {
      bitmap.SetPixel(col, row,
                      colmap::BitmapColor<uint8_t>(col < num_black ? 0 : grey));
    }
  }
  ASSERT_TRUE(bitmap.Write(path));
}

// Number of columns, from the left, that are masked as a whole; the others are
// not.
int NumMasked(const Map<uint8_t>& mask) {
  int num_masked = 0;
  while (num_masked < mask.width() && mask.At(0, num_masked) == 1) {
    ++num_masked;
  }
  for (int row = 0; row < mask.height(); ++row) {
    for (int col = 0; col < mask.width(); ++col) {
      EXPECT_EQ(mask.At(row, col), col < num_masked ? 1 : 0);
    }
  }
  return num_masked;
}

std::string ErrorOf(const std::function<void()>& run) {
  try {
    run();
  } catch (const Failure& error) {
    return error.what();
  }
  return "";
}

TEST(ReadMask, IsBlackWhereItMasks) {
  const TestFolder folder;
  WriteMask(folder.Path("left/a.jpg.png"), 12, 8, 5, 1);
  const Map<uint8_t> mask = ReadMask(folder.Path(""), SomeView());
  ASSERT_EQ(mask.width(), 12);
  ASSERT_EQ(mask.height(), 8);
  EXPECT_EQ(NumMasked(mask), 5);
}

TEST(ReadMask, HasTheSizeThatStereoWorksAt) {
  const TestFolder folder;
  SceneView view = SomeView();
  // Of another size than the photograph.
  for (const int scale : {1, 2, 10}) {
    WriteMask(folder.Path("left/a.jpg.png"), 12 * scale, 8 * scale, 5 * scale);
    view.width = 12;
    view.height = 8;
    EXPECT_EQ(NumMasked(ReadMask(folder.Path(""), view)), 5);
    // Only what is masked as a whole: of the third pixel half is not.
    view.width = 6;
    view.height = 4;
    EXPECT_EQ(NumMasked(ReadMask(folder.Path(""), view)), 2);
  }
  WriteMask(folder.Path("left/a.jpg.png"), 6, 4, 2);
  view.width = 12;
  view.height = 8;
  EXPECT_EQ(NumMasked(ReadMask(folder.Path(""), view)), 4);
}

TEST(ReadMask, WithoutOneNothingIsMasked) {
  const TestFolder folder;
  EXPECT_TRUE(ReadMask("", SomeView()).empty());
  EXPECT_TRUE(ReadMask(folder.Path(""), SomeView()).empty());
  EXPECT_EQ(MaskPath("", "a.png"), "");
}

TEST(ReadMask, NamesWhatIsWrong) {
  const TestFolder folder;
  const std::string path = folder.Path("left/a.jpg.png");
  const auto error = [&folder] {
    return ErrorOf([&] { ReadMask(folder.Path(""), SomeView()); });
  };
  WriteMask(path, 12, 10, 5);
  EXPECT_NE(error().find(path + " has 12x10"), std::string::npos) << error();
  EXPECT_NE(error().find("12x8"), std::string::npos) << error();
  // Sizes are rounded: to a pixel is the same shape.
  WriteMask(path, 6, 5, 2);
  EXPECT_EQ(error(), "");
  std::ofstream(path) << "This is no image.\n";
  EXPECT_NE(error().find(path + " cannot be read"), std::string::npos)
      << error();
}

TEST(CheckMasks, WantsAMaskAtLeast) {
  const TestFolder folder;
  const std::vector<SceneView> scene(2, SomeView());
  const auto error = [&](const std::string& path) {
    return ErrorOf([&] { CheckMasks(path, scene, {0, 1}); });
  };
  EXPECT_EQ(error(""), "");
  EXPECT_NE(error(folder.Path("none")).find("no folder"), std::string::npos);
  EXPECT_NE(error(folder.Path("")).find("left/a.jpg.png"), std::string::npos);
  WriteMask(folder.Path("left/a.jpg.png"), 12, 8, 5);
  EXPECT_EQ(error(folder.Path("")), "");
}

// A workspace's masks of a model with one image and this camera.
std::string UndistortFor(const TestFolder& folder, const std::string& camera,
                         const std::string& undistorted) {
  const auto write = [&folder](const std::string& name,
                               const std::string& camera_line) {
    const std::string path = folder.Path(name);
    std::filesystem::create_directories(path);
    std::ofstream(path + "/cameras.txt") << camera_line << "\n";
    std::ofstream(path + "/images.txt") << "1 1 0 0 0 0 0 0 1 left/a.jpg\n\n";
    std::ofstream(path + "/points3D.txt");
  };
  write("sparse", camera);
  write("dense/sparse", undistorted);
  colmap::Reconstruction model;
  model.Read(folder.Path("sparse"));
  return UndistortMasks(folder.Path("masks"), model, folder.Path("dense"));
}

TEST(UndistortMasks, MasksWhatIsMaskedInTheDistortedPhotograph) {
  const TestFolder folder;
  WriteMask(folder.Path("masks/left/a.jpg.png"), 80, 60, 20);
  const std::string output =
      UndistortFor(folder, "1 SIMPLE_RADIAL 80 60 100 40 30 0.5",
                   "1 PINHOLE 70 50 100 100 35 25");
  SceneView view = SomeView();
  view.photo_width = view.width = 70;
  view.photo_height = view.height = 50;
  const Map<uint8_t> mask = ReadMask(output, view);
  ASSERT_EQ(mask.width(), 70);
  ASSERT_EQ(mask.height(), 50);
  // In the middle row its border, 20 pixels off the centre, is where
  // x (1 + 0.5 x^2) is 0.2: 19.6 pixels off it.
  for (int col = 0; col < 70; ++col) {
    if (std::abs(col - 15) > 1) {
      EXPECT_EQ(mask.At(25, col), col < 15 ? 1 : 0) << col;
    }
  }
}

TEST(UndistortMasks, LeavesMasksWithoutDistortionAsTheyAre) {
  const TestFolder folder;
  WriteMask(folder.Path("masks/left/a.jpg.png"), 12, 8, 5);
  const std::string camera = "1 PINHOLE 12 8 10 10 6 4";
  const std::string output = UndistortFor(folder, camera, camera);
  EXPECT_EQ(NumMasked(ReadMask(output, SomeView())), 5);
  // Without masks any more.
  std::filesystem::remove_all(folder.Path("masks"));
  EXPECT_NE(ErrorOf([&] {
              UndistortFor(folder, camera, camera);
            }).find("no folder of masks"),
            std::string::npos);
}

}  // namespace
}  // namespace tapa
