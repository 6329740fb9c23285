#include "src/colmap/views.h"

#include <FreeImage.h>
#include <gtest/gtest.h>

#include <algorithm>

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
