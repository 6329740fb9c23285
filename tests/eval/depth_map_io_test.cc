#include "src/eval/depth_map_io.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "src/base/map_files.h"
#include "tests/eval/test_files.h"

namespace tapa {
namespace {

Map<float> ReadMetres(const std::string& path) {
  return ReadGroundTruth(path, 4000);
}

TEST(DepthMapIoTest, DepthMapIsRowMajor) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.bin");
  WriteColmapMap(path, 3, 2, 1, {1, 2, 3, 4, 5, -6});
  const Map<float> depth = ReadDepthMap(path);
  ASSERT_EQ(depth.width(), 3);
  ASSERT_EQ(depth.height(), 2);
  EXPECT_EQ(depth.At(0, 2), 3);
  EXPECT_EQ(depth.At(1, 0), 4);
  EXPECT_EQ(depth.At(1, 2), -6);
}

TEST(DepthMapIoTest, NormalMapIsPlanar) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.bin");
  WriteColmapMap(path, 2, 1, 3, {1, 2, 3, 4, 5, 6});
  const Map<Vec3> normal = ReadNormalMap(path);
  EXPECT_EQ(normal.At(0, 0).x, 1);
  EXPECT_EQ(normal.At(0, 0).y, 3);
  EXPECT_EQ(normal.At(0, 0).z, 5);
  EXPECT_EQ(normal.At(0, 1).x, 2);
  EXPECT_EQ(normal.At(0, 1).z, 6);
}

TEST(DepthMapIoTest, BytesAreLittleEndian) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.bin");
  WriteText(path, std::string("1&1&1&") + std::string("\x00\x00\x80\x3f", 4));
  EXPECT_EQ(ReadDepthMap(path).At(0, 0), 1);
}

TEST(DepthMapIoTest, BrokenMaps) {
  const TemporaryFolder folder;
  const struct {
    std::string content, part;
  } cases[] = {
      {"", "is not a COLMAP"},
      {"hello", "is not a COLMAP"},
      {"3&2", "is not a COLMAP"},
      {"0&2&1&", "is not a COLMAP"},
      {"-3&2&1&", "is not a COLMAP"},
      {"3&2&&", "is not a COLMAP"},
      {"99999999999999999999&2&1&", "is not a COLMAP"},
      {"3&2&3&" + std::string(72, 'x'), "1 channel is expected"},
      {"3&2&1&" + std::string(23, 'x'), "is truncated"},
      {"3&2&1&", "is truncated"},
      {"1000000&1000000&1&abcd", "is truncated"},
      {"3&2&1&" + std::string(25, 'x'), "is too long"},
  };
  for (const auto& c : cases) {
    const std::string path = folder.File("broken.bin");
    WriteText(path, c.content);
    ExpectReadError(ReadDepthMap, path, c.part);
  }
  for (const std::string& path : {folder.path() + "/none.bin", folder.path()}) {
    ExpectReadError(ReadDepthMap, path, "cannot open");
  }
  const std::string depth = folder.File("depth.bin");
  WriteColmapMap(depth, 1, 1, 1, {1});
  ExpectReadError(ReadNormalMap, depth, "3 channels are expected");
}

TEST(DepthMapIoTest, GroundTruthFromPng) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.png");
  WriteDepthPng(path, 2, 2, {0, 4000, 1, 65535});
  const Map<float> truth = ReadGroundTruth(path, 4000);
  EXPECT_EQ(truth.At(0, 0), 0);
  EXPECT_EQ(truth.At(0, 1), 1);
  EXPECT_FLOAT_EQ(truth.At(1, 0), 0.00025f);
  EXPECT_FLOAT_EQ(truth.At(1, 1), 16.38375f);
  EXPECT_FLOAT_EQ(ReadGroundTruth(path, 1000).At(0, 1), 4);
}

TEST(DepthMapIoTest, GroundTruthFromColmapMap) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.bin");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  WriteColmapMap(path, 2, 2, 1, {0, 2.5f, nan, -1});
  const Map<float> truth = ReadGroundTruth(path, 4000);
  EXPECT_EQ(truth.At(0, 1), 2.5f);
  EXPECT_EQ(truth.At(1, 0), 0);
  EXPECT_EQ(truth.At(1, 1), 0);
}

TEST(DepthMapIoTest, BrokenGroundTruth) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.png");
  WriteText(path, "no picture");
  ExpectReadError(ReadMetres, path, "is not a readable image");
  WriteText(path, "");
  ExpectReadError(ReadMetres, path, "is not a readable image");
  WritePhotograph(path, 8, 8);
  ExpectReadError(ReadMetres, path, "is not a 16-bit grey image");
}

}  // namespace
}  // namespace tapa
