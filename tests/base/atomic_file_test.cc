#include "src/base/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

namespace tapa {
namespace {

// What becomes of unfinished files is tested with maps (map_files_test.cc).
TEST(RemoveStaleTemporaries, LeavesWhatOnlyLooksLikeOne) {
  namespace fs = std::filesystem;
  const fs::path folder = testing::TempDir() + "/stale_temporaries";
  fs::remove_all(folder);
  fs::create_directories(folder);
  const auto write_old = [&](const std::string& name) {
    std::ofstream(folder / name) << "a map";
    fs::last_write_time(folder / name, fs::file_time_type::clock::now() -
                                           std::chrono::hours(48));
  };
  write_old("map.part-elsewhere-8-0");
  // Of photographs that are called so.
  const std::string kept[] = {"map", "hall.part-2-3", "hall.part-2.jpg.bin",
                              "hall.part-2-3-4.jpg.geometric.bin"};
  for (const std::string& name : kept) {
    write_old(name);
  }
  // To open it would take until somebody writes.
  ASSERT_EQ(mkfifo((folder / "pipe.part-elsewhere-7-1").c_str(), 0666), 0);
  RemoveStaleTemporaries(folder);
  EXPECT_FALSE(fs::exists(folder / "map.part-elsewhere-8-0"));
  for (const std::string& name : kept) {
    EXPECT_TRUE(fs::exists(folder / name)) << name;
  }
  EXPECT_TRUE(fs::exists(folder / "pipe.part-elsewhere-7-1"));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace tapa
