#include "src/colmap/fused_points.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "src/colmap/ply_files.h"
#include "src/colmap/text_files.h"
#include "tests/colmap/test_folder.h"

namespace tapa {
namespace {

std::vector<colmap::PlyPoint> TwoPoints() {
  std::vector<colmap::PlyPoint> points(2);
  points[0].x = 1;
  points[1].z = 0.125f;
  points[1].nz = -1;
  points[1].r = 200;
  return points;
}

TEST(FusedPoints, AreThoseOfColmapAtTheOrigin) {
  const TestFolder folder;
  const std::string path = folder.Path("fused.ply");
  WriteFusedPoints(path, TwoPoints(), {{0, 1}, {2}}, Eigen::Vector3d::Zero());
  colmap::WriteBinaryPlyPoints(folder.Path("colmap.ply"), TwoPoints());
  EXPECT_EQ(ReadWholeFile(path), ReadWholeFile(folder.Path("colmap.ply")));
  EXPECT_EQ(std::filesystem::file_size(path + ".vis"), 8 + 4 + 8 + 4 + 4);
  EXPECT_EQ(folder.NumFiles(), 3);
}

TEST(FusedPoints, KeepTheirDigitsElsewhere) {
  const TestFolder folder;
  const std::string path = folder.Path("fused.ply");
  WriteFusedPoints(path, TwoPoints(), {}, {500000, 5200000, 0.5});
  const std::string content = ReadWholeFile(path);
  EXPECT_NE(content.find("property double z"), std::string::npos);
  double z;
  const size_t begin = content.find("end_header\n") + 11 + 39 + 16;
  std::memcpy(&z, content.data() + begin, sizeof(z));
  EXPECT_EQ(z, 0.625);
}

FusedCloud CloudOfTwoPoints() {
  FusedCloud cloud;
  cloud.views.resize(1);
  cloud.views[0].view = 3;
  cloud.views[0].neighbors = {5, 0};
  cloud.views[0].points.resize(2);
  cloud.views[0].points[0].position = {1, 0, 0};
  cloud.views[0].points[0].visible = 2;
  cloud.views[0].points[1].position = {0, 0, 0.125f};
  cloud.views[0].points[1].confidence = 1.5f;
  return cloud;
}

TEST(FusedPoints, OfEitherRuleDifferByTheConfidence) {
  const TestFolder folder;
  const FusedCloud cloud = CloudOfTwoPoints();
  for (const double origin : {0.0, 1e6}) {
    WriteFusedPoints(folder.Path("cloud.ply"), cloud, {origin, 0, 0});
    WriteFusedPoints(folder.Path("points.ply"), PlyPoints(cloud), {{3, 0}, {3}},
                     {origin, 0, 0});
    EXPECT_TRUE(IsWholePly(folder.Path("cloud.ply")));
    EXPECT_EQ(ReadWholeFile(folder.Path("cloud.ply.vis")),
              ReadWholeFile(folder.Path("points.ply.vis")));
    const std::string with = ReadWholeFile(folder.Path("cloud.ply"));
    const std::string without = ReadWholeFile(folder.Path("points.ply"));
    const std::string property = "property float confidence\n";
    EXPECT_EQ(with.size(),
              without.size() + property.size() + 2 * sizeof(float));
    EXPECT_NE(with.find(property), std::string::npos);
    float confidence;
    std::memcpy(&confidence, &with[with.size() - sizeof(float)], sizeof(float));
    EXPECT_EQ(confidence, 1.5f);
  }
}

}  // namespace
}  // namespace tapa
