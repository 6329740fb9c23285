#ifndef TAPA_SRC_COLMAP_WORKERS_H_
#define TAPA_SRC_COLMAP_WORKERS_H_

#include <functional>
#include <string>
#include <vector>

#include "src/base/machine_limits.h"
#include "src/mvs/devices.h"

namespace tapa {

constexpr int kCpu = -1;

// Who computes the views of a run.
struct Workers {
  // One worker, which computes one view at a time, for each: the number of its
  // GPU, or kCpu: the CPU with all of its threads.
  std::vector<int> devices;
  // What the user should know about the choice; empty: nothing.
  std::string message;
};

// The GPUs of the option gpu_index, numbers from 0 separated by commas; empty:
// all, for which "-1" stands. Throws Failure that names the option if it is
// neither.
std::vector<int> ParseGpuIndices(const std::string& gpu_index);

// How many workers keep a GPU busy, 2 to 8: while a view is read or written, or
// the CPU looks for its planes, the GPU sweeps others. A thread works for each
// and another waits for the GPU: the CPUs are shared out among the GPUs.
// Views are limited to about 32 megapixels together, with some 5 GB of memory,
// and to less where half of the memory that the program may use is less.
int WorkersPerGpu(const MachineLimits& limits, int num_gpus,
                  double megapixels_per_view);

// gpu_index: of all GPUs each has WorkersPerGpu(number of those that can be
// used); for each that is named there is one, so that a GPU may be named
// several times. Without any GPU that can be used the CPU is. limits: what the
// program may use. try_device: says
// what is wrong with a GPU, or nothing (device_trial.h). Throws Failure if a
// GPU is named that cannot be used.
Workers ChooseWorkers(bool use_gpu, const std::string& gpu_index,
                      const DeviceList& list,
                      const std::function<std::string(int)>& try_device,
                      const MachineLimits& limits, double megapixels_per_view);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_WORKERS_H_
