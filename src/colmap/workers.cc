#include "src/colmap/workers.h"

#include <algorithm>
#include <regex>
#include <set>
#include <sstream>

#include "src/base/failure.h"

namespace tapa {
namespace {

void CheckIndex(int index, const DeviceList& list) {
  const int count = static_cast<int>(list.devices.size());
  if (index >= count) {
    throw Failure("PatchMatchStereo.gpu_index names GPU " +
                  std::to_string(index) + ", but there " +
                  (count == 1
                       ? "is only GPU 0"
                       : "are only GPUs 0 to " + std::to_string(count - 1)));
  }
}

std::string Describe(int index, const DeviceList& list) {
  return std::to_string(index) + " (" + list.devices[index].name + ")";
}

// evaluation/machine.py reads the names from this line.
std::string ComputingOn(const std::vector<int>& indices,
                        const DeviceList& list) {
  std::string names;
  for (const int index : indices) {
    names += (names.empty() ? "" : ", ") + Describe(index, list);
  }
  return "Computing on GPU " + names + ".";
}

Workers CpuInstead(const std::string& why) {
  return {{kCpu}, "Computing on the CPU, as " + why + "."};
}

Workers AllGpus(const DeviceList& list,
                const std::function<std::string(int)>& what_is_wrong,
                const MachineLimits& limits, double megapixels_per_view) {
  std::vector<int> sound;
  std::string wrong;
  for (int i = 0; i < static_cast<int>(list.devices.size()); ++i) {
    const std::string why = what_is_wrong(i);
    if (why.empty()) {
      sound.push_back(i);
    } else {
      wrong += (wrong.empty() ? "GPU " : "; GPU ") + Describe(i, list) +
               " cannot be used: " + why;
    }
  }
  if (sound.empty()) {
    return CpuInstead(wrong);
  }
  Workers workers;
  const int times = WorkersPerGpu(limits, static_cast<int>(sound.size()),
                                  megapixels_per_view);
  for (const int index : sound) {
    workers.devices.insert(workers.devices.end(), times, index);
  }
  workers.message =
      ComputingOn(sound, list) + (wrong.empty() ? "" : "\n" + wrong + ".");
  return workers;
}

Workers NamedGpus(const std::vector<int>& indices, const DeviceList& list,
                  const std::function<std::string(int)>& what_is_wrong) {
  for (const int index : indices) {
    CheckIndex(index, list);
  }
  for (const int index : std::set<int>(indices.begin(), indices.end())) {
    const std::string why = what_is_wrong(index);
    if (!why.empty()) {
      throw Failure("PatchMatchStereo.gpu_index names GPU " +
                    Describe(index, list) + ", which cannot be used: " + why +
                    "; PatchMatchStereo.use_gpu 0 computes on the CPU");
    }
  }
  return {indices, ComputingOn(indices, list)};
}

}  // namespace

int WorkersPerGpu(const MachineLimits& limits, int num_gpus,
                  double megapixels_per_view) {
  constexpr int kMin = 2;
  constexpr int kMax = 8;
  constexpr double kMaxMegapixels = 32;
  constexpr double kBytesPerMegapixel = 5e9 / kMaxMegapixels;
  const int by_threads = limits.num_cpus / (2 * num_gpus);
  const double megapixels = std::min(
      kMaxMegapixels, limits.memory_bytes / 2 / num_gpus / kBytesPerMegapixel);
  const int by_memory =
      static_cast<int>(std::min(megapixels / megapixels_per_view, 1e3));
  return std::clamp(std::min(by_threads, by_memory), kMin, kMax);
}

std::vector<int> ParseGpuIndices(const std::string& gpu_index) {
  static const std::regex list(" *[0-9]{1,9} *(, *[0-9]{1,9} *)*");
  std::vector<int> indices;
  if (gpu_index == "-1") {
    return indices;
  }
  if (!std::regex_match(gpu_index, list)) {
    throw Failure("PatchMatchStereo.gpu_index is " + gpu_index +
                  ", but must be -1 (all) or a list as in 0,1,2");
  }
  std::istringstream items(gpu_index);
  for (std::string item; std::getline(items, item, ',');) {
    indices.push_back(std::stoi(item));
  }
  return indices;
}

Workers ChooseWorkers(bool use_gpu, const std::string& gpu_index,
                      const DeviceList& list,
                      const std::function<std::string(int)>& try_device,
                      const MachineLimits& limits, double megapixels_per_view) {
  if (!use_gpu) {
    return {{kCpu}, ""};
  }
  if (list.devices.empty()) {
    return CpuInstead(list.why_none);
  }
  const auto what_is_wrong = [&](int index) {
    const std::string& unusable = list.devices[index].unusable;
    return unusable.empty() ? try_device(index) : unusable;
  };
  const std::vector<int> named = ParseGpuIndices(gpu_index);
  return named.empty()
             ? AllGpus(list, what_is_wrong, limits, megapixels_per_view)
             : NamedGpus(named, list, what_is_wrong);
}

}  // namespace tapa
