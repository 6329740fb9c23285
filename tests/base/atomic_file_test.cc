#include "src/base/atomic_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

namespace tapa {
namespace {

TEST(RemoveStaleTemporaries, LeavesWhatIsBeingWritten) {
  namespace fs = std::filesystem;
  const fs::path folder = testing::TempDir() + "/stale_temporaries";
  fs::remove_all(folder);
  fs::create_directories(folder);
  char host[256] = "";
  gethostname(host, sizeof(host) - 1);
  const auto write = [&](const std::string& name, int hours_ago) {
    std::ofstream(folder / name) << "part of a map";
    fs::last_write_time(folder / name, fs::file_time_type::clock::now() -
                                           std::chrono::hours(hours_ago));
  };
  // Nobody has locked it, so that its process is gone.
  const std::string of_dead_process = std::string("map.part-") + host + "-9-0";
  write(of_dead_process, 0);
  AtomicFile being_written(folder / "other_map");
  write("map.part-elsewhere-7-0", 1);
  write("map.part-elsewhere-8-0", 48);
  write("map", 48);
  RemoveStaleTemporaries(folder);
  EXPECT_FALSE(fs::exists(folder / of_dead_process));
  EXPECT_TRUE(fs::exists(folder / "map.part-elsewhere-7-0"));
  EXPECT_FALSE(fs::exists(folder / "map.part-elsewhere-8-0"));
  EXPECT_TRUE(fs::exists(folder / "map"));
  being_written.Commit();
  EXPECT_TRUE(fs::exists(folder / "other_map"));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace tapa
