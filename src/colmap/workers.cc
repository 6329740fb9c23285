#include "src/colmap/workers.h"

#include <sstream>

#include "src/files/failure.h"

namespace tapa {
namespace {

constexpr int kCpu = -1;

// Whether the GPU backend has computed on a GPU and was as good as the CPU. As
// long as it has not, it is for those who ask for a GPU by its number.
constexpr bool kTriedOnGpu = false;

std::vector<int> ParseList(const std::string& text) {
  std::vector<int> numbers;
  std::istringstream list(text);
  for (std::string item; std::getline(list, item, ',');) {
    try {
      numbers.push_back(std::stoi(item));
    } catch (const std::exception&) {
      throw Failure("PatchMatchStereo.gpu_index is " + text +
                    ", but must be -1 (all) or a list as in 0,1,2");
    }
  }
  return numbers;
}

void CheckIndex(int index, const DeviceList& list) {
  const int count = static_cast<int>(list.devices.size());
  if (index < 0 || index >= count) {
    throw Failure("PatchMatchStereo.gpu_index names GPU " +
                  std::to_string(index) + ", but there " +
                  (count == 1
                       ? "is only GPU 0"
                       : "are only GPUs 0 to " + std::to_string(count - 1)));
  }
  const DeviceList::Device& device = list.devices[index];
  if (!device.unusable.empty()) {
    throw Failure("PatchMatchStereo.gpu_index names GPU " +
                  std::to_string(index) + " (" + device.name +
                  "), which cannot be used: " + device.unusable);
  }
}

}  // namespace

Workers ChooseWorkers(bool use_gpu, const std::string& gpu_index,
                      const DeviceList& list) {
  Workers workers;
  if (!use_gpu) {
    workers.devices = {kCpu};
    return workers;
  }
  if (!list.why_none.empty()) {
    workers.devices = {kCpu};
    workers.message = "There is no GPU to compute on (" + list.why_none +
                      "): the CPU is used.";
    return workers;
  }
  if (gpu_index == "-1" && !kTriedOnGpu) {
    workers.devices = {kCpu};
    workers.message =
        "The CPU is used: computing on GPUs has not been tried on one yet. "
        "PatchMatchStereo.gpu_index 0 does it all the same.";
    return workers;
  }
  if (gpu_index == "-1") {
    for (size_t i = 0; i < list.devices.size(); ++i) {
      if (list.devices[i].unusable.empty()) {
        workers.devices.push_back(static_cast<int>(i));
      }
    }
  } else {
    workers.devices = ParseList(gpu_index);
  }
  // The names are read from this line by scripts/evaluation/machine.py.
  for (const int index : workers.devices) {
    CheckIndex(index, list);
    workers.message += (workers.message.empty() ? "Computing on GPU " : ", ") +
                       std::to_string(index) + " (" + list.devices[index].name +
                       ")";
  }
  workers.message += ".";
  return workers;
}

}  // namespace tapa
