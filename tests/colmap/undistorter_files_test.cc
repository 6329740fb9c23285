#include "src/colmap/undistorter_files.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/colmap/test_folder.h"

namespace tapa {
namespace {

// The first bytes of every JPEG.
bool IsJpeg(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return file.get() == 0xFF && file.get() == 0xD8;
}

TEST(WritePhoto, HasTheFormatOfItsNameInEveryThread) {
  constexpr int kNumThreads = 8;
  constexpr int kNumPhotos = 200;
  const TestFolder folder;
  colmap::Bitmap bitmap;
  bitmap.Allocate(8, 8, /* as_rgb */ true);
  const auto path = [&folder](int thread, int number) {
    return folder.Path(std::to_string(thread) + "_" + std::to_string(number) +
                       ".jpg");
  };
  std::vector<std::thread> threads;
  for (int thread = 0; thread < kNumThreads; ++thread) {
    threads.emplace_back([&, thread] {
      for (int i = 0; i < kNumPhotos; ++i) {
        WritePhoto(bitmap, path(thread, i));
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (int thread = 0; thread < kNumThreads; ++thread) {
    for (int i = 0; i < kNumPhotos; ++i) {
      EXPECT_TRUE(IsJpeg(path(thread, i))) << path(thread, i);
    }
  }
}

}  // namespace
}  // namespace tapa
