#include "src/eval/depth_map_io.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "tests/eval/test_files.h"

namespace tapa {
namespace {

// The message must name the file.
template <typename Function>
void ExpectError(const std::string& path, const std::string& part,
                 Function function) {
  try {
    function();
    ADD_FAILURE() << "no error for " << path;
  } catch (const std::runtime_error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(path), std::string::npos) << message;
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
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
    ExpectError(path, c.part, [&] { ReadDepthMap(path); });
  }
  ExpectError(folder.path() + "/none.bin", "cannot open",
              [&] { ReadDepthMap(folder.path() + "/none.bin"); });
  ExpectError(folder.path(), "cannot open",
              [&] { ReadDepthMap(folder.path()); });
  const std::string depth = folder.File("depth.bin");
  WriteColmapMap(depth, 1, 1, 1, {1});
  ExpectError(depth, "3 channels are expected", [&] { ReadNormalMap(depth); });
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
  ExpectError(path, "is not a readable image",
              [&] { ReadGroundTruth(path, 4000); });
  WriteText(path, "");
  ExpectError(path, "is not a readable image",
              [&] { ReadGroundTruth(path, 4000); });
  WritePhotograph(path, 8, 8);
  ExpectError(path, "is not a 16-bit grey image",
              [&] { ReadGroundTruth(path, 4000); });
}

}  // namespace
}  // namespace tapa
