#include "src/colmap/workers.h"

#include <gtest/gtest.h>

#include "src/base/failure.h"

namespace tapa {
namespace {

DeviceList TwoGpus() {
  DeviceList list;
  list.devices = {{"Fast", ""}, {"Old", "it is too old"}, {"Slow", ""}};
  return list;
}

std::string NothingIsWrong(int) { return ""; }

MachineLimits Limits(int num_cpus, double memory_bytes = 1e12) {
  MachineLimits limits;
  limits.num_cpus = num_cpus;
  limits.memory_bytes = memory_bytes;
  return limits;
}

Workers Choose(const std::string& gpu_index) {
  return ChooseWorkers(true, gpu_index, TwoGpus(), NothingIsWrong, Limits(8),
                       1);
}

TEST(Workers, AreTheGpusOfTheList) {
  EXPECT_EQ(Choose("-1").devices, (std::vector<int>{0, 0, 2, 2}));
  EXPECT_EQ(Choose("-1").message,
            "Computing on GPU 0 (Fast), 2 (Slow).\n"
            "GPU 1 (Old) cannot be used: it is too old.");
  EXPECT_EQ(Choose("2").devices, (std::vector<int>{2}));
  EXPECT_EQ(Choose("2, 0").devices, (std::vector<int>{2, 0}));
  EXPECT_EQ(Choose("0,0").devices, (std::vector<int>{0, 0}));
  EXPECT_EQ(Choose("0,0").message, "Computing on GPU 0 (Fast), 0 (Fast).");
}

TEST(Workers, AreAsManyAsThreadsAndMemoryAreFor) {
  EXPECT_EQ(WorkersPerGpu(Limits(2), 1, 1), 2);
  EXPECT_EQ(WorkersPerGpu(Limits(8), 1, 1), 4);
  EXPECT_EQ(WorkersPerGpu(Limits(8), 2, 1), 2);
  EXPECT_EQ(WorkersPerGpu(Limits(64), 1, 1), 8);
  EXPECT_EQ(WorkersPerGpu(Limits(64), 1, 6), 5);
  EXPECT_EQ(WorkersPerGpu(Limits(64), 1, 24), 2);
  EXPECT_EQ(WorkersPerGpu(Limits(64), 1, 1e-9), 8);
  // Half of the memory is for 5 or for 2 views of 6 megapixels.
  EXPECT_EQ(WorkersPerGpu(Limits(64, 10.1e9), 1, 6), 5);
  EXPECT_EQ(WorkersPerGpu(Limits(64, 6e9), 1, 6), 3);
  EXPECT_EQ(WorkersPerGpu(Limits(64, 12e9), 2, 6), 3);
  EXPECT_EQ(WorkersPerGpu(Limits(64, 1e9), 1, 6), 2);
}

TEST(Workers, AreTheCpuWhereThereIsNoGpuOrNoneIsWanted) {
  DeviceList none;
  none.why_none = "there is no driver";
  const Workers workers =
      ChooseWorkers(true, "3", none, NothingIsWrong, Limits(8), 1);
  EXPECT_EQ(workers.devices, (std::vector<int>{kCpu}));
  EXPECT_EQ(workers.message, "Computing on the CPU, as there is no driver.");

  const Workers unwanted =
      ChooseWorkers(false, "0", TwoGpus(), NothingIsWrong, Limits(8), 1);
  EXPECT_EQ(unwanted.devices, (std::vector<int>{kCpu}));
  EXPECT_EQ(unwanted.message, "");
}

TEST(Workers, AreThoseThatComputeWhatTheyShould) {
  std::vector<int> tried;
  const auto try_device = [&](int device) -> std::string {
    tried.push_back(device);
    return device == 0 ? "it is broken" : "";
  };
  EXPECT_EQ(
      ChooseWorkers(true, "-1", TwoGpus(), try_device, Limits(8), 1).devices,
      (std::vector<int>{2, 2, 2, 2}));
  EXPECT_EQ(tried, (std::vector<int>{0, 2}));
  // Once each, and only those that are asked for.
  tried.clear();
  ChooseWorkers(true, "2,2", TwoGpus(), try_device, Limits(8), 1);
  EXPECT_EQ(tried, (std::vector<int>{2}));
  EXPECT_THROW(ChooseWorkers(true, "2,0", TwoGpus(), try_device, Limits(8), 1),
               Failure);

  const auto all_broken = [](int) { return std::string("it is broken"); };
  const Workers none =
      ChooseWorkers(true, "-1", TwoGpus(), all_broken, Limits(8), 1);
  EXPECT_EQ(none.devices, (std::vector<int>{kCpu}));
  EXPECT_NE(none.message.find("GPU 0 (Fast) cannot be used: it is broken"),
            std::string::npos);
}

TEST(Workers, NameWhatIsWrongWithTheList) {
  const auto error = [](const char* gpu_index) -> std::string {
    try {
      Choose(gpu_index);
    } catch (const Failure& failure) {
      return failure.what();
    }
    return "";
  };
  EXPECT_NE(error("3").find("only GPUs 0 to 2"), std::string::npos);
  EXPECT_NE(error("-2").find("gpu_index is -2"), std::string::npos);
  EXPECT_NE(error("0,1").find("it is too old"), std::string::npos);
  EXPECT_NE(error("x").find("gpu_index is x"), std::string::npos);
}

// Whatever the machine, asking is safe.
TEST(Devices, AreThereOrItIsSaidWhyNot) {
  const DeviceList list = FindDevices();
  bool any = false;
  for (const DeviceList::Device& device : list.devices) {
    any = any || device.unusable.empty();
  }
  EXPECT_EQ(any, list.why_none.empty());
}

}  // namespace
}  // namespace tapa
