#include "src/colmap/ply_files.h"

#include <gtest/gtest.h>

#include <fstream>

#include "src/colmap/fused_points.h"
#include "src/colmap/text_files.h"
#include "tests/colmap/test_folder.h"
#include "util/ply.h"

namespace tapa {
namespace {

void ExpectOnlyTheWholeIsWhole(const std::string& path) {
  const std::string content = ReadWholeFile(path);
  EXPECT_TRUE(IsWholePly(path));
  for (const size_t size : {size_t{0}, size_t{20}, content.size() - 1}) {
    std::ofstream(path, std::ios::binary) << content.substr(0, size);
    EXPECT_FALSE(IsWholePly(path)) << size;
  }
  std::ofstream(path, std::ios::binary) << content << "x";
  EXPECT_FALSE(IsWholePly(path)) << "too long";
}

TEST(IsWholePly, OfPoints) {
  const TestFolder folder;
  const std::string path = folder.Path("fused.ply");
  EXPECT_FALSE(IsWholePly(path));
  for (const double origin : {0.0, 1e6}) {
    WriteFusedPoints(path, std::vector<colmap::PlyPoint>(2), {},
                     {origin, 0, 0});
    ExpectOnlyTheWholeIsWhole(path);
  }
}

TEST(IsWholePly, OfMeshes) {
  const TestFolder folder;
  const std::string path = folder.Path("mesh.ply");
  colmap::PlyMesh mesh;
  mesh.vertices.resize(3);
  mesh.faces.resize(2);
  colmap::WriteBinaryPlyMesh(path, mesh);
  ExpectOnlyTheWholeIsWhole(path);
}

}  // namespace
}  // namespace tapa
