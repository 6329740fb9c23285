#include "src/colmap/views.h"

#include <FreeImage.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include "src/base/failure.h"
#include "tests/colmap/test_folder.h"
#include "util/bitmap.h"

namespace tapa {
namespace {

// A photograph of red, green, blue and one mixed colour, in columns.
colmap::Bitmap SomeBitmap(bool in_color) {
  colmap::Bitmap bitmap;
  bitmap.Allocate(8, 2, in_color);
  const colmap::BitmapColor<uint8_t> colors[] = {
      {250, 0, 0}, {0, 250, 0}, {0, 0, 250}, {10, 20, 30}};
  for (int row = 0; row < 2; ++row) {
    for (int col = 0; col < 8; ++col) {
      bitmap.SetPixel(col, row, colors[col / 2]);
    }
  }
  return bitmap;
}

SceneView SomeView(const std::string& path) {
  SceneView view;
  view.name = "a.png";
  view.image_path = path;
  view.photo_width = view.width = 8;
  view.photo_height = view.height = 2;
  return view;
}

TEST(ReadColorPhoto, ReadsColours) {
  const TestFolder folder;
  const SceneView view = SomeView(folder.Path("a.png"));
  ASSERT_TRUE(SomeBitmap(true).Write(view.image_path));
  const Map<Rgb> photo = ReadColorPhoto(view);
  ASSERT_EQ(photo.width(), 8);
  ASSERT_EQ(photo.height(), 2);
  EXPECT_EQ(photo.At(0, 0).r, 250);
  EXPECT_EQ(photo.At(0, 0).g, 0);
  EXPECT_EQ(photo.At(1, 2).g, 250);
  EXPECT_EQ(photo.At(1, 4).b, 250);
  EXPECT_EQ(photo.At(1, 7).r, 10);
  EXPECT_EQ(photo.At(1, 7).g, 20);
  EXPECT_EQ(photo.At(1, 7).b, 30);
}

TEST(ReadColorPhoto, ReadsGreyPhotographs) {
  const TestFolder folder;
  const SceneView view = SomeView(folder.Path("a.png"));
  ASSERT_TRUE(SomeBitmap(false).Write(view.image_path));
  const Map<uint8_t> grey = ReadPhoto(view);
  const Map<Rgb> photo = ReadColorPhoto(view);
  EXPECT_GT(grey.At(0, 0), 0);
  for (size_t i = 0; i < photo.size(); ++i) {
    EXPECT_EQ(photo.data()[i].r, grey.data()[i]);
    EXPECT_EQ(photo.data()[i].g, grey.data()[i]);
    EXPECT_EQ(photo.data()[i].b, grey.data()[i]);
  }
}

TEST(ReadColorPhoto, ReadsGreyOf16Bits) {
  const TestFolder folder;
  const SceneView view = SomeView(folder.Path("a.png"));
  FIBITMAP* bitmap = FreeImage_AllocateT(FIT_UINT16, 8, 2);
  for (int row = 0; row < 2; ++row) {
    auto* line =
        reinterpret_cast<uint16_t*>(FreeImage_GetScanLine(bitmap, row));
    std::fill(line, line + 8, uint16_t{200 << 8});
  }
  ASSERT_TRUE(FreeImage_Save(FIF_PNG, bitmap, view.image_path.c_str()));
  FreeImage_Unload(bitmap);
  const Map<uint8_t> grey = ReadPhoto(view);
  const Map<Rgb> photo = ReadColorPhoto(view);
  EXPECT_EQ(grey.At(1, 3), 200);
  EXPECT_EQ(photo.At(1, 3).r, 200);
  EXPECT_EQ(photo.At(1, 3).b, 200);
}

TEST(ReadColorPhoto, HasTheSizeThatStereoWorksAt) {
  const TestFolder folder;
  SceneView view = SomeView(folder.Path("a.png"));
  ASSERT_TRUE(SomeBitmap(true).Write(view.image_path));
  view.width = 4;
  view.height = 1;
  const Map<Rgb> photo = ReadColorPhoto(view);
  EXPECT_EQ(photo.width(), 4);
  EXPECT_EQ(photo.height(), 1);
  EXPECT_GT(photo.At(0, 0).r, 150);
  EXPECT_GT(photo.At(0, 2).b, 150);
}

// Writes a grey photograph.
template <typename GreyAt>
void WriteGrey(const std::string& path, int width, int height,
               const GreyAt& grey_at) {
  colmap::Bitmap bitmap;
  bitmap.Allocate(width, height, /* as_rgb */ false);
  for (int row = 0; row < height; ++row) {
    for (int col = 0; col < width; ++col) {
      bitmap.SetPixel(col, row, {static_cast<uint8_t>(grey_at(row, col))});
    }
  }
  ASSERT_TRUE(bitmap.Write(path));
}

// Each pixel of a photograph that is scaled stands for the area that it covers:
// brightness that grows evenly must be that at the area's centre.
TEST(ReadPhoto, ScalesWithoutAShift) {
  const TestFolder folder;
  SceneView view = SomeView(folder.Path("a.png"));
  view.photo_width = 199;
  view.photo_height = 101;
  WriteGrey(view.image_path, view.photo_width, view.photo_height,
            [](int row, int col) { return 20 + col + row / 3; });
  for (const auto& [width, height] : {std::pair<int, int>{198, 100},
                                      {150, 76},
                                      {100, 51},
                                      {67, 34},
                                      {19, 10}}) {
    view.width = width;
    view.height = height;
    const Map<uint8_t> photo = ReadPhoto(view);
    ASSERT_EQ(photo.width(), width);
    ASSERT_EQ(photo.height(), height);
    double sum = 0;
    int count = 0;
    // Where the borders have no part in it.
    for (int row = 2; row < height - 2; ++row) {
      for (int col = 2; col < width - 2; ++col) {
        const double x = (col + 0.5) * view.photo_width / width - 0.5;
        const double y = (row + 0.5) * view.photo_height / height - 0.5;
        // Rows give thirds, rounded down: a third less on average.
        const double error = photo.At(row, col) - (20 + x + y / 3 - 1.0 / 3);
        EXPECT_LT(std::abs(error), 1.5) << width << "x" << height;
        sum += error;
        ++count;
      }
    }
    // The photograph and its scaling round to whole numbers.
    EXPECT_LT(std::abs(sum / count), 0.2) << width << "x" << height;
  }
}

TEST(ReadPhoto, ScalesWithoutAliasing) {
  const TestFolder folder;
  SceneView view = SomeView(folder.Path("a.png"));
  view.photo_width = view.photo_height = 240;
  WriteGrey(view.image_path, 240, 240,
            [](int row, int col) { return (row + col) % 2 == 0 ? 60 : 180; });
  for (const int size : {119, 80, 61, 24}) {
    view.width = view.height = size;
    const Map<uint8_t> photo = ReadPhoto(view);
    for (int row = 2; row < size - 2; ++row) {
      for (int col = 2; col < size - 2; ++col) {
        EXPECT_NEAR(photo.At(row, col), 120, 8) << size;
      }
    }
  }
}

// Of one photograph, a.png.
colmap::mvs::Model ModelWithCamera(const TestFolder& folder,
                                   const std::string& camera) {
  std::filesystem::create_directory(folder.Path("sparse"));
  std::ofstream(folder.Path("sparse/cameras.txt")) << "1 " << camera << "\n";
  std::ofstream(folder.Path("sparse/images.txt"))
      << "1 1 0 0 0 0 0 0 1 a.png\n\n";
  std::ofstream(folder.Path("sparse/points3D.txt"));
  colmap::mvs::Model model;
  model.ReadFromCOLMAP(folder.Path(""));
  return model;
}

TEST(SceneViews, ScaleTheCameraByTheExactRatioOfEachAxis) {
  const TestFolder folder;
  const colmap::mvs::Model model =
      ModelWithCamera(folder, "PINHOLE 1001 667 800 810 510.5 333.25");
  for (const int size : {1000, 640, 500, 333, 50}) {
    const std::vector<SceneView> views = SceneViews(model, size);
    ASSERT_EQ(views.size(), 1u);
    const SceneView& view = views[0];
    EXPECT_EQ(view.width, size);
    EXPECT_NEAR(view.height, 667.0 * size / 1001, 0.51);
    const double x = static_cast<double>(view.width) / 1001;
    const double y = static_cast<double>(view.height) / 667;
    EXPECT_NEAR(view.camera.fx, 800 * x, 1e-3);
    EXPECT_NEAR(view.camera.cx, 510.5 * x, 1e-3);
    EXPECT_NEAR(view.camera.fy, 810 * y, 1e-3);
    EXPECT_NEAR(view.camera.cy, 333.25 * y, 1e-3);
  }
}

TEST(SceneViews, RefuseStripsOfWhichNothingIsLeft) {
  const TestFolder folder;
  const colmap::mvs::Model model =
      ModelWithCamera(folder, "PINHOLE 4 46080 500 500 2 23040");
  EXPECT_EQ(SceneViews(model, -1)[0].width, 4);
  try {
    SceneViews(model, 2000);
    FAIL();
  } catch (const Failure& error) {
    EXPECT_NE(std::string(error.what()).find("a.png has 4x46080"),
              std::string::npos)
        << error.what();
  }
}

TEST(ReadColorPhoto, RefusesWhatReadPhotoRefuses) {
  const TestFolder folder;
  SceneView view = SomeView(folder.Path("a.png"));
  EXPECT_THROW(ReadColorPhoto(view), Failure);
  ASSERT_TRUE(SomeBitmap(true).Write(view.image_path));
  view.photo_width = 9;
  EXPECT_THROW(ReadPhoto(view), Failure);
  EXPECT_THROW(ReadColorPhoto(view), Failure);
}

}  // namespace
}  // namespace tapa
