#include "src/colmap/part_files.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "src/base/failure.h"
#include "tests/colmap/test_folder.h"

namespace tapa {
namespace {

constexpr char kMesh[] =
    "ply\nformat binary_little_endian 1.0\nelement vertex 0\n"
    "property float x\nend_header\n";

// Writes the beginning of a file of points, or all of it.
bool Write(const std::string& path, size_t size) {
  std::ofstream(path) << std::string(kMesh).substr(0, size);
  return true;
}

TEST(CheckWritten, TellsThatTheDiskIsFull) {
  const TestFolder folder;
  std::ofstream file(folder.Path("a.txt"));
  file << "text";
  CheckWritten(folder.Path("a.txt"), &file);
  std::ofstream full("/dev/full");
  full << "text";
  EXPECT_THROW(CheckWritten("/dev/full", &full), Failure);
}

TEST(WriteWhole, LeavesTheWholeOrNothing) {
  const TestFolder folder;
  const std::string path = folder.Path("mesh.ply");
  const auto fails = [&](const auto& write) {
    return !WriteWhole(path, write) && folder.NumFiles() == 0;
  };
  EXPECT_TRUE(fails([](const std::string&) { return true; }));
  EXPECT_TRUE(fails([](const std::string& part) { return Write(part, 40); }));
  EXPECT_TRUE(fails([](const std::string& part) {
    Write(part, sizeof(kMesh));
    return false;
  }));
  EXPECT_TRUE(fails([](const std::string& part) -> bool {
    Write(part, sizeof(kMesh));
    throw Failure("no more");
  }));
  EXPECT_TRUE(WriteWhole(path, [](const std::string& part) {
    return Write(part, sizeof(kMesh));
  }));
  EXPECT_EQ(folder.NumFiles(), 1);
}

TEST(WriteWholeDeathTest, IsNoSuccessWhereTheMesherEndsTheProgram) {
  const TestFolder folder;
  const std::string path = folder.Path("mesh.ply");
  EXPECT_EXIT(WriteWhole(path, [](const std::string&) -> bool { exit(0); }),
              testing::ExitedWithCode(EXIT_FAILURE), "mesh.ply could not be");
}

}  // namespace
}  // namespace tapa
