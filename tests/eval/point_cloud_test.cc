#include "src/eval/point_cloud.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "src/base/failure.h"
#include "tests/eval/cloud_files.h"
#include "tests/eval/run_program.h"
#include "tests/eval/test_files.h"

namespace tapa {
namespace {

const char* const kFormats[] = {"ascii", "binary_little_endian",
                                "binary_big_endian"};

template <typename T>
std::string Bytes(T value, bool big_endian) {
  std::string bytes(sizeof(T), 0);
  std::memcpy(bytes.data(), &value, sizeof(T));
  // The tests run on little-endian machines.
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

// Values of a PLY file in one of the three formats.
class Values {
 public:
  explicit Values(const std::string& format) : format_(format) {}

  template <typename T>
  Values& Add(T value) {
    if (format_ == "ascii") {
      text_ += std::to_string(value) + " ";
    } else {
      text_ += Bytes(value, format_ == "binary_big_endian");
    }
    return *this;
  }
  Values& EndRow() {
    if (format_ == "ascii") text_.back() = '\n';
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  std::string format_;
  std::string text_;
};

std::string Header(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\ncomment made by a test\n" + elements +
         "end_header\n";
}

const char kXyz[] = "property float x\nproperty float y\nproperty float z\n";

class PointCloudTest : public ::testing::Test {
 protected:
  PointCloud Read(const std::string& content) {
    WriteText(path_, content);
    return ReadPointCloud(path_);
  }

  void ExpectPoints(const std::string& content,
                    const std::vector<Vec3>& expected) {
    const std::vector<Vec3> points = Read(content).points;
    ASSERT_EQ(points.size(), expected.size());
    for (size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(points[i].x, expected[i].x) << i;
      EXPECT_EQ(points[i].y, expected[i].y) << i;
      EXPECT_EQ(points[i].z, expected[i].z) << i;
    }
  }

  void ExpectError(const std::string& content, const std::string& part) {
    WriteText(path_, content);
    ExpectReadError(ReadPointCloud, path_, part);
  }

  // Two points of three floats.
  std::string TwoPoints(const std::string& format) {
    Values values(format);
    values.Add(1.5f).Add(-2.0f).Add(0.25f).EndRow();
    values.Add(4.0f).Add(5.0f).Add(6.0f).EndRow();
    return Header(format, std::string("element vertex 2\n") + kXyz) +
           values.text();
  }

  TemporaryFolder folder_;
  const std::string path_ = folder_.File("cloud.ply");
};

TEST_F(PointCloudTest, EveryFormat) {
  for (const char* format : kFormats) {
    SCOPED_TRACE(format);
    ExpectPoints(TwoPoints(format), {{1.5f, -2, 0.25f}, {4, 5, 6}});
  }
}

TEST_F(PointCloudTest, AnyOrderAndTypes) {
  for (const char* format : kFormats) {
    SCOPED_TRACE(format);
    Values values(format);
    for (const int i : {1, 2}) {
      values.Add(static_cast<uint8_t>(255)).Add(-0.125 * i);
      values.Add(static_cast<int16_t>(-300 * i)).Add(0.5f * i);
      values.Add(static_cast<uint32_t>(7)).Add(3e9).EndRow();
    }
    ExpectPoints(
        Header(format,
               "element vertex 2\nproperty uchar red\nproperty double z\n"
               "property int16 x\nproperty float32 y\nproperty uint id\n"
               "property float64 time\n") +
            values.text(),
        {{-300, 0.5f, -0.125f}, {-600, 1, -0.25f}});
  }
}

TEST_F(PointCloudTest, ListsAndOtherElements) {
  for (const char* format : kFormats) {
    SCOPED_TRACE(format);
    Values values(format);
    // A face of three, one of none, a camera, two vertices with lists.
    values.Add(static_cast<uint8_t>(3)).Add(0).Add(1).Add(0).EndRow();
    values.Add(static_cast<uint8_t>(0)).EndRow();
    values.Add(1.0).Add(2.0).EndRow();
    values.Add(1.0f).Add(static_cast<uint16_t>(2)).Add(8.0).Add(9.0);
    values.Add(2.0f).Add(3.0f).EndRow();
    values.Add(4.0f).Add(static_cast<uint16_t>(0));
    values.Add(5.0f).Add(6.0f).EndRow();
    ExpectPoints(
        Header(format,
               "element face 2\nproperty list uchar int vertex_indices\n"
               "element camera 1\nproperty double f\nproperty double k\n"
               "element vertex 2\nproperty float x\n"
               "property list ushort double weights\nproperty float y\n"
               "property float z\nelement edge 5\nproperty int a\n") +
            values.text(),
        {{1, 2, 3}, {4, 5, 6}});
  }
}

TEST_F(PointCloudTest, ManyPoints) {
  // More than one block of the reader, with a colour.
  for (const char* format : kFormats) {
    SCOPED_TRACE(format);
    constexpr int kCount = 40000;
    Values values(format);
    std::vector<Vec3> expected;
    for (int i = 0; i < kCount; ++i) {
      const float x = 0.25f * static_cast<float>(i);
      values.Add(x).Add(-x).Add(x + 1).Add(static_cast<uint8_t>(1)).EndRow();
      expected.push_back({x, -x, x + 1});
    }
    ExpectPoints(Header(format, "element vertex 40000\n" + std::string(kXyz) +
                                    "property uchar red\n") +
                     values.text(),
                 expected);
  }
}

TEST_F(PointCloudTest, WhatAsciiMayLookLike) {
  ExpectPoints(
      "ply\r\nformat ascii 1.0\r\nobj_info scanner\r\nelement vertex 3\r\n"
      "property float x\r\nproperty float y\r\nproperty float z\r\n"
      "end_header\r\n+1\t-2e0   3.\r\n\r\n  1e-400 0 1E2\r\n4 5 6",
      {{1, -2, 3}, {0, 0, 100}, {4, 5, 6}});
}

TEST_F(PointCloudTest, NotFinitePointsAreLeftOut) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const char* format : kFormats) {
    SCOPED_TRACE(format);
    Values values(format);
    values.Add(1.0f).Add(nan).Add(3.0f).EndRow();
    values.Add(1.0f).Add(2.0f).Add(3.0f).EndRow();
    values.Add(1.0f).Add(2.0f).Add(-infinity).EndRow();
    const PointCloud cloud =
        Read(Header(format, std::string("element vertex 3\n") + kXyz) +
             values.text());
    EXPECT_EQ(cloud.points.size(), 1u);
    EXPECT_EQ(cloud.num_not_finite, 2);
  }
  // Beyond single precision.
  EXPECT_EQ(Read(Header("ascii", std::string("element vertex 2\n") + kXyz) +
                 "1e39 0 0\n1e999 0 0\n")
                .num_not_finite,
            2);
}

TEST_F(PointCloudTest, NoPoints) {
  for (const char* format : kFormats) {
    const PointCloud cloud =
        Read(Header(format, std::string("element vertex 0\n") + kXyz));
    EXPECT_TRUE(cloud.points.empty());
    EXPECT_EQ(cloud.num_not_finite, 0);
  }
}

TEST_F(PointCloudTest, Truncated) {
  for (const char* format : kFormats) {
    SCOPED_TRACE(format);
    std::string text = TwoPoints(format);
    // Within the second point.
    text.resize(text.size() - (text.substr(11, 5) == "ascii" ? 20 : 3));
    ExpectError(text, text.substr(11, 5) == "ascii"
                          ? "there are values missing"
                          : "is truncated: of 2 elements vertex it has 1");
    // In the header.
    ExpectError(text.substr(0, 40), "its header has no end");
  }
  ExpectError(Header("ascii", std::string("element vertex 3\n") + kXyz) +
                  "1 2 3\n4 5 6\n",
              "is truncated: of 3 elements vertex it has 2");
  // A number that would need all memory.
  for (const char* format : kFormats) {
    ExpectError(
        Header(format, std::string("element vertex 9000000000000000\n") + kXyz),
        "is truncated: of 9000000000000000 elements vertex it has 0");
  }
}

TEST_F(PointCloudTest, TruncatedElsewhere) {
  for (const char* format : {"binary_little_endian", "binary_big_endian"}) {
    SCOPED_TRACE(format);
    ExpectError(Header(format,
                       "element camera 5\nproperty double f\n"
                       "element vertex 0\n" +
                           std::string(kXyz)) +
                    Values(format).Add(1.0).text(),
                "is truncated: of 5 elements camera it has 1");
    const std::string faces = Header(
        format, "element face 2\nproperty list int int v\nelement vertex 1\n" +
                    std::string(kXyz));
    ExpectError(faces + Values(format).Add(1).Add(0).Add(1000000000).text(),
                "is truncated: of 2 elements face it has 1");
    ExpectError(faces + Values(format).Add(-1).text(),
                "a list of negative length");
  }
}

TEST_F(PointCloudTest, NoCoordinates) {
  ExpectError(Header("ascii",
                     "element vertex 1\nproperty float x\nproperty float y\n") +
                  "1 2\n",
              "no property z");
  ExpectError(Header("ascii",
                     "element vertex 1\nproperty float y\nproperty float z\n"
                     "property list uchar float x\n") +
                  "1 2 0\n",
              "no property x");
  ExpectError(Header("ascii", "element face 1\nproperty float x\n") + "1\n",
              "has no vertices");
  ExpectError(Header("ascii", ""), "has no vertices");
  ExpectError(Header("ascii", "element vertex 1\n"), "no property x");
}

TEST_F(PointCloudTest, OtherFiles) {
  ExpectError("", "is not a PLY file");
  ExpectError("nonsense", "is not a PLY file");
  ExpectError(std::string(1000000, 'x'), "is not a PLY file");
  ExpectError("plywood\n", "is not a PLY file");
  ExpectError("ply\n" + std::string(1000000, 'x'), "its header has no end");
  ExpectError("ply\nend_header\n", "does not say its format");
  for (const char* line :
       {"format ascii 2.0", "format binary 1.0", "format", "nonsense",
        "element vertex", "element vertex -1", "element vertex 1.5",
        "element vertex x", "element vertex 99999999999999999999",
        "property float x"}) {
    ExpectError("ply\n" + std::string(line) + "\n" + "end_header\n",
                "line 2: '" + std::string(line) + "'");
  }
  for (const char* line :
       {"property quad x", "property float", "property list uchar float",
        "property list float float x", "property float x y"}) {
    ExpectError("ply\nelement vertex 1\n" + std::string(line) + "\r\n",
                "line 3: '" + std::string(line) + "'");
  }
}

TEST_F(PointCloudTest, BadNumbers) {
  const std::string header =
      Header("ascii", std::string("element vertex 2\n") + kXyz);
  ExpectError(header + "1 2 3\n4 5\n6\n", "line 10: there are values missing");
  ExpectError(header + "1 2 x\n4 5 6\n", "line 9: 'x' is no number");
  ExpectError(header + "1 2,5 3\n4 5 6\n", "line 9: '2,5' is no number");
}

TEST_F(PointCloudTest, MissingFile) {
  EXPECT_THROW(ReadPointCloud(folder_.File("none.ply")), std::runtime_error);
  EXPECT_THROW(ReadPointCloud(folder_.path()), std::runtime_error);
}

TEST_F(PointCloudTest, ColoredPointsComeBack) {
  std::vector<Vec3> points;
  for (int i = 0; i < 20000; ++i) {
    points.push_back({0.5f * static_cast<float>(i), 2, -3});
  }
  const auto color = [](size_t i) {
    return Rgb{static_cast<uint8_t>(i), 20, 30};
  };
  WriteColoredPoints(path_, points, color);
  const std::string text = ReadText(path_);
  ExpectPoints(text, points);
  // The last point's colour.
  EXPECT_EQ(text.substr(text.size() - 3),
            std::string({static_cast<char>(19999 % 256), 20, 30}));

  EXPECT_THROW(WriteColoredPoints(folder_.path() + "/none/x.ply", {}, color),
               Failure);
  EXPECT_EQ(ReadText(path_), text);
}

}  // namespace
}  // namespace tapa
