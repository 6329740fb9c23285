#include "src/colmap/workers.h"

#include <gtest/gtest.h>

#include "src/files/failure.h"

namespace tapa {
namespace {

DeviceList TwoGpus() {
  DeviceList list;
  list.devices = {{"Fast", ""}, {"Old", "it is too old"}, {"Slow", ""}};
  return list;
}

TEST(Workers, AreTheGpusOfTheList) {
  const auto devices = [](const char* gpu_index) {
    return ChooseWorkers(true, gpu_index, TwoGpus()).devices;
  };
  // Not yet all of them: nobody has tried one.
  EXPECT_EQ(devices("-1"), (std::vector<int>{-1}));
  EXPECT_EQ(devices("2"), (std::vector<int>{2}));
  EXPECT_EQ(devices("2, 0"), (std::vector<int>{2, 0}));
  EXPECT_EQ(devices("0,0"), (std::vector<int>{0, 0}));
  EXPECT_EQ(ChooseWorkers(true, "0,0", TwoGpus()).message,
            "Computing on GPU 0 (Fast), 0 (Fast).");
}

TEST(Workers, AreTheCpuWhereThereIsNoGpuOrNoneIsWanted) {
  DeviceList none;
  none.why_none = "there is no driver";
  const Workers workers = ChooseWorkers(true, "3", none);
  EXPECT_EQ(workers.devices, (std::vector<int>{-1}));
  EXPECT_NE(workers.message.find("there is no driver"), std::string::npos);
  EXPECT_NE(workers.message.find("the CPU is used"), std::string::npos);

  const Workers unwanted = ChooseWorkers(false, "0", TwoGpus());
  EXPECT_EQ(unwanted.devices, (std::vector<int>{-1}));
  EXPECT_EQ(unwanted.message, "");
}

TEST(Workers, NameWhatIsWrongWithTheList) {
  const auto error = [](const char* gpu_index) -> std::string {
    try {
      ChooseWorkers(true, gpu_index, TwoGpus());
    } catch (const Failure& failure) {
      return failure.what();
    }
    return "";
  };
  EXPECT_NE(error("3").find("only GPUs 0 to 2"), std::string::npos);
  EXPECT_NE(error("0,1").find("it is too old"), std::string::npos);
  EXPECT_NE(error("x").find("gpu_index"), std::string::npos);
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
