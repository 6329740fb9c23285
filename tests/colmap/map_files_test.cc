#include "src/base/map_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <boost/filesystem.hpp>
#include <ctime>
#include <fstream>

#include "mvs/consistency_graph.h"
#include "mvs/depth_map.h"
#include "mvs/normal_map.h"
#include "src/base/atomic_file.h"
#include "src/base/failure.h"
#include "tests/colmap/test_folder.h"

namespace tapa {
namespace {

Map<float> SomeDepths() {
  Map<float> map(3, 2);
  for (size_t i = 0; i < map.size(); ++i) {
    map.data()[i] = 0.5f + i;
  }
  return map;
}

Map<Vec3> SomeNormals() {
  Map<Vec3> map(3, 2);
  for (size_t i = 0; i < map.size(); ++i) {
    map.data()[i] = {1.0f * i, 10.0f + i, -20.0f - i};
  }
  return map;
}

void Truncate(const std::string& path, int bytes) {
  boost::filesystem::resize_file(path,
                                 boost::filesystem::file_size(path) - bytes);
}

TEST(MapFiles, ColmapReadsDepthMap) {
  const TestFolder folder;
  WriteDepthMap(folder.Path("a.bin"), SomeDepths());
  colmap::mvs::DepthMap map;
  map.Read(folder.Path("a.bin"));
  ASSERT_EQ(map.GetWidth(), 3);
  ASSERT_EQ(map.GetHeight(), 2);
  for (int row = 0; row < 2; ++row) {
    for (int col = 0; col < 3; ++col) {
      EXPECT_EQ(map.Get(row, col), SomeDepths().At(row, col));
    }
  }
}

TEST(MapFiles, ColmapReadsNormalMap) {
  const TestFolder folder;
  WriteNormalMap(folder.Path("a.bin"), SomeNormals());
  colmap::mvs::NormalMap map;
  map.Read(folder.Path("a.bin"));
  for (int row = 0; row < 2; ++row) {
    for (int col = 0; col < 3; ++col) {
      float normal[3];
      map.GetSlice(row, col, normal);
      EXPECT_EQ(normal[0], SomeNormals().At(row, col).x);
      EXPECT_EQ(normal[1], SomeNormals().At(row, col).y);
      EXPECT_EQ(normal[2], SomeNormals().At(row, col).z);
    }
  }
}

TEST(MapFiles, ReadsWhatColmapWrites) {
  const TestFolder folder;
  colmap::mvs::DepthMap depth(3, 2, 0, 10);
  depth.Set(1, 2, 7.5f);
  depth.Write(folder.Path("depth.bin"));
  EXPECT_EQ(ReadDepthMap(folder.Path("depth.bin")).At(1, 2), 7.5f);

  colmap::mvs::NormalMap normal(3, 2);
  normal.Set(1, 0, 2, -1);
  normal.Write(folder.Path("normal.bin"));
  EXPECT_EQ(ReadNormalMap(folder.Path("normal.bin")).At(1, 0).z, -1);
}

TEST(MapFiles, ReadsRowsOfEachChannel) {
  const TestFolder folder;
  const std::string path = folder.Path("a.bin");
  WriteNormalMap(path, SomeNormals());
  const MapRows rows(path, MapKind::kNormal);
  ASSERT_EQ(rows.width(), 3);
  ASSERT_EQ(rows.height(), 2);
  float values[3][3];
  for (int channel = 0; channel < 3; ++channel) {
    rows.Read(channel, 1, values[channel]);
  }
  for (int col = 0; col < 3; ++col) {
    EXPECT_EQ(values[0][col], SomeNormals().At(1, col).x);
    EXPECT_EQ(values[1][col], SomeNormals().At(1, col).y);
    EXPECT_EQ(values[2][col], SomeNormals().At(1, col).z);
  }
}

TEST(MapFiles, NoticesThatAFileIsCutOffWhileItIsRead) {
  const TestFolder folder;
  const std::string path = folder.Path("a.bin");
  WriteDepthMap(path, SomeDepths());
  const MapRows rows(path, MapKind::kDepth);
  Truncate(path, 4);
  float values[3];
  rows.Read(0, 0, values);
  EXPECT_THROW(rows.Read(0, 1, values), Failure);
}

TEST(MapFiles, ReadsGraphs) {
  const TestFolder folder;
  const std::string path = folder.Path("a.bin");
  const std::vector<int32_t> graph = {2, 1, 2, 40, 50, 0, 0, 1, 7};
  WriteGraph(path, 3, 2, graph);
  EXPECT_EQ(ReadGraph(path), graph);
  WriteGraph(path, 3, 2, {});
  EXPECT_TRUE(ReadGraph(path).empty());
  // Beyond the image, without views, cut off.
  const std::vector<std::vector<int32_t>> damaged = {
      {3, 1, 1, 40},  {2, 2, 1, 40}, {-1, 0, 1, 40},
      {2, -1, 1, 40}, {2, 1, 0},     {2, 1, -3},
      {2, 1},         {2, 1, 2, 40}, {2, 1, INT32_MAX, 40}};
  for (const std::vector<int32_t>& values : damaged) {
    WriteGraph(path, 3, 2, values);
    EXPECT_THROW(ReadGraph(path), Failure);
  }
  EXPECT_THROW(ReadGraph(folder.Path("none.bin")), Failure);
}

TEST(MapFiles, ColmapReadsGraph) {
  const TestFolder folder;
  WriteGraph(folder.Path("a.bin"), 3, 2, {2, 1, 2, 40, 50});
  colmap::mvs::ConsistencyGraph graph;
  graph.Read(folder.Path("a.bin"));
  int num_images = 0;
  const int* images = nullptr;
  graph.GetImageIdxs(/* row */ 1, /* col */ 2, &num_images, &images);
  ASSERT_EQ(num_images, 2);
  EXPECT_EQ(images[0], 40);
  EXPECT_EQ(images[1], 50);
}

// Of a file that ought to be a map of 3x2 pixels; empty: nothing.
std::string WhatIsWrong(const std::string& path,
                        MapKind kind = MapKind::kDepth) {
  try {
    CheckMapFile(path, kind, 3, 2);
  } catch (const Failure& error) {
    EXPECT_NE(std::string(error.what()).find(path), std::string::npos);
    return error.what();
  }
  return "";
}

TEST(MapFiles, ChecksSizeAndKind) {
  const TestFolder folder;
  const std::string path = folder.Path("a.bin");
  WriteDepthMap(path, SomeDepths());
  EXPECT_EQ(WhatIsWrong(path), "");
  EXPECT_NE(WhatIsWrong(path, MapKind::kNormal), "");
  EXPECT_THROW(ReadNormalMap(path), Failure);
  WriteDepthMap(path, Map<float>(2, 3));
  EXPECT_NE(WhatIsWrong(path).find("2x3x1, but 3x2x1"), std::string::npos);
}

TEST(MapFiles, RefusesDamagedFiles) {
  const TestFolder folder;
  const std::string path = folder.Path("a.bin");
  EXPECT_NE(WhatIsWrong(path), "") << "none";
  EXPECT_NE(WhatIsWrong(folder.Path("")), "") << "a folder";
  WriteDepthMap(path, SomeDepths());
  Truncate(path, 4);
  EXPECT_NE(WhatIsWrong(path), "");
  EXPECT_THROW(ReadDepthMap(path), Failure);
  WriteDepthMap(path, SomeDepths());
  std::ofstream(path, std::ios::app) << "x";
  EXPECT_NE(WhatIsWrong(path), "");
  for (const char* text :
       {"", "3&2&", "nothing of the kind", "3&2&1", " 3&2&1&", "-3&2&1&",
        "99999999999999999999999&2&1&"}) {
    std::ofstream(path, std::ios::trunc) << text;
    EXPECT_NE(WhatIsWrong(path), "") << text;
  }
  // Graphs may have any length, of whole numbers.
  WriteGraph(path, 3, 2, {2, 1, 1, 40});
  EXPECT_EQ(WhatIsWrong(path, MapKind::kConsistencyGraph), "");
  Truncate(path, 1);
  EXPECT_NE(WhatIsWrong(path, MapKind::kConsistencyGraph), "");
}

TEST(MapFiles, MakesFolders) {
  const TestFolder folder;
  WriteDepthMap(folder.Path("x/y/a.bin"), SomeDepths());
  EXPECT_EQ(WhatIsWrong(folder.Path("x/y/a.bin")), "");
}

TEST(AtomicFile, IsNotThereUntilComplete) {
  const TestFolder folder;
  const std::string path = folder.Path("a.bin");
  {
    AtomicFile file(path);
    file.Write("abc", 3);
    EXPECT_FALSE(boost::filesystem::exists(path));
  }
  EXPECT_EQ(folder.NumFiles(), 0) << "nothing is left behind";
  {
    AtomicFile file(path);
    file.Write("abc", 3);
    file.Commit();
  }
  EXPECT_EQ(boost::filesystem::file_size(path), 3);
  EXPECT_EQ(folder.NumFiles(), 1);
}

TEST(AtomicFile, KeepsTheOldFileWhenNotCommitted) {
  const TestFolder folder;
  const std::string path = folder.Path("a.bin");
  std::ofstream(path) << "old";
  { AtomicFile(path).Write("new content", 11); }
  EXPECT_EQ(boost::filesystem::file_size(path), 3);
}

TEST(AtomicFile, FailsWhereNothingCanBeWritten) {
  const TestFolder folder;
  EXPECT_THROW(AtomicFile(folder.Path("missing/a.bin")), Failure);
  // The name is taken by a folder.
  boost::filesystem::create_directories(folder.Path("taken"));
  AtomicFile file(folder.Path("taken"));
  EXPECT_THROW(file.Commit(), Failure);
  EXPECT_EQ(folder.NumFiles(), 0);
}

// A temporary name of a process of this machine.
std::string OwnMark() {
  char host[256] = "";
  gethostname(host, sizeof(host) - 1);
  return std::string(".part-") + host + "-1-0";
}

TEST(AtomicFile, StaleTemporariesAreRemoved) {
  const TestFolder folder;
  AtomicFile being_written(folder.Path("a.bin"));
  // Nobody has these locked, whatever processes there are. Locks of another
  // machine need not be seen here, unless they are old.
  std::ofstream(folder.Path("a.bin" + OwnMark())) << "x";
  std::ofstream(folder.Path("b.bin" + OwnMark())) << "x";
  std::ofstream(folder.Path("c.part-elsewhere-1-0")) << "x";
  std::ofstream(folder.Path("d.part-elsewhere-1-0")) << "x";
  boost::filesystem::last_write_time(folder.Path("d.part-elsewhere-1-0"),
                                     std::time(nullptr) - 2 * 24 * 3600);
  std::ofstream(folder.Path("e.bin")) << "x";
  RemoveStaleTemporaries(folder.Path(""));
  EXPECT_FALSE(boost::filesystem::exists(folder.Path("a.bin" + OwnMark())));
  EXPECT_FALSE(boost::filesystem::exists(folder.Path("b.bin" + OwnMark())));
  EXPECT_TRUE(boost::filesystem::exists(folder.Path("c.part-elsewhere-1-0")));
  EXPECT_FALSE(boost::filesystem::exists(folder.Path("d.part-elsewhere-1-0")));
  EXPECT_EQ(folder.NumFiles(), 3);
  being_written.Commit();
  EXPECT_TRUE(boost::filesystem::exists(folder.Path("a.bin")));
}

TEST(AtomicFile, RemovesWhatAnotherRunHasLeftOfItself) {
  for (const std::string& name :
       {std::string("a.bin"), std::string(250, 'n')}) {
    // A process looks into a folder when it first writes there.
    const TestFolder folder;
    const std::string left = name.substr(0, 200) + OwnMark();
    std::ofstream(folder.Path(left)) << "x";
    std::ofstream(folder.Path("other" + OwnMark())) << "x";
    AtomicFile(folder.Path(name)).Commit();
    EXPECT_FALSE(boost::filesystem::exists(folder.Path(left)));
    EXPECT_TRUE(boost::filesystem::exists(folder.Path("other" + OwnMark())));
  }
}

TEST(PrepareFolder, MakesOrRefuses) {
  const TestFolder folder;
  PrepareFolder(folder.Path("x/y"), "maps");
  EXPECT_TRUE(boost::filesystem::is_directory(folder.Path("x/y")));
  EXPECT_TRUE(boost::filesystem::is_empty(folder.Path("x/y")));
  std::ofstream(folder.Path("file")) << "x";
  EXPECT_THROW(PrepareFolder(folder.Path("file"), "maps"), Failure);
}

}  // namespace
}  // namespace tapa
