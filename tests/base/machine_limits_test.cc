#include "src/base/machine_limits.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

namespace tapa {
namespace {

// A tree of files such as those of /proc and /sys.
class ControlGroups : public testing::Test {
 protected:
  void SetUp() override {
    root_ = testing::TempDir() + "/control_groups_" +
            testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::remove_all(root_);
  }
  void TearDown() override { std::filesystem::remove_all(root_); }

  void Write(const std::string& path, const std::string& text) {
    const std::filesystem::path full = root_ + path;
    std::filesystem::create_directories(full.parent_path());
    std::ofstream(full) << text << "\n";
  }

  // On a machine of 1000 bytes and 8 CPUs.
  MachineLimits Limits() {
    MachineLimits limits;
    limits.memory_bytes = 1000;
    limits.num_cpus = 8;
    ApplyCgroupLimits(root_, &limits);
    return limits;
  }

  void ExpectLimits(double memory_bytes, int num_cpus) {
    EXPECT_EQ(Limits().memory_bytes, memory_bytes);
    EXPECT_EQ(Limits().num_cpus, num_cpus);
  }

 private:
  std::string root_;
};

TEST_F(ControlGroups, NoneLimitNothing) { ExpectLimits(1000, 8); }

TEST_F(ControlGroups, Version2) {
  Write("/proc/self/cgroup", "0::/job");
  Write("/sys/fs/cgroup/job/memory.max", "400");
  Write("/sys/fs/cgroup/job/cpu.max", "250000 100000");
  ExpectLimits(400, 3);
}

TEST_F(ControlGroups, MaxIsNoLimit) {
  Write("/proc/self/cgroup", "0::/job");
  Write("/sys/fs/cgroup/job/memory.max", "max");
  Write("/sys/fs/cgroup/job/cpu.max", "max 100000");
  ExpectLimits(1000, 8);
}

TEST_F(ControlGroups, SmallestOnTheWayUpCounts) {
  Write("/proc/self/cgroup", "0::/slice/job/step");
  Write("/sys/fs/cgroup/slice/memory.max", "300");
  Write("/sys/fs/cgroup/slice/job/memory.max", "500");
  Write("/sys/fs/cgroup/slice/job/step/memory.max", "max");
  Write("/sys/fs/cgroup/slice/job/cpu.max", "50000 100000");
  ExpectLimits(300, 1);
}

TEST_F(ControlGroups, WithinAContainerTheOwnGroupIsTheTop) {
  Write("/proc/self/cgroup", "0::/outside/of/here");
  Write("/sys/fs/cgroup/memory.max", "200");
  Write("/sys/fs/cgroup/cpu.max", "200000 100000");
  ExpectLimits(200, 2);
}

TEST_F(ControlGroups, Version1) {
  Write("/proc/self/cgroup", "4:memory:/a/b\n1:cpu,cpuacct:/a\n0::/");
  Write("/sys/fs/cgroup/memory/a/memory.limit_in_bytes", "600");
  Write("/sys/fs/cgroup/memory/a/b/memory.limit_in_bytes",
        "9223372036854771712");
  Write("/sys/fs/cgroup/cpu/a/cpu.cfs_quota_us", "400000");
  Write("/sys/fs/cgroup/cpu/a/cpu.cfs_period_us", "100000");
  Write("/sys/fs/cgroup/cpu/cpu.cfs_quota_us", "-1");
  Write("/sys/fs/cgroup/cpu/cpu.cfs_period_us", "100000");
  ExpectLimits(600, 4);
}

TEST_F(ControlGroups, MoreThanTheMachineHasIsNoLimit) {
  Write("/proc/self/cgroup", "0::/job");
  Write("/sys/fs/cgroup/job/memory.max", "5000");
  Write("/sys/fs/cgroup/job/cpu.max", "9900000 100000");
  ExpectLimits(1000, 8);
}

TEST_F(ControlGroups, DamagedFilesLimitNothing) {
  Write("/proc/self/cgroup", "what\n0::nowhere\n::\n0::/job");
  Write("/sys/fs/cgroup/job/memory.max", "-7");
  Write("/sys/fs/cgroup/job/cpu.max", "100000 0");
  ExpectLimits(1000, 8);
}

// As taskset and batch systems bind it.
TEST(MachineLimits, CountsTheCpusThatTheThreadIsBoundTo) {
  int num_cpus = 0;
  std::thread([&] {
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(sched_getcpu(), &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof(one), &one), 0);
    num_cpus = FindMachineLimits().num_cpus;
  }).join();
  EXPECT_EQ(num_cpus, 1);
}

TEST(MachineLimits, OfThisMachine) {
  const MachineLimits limits = FindMachineLimits();
  EXPECT_GT(limits.memory_bytes, 1 << 20);
  EXPECT_GE(limits.num_cpus, 1);
}

}  // namespace
}  // namespace tapa
