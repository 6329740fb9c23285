#ifndef TAPA_SRC_COLMAP_WORKERS_H_
#define TAPA_SRC_COLMAP_WORKERS_H_

#include <string>
#include <vector>

#include "src/mvs/devices.h"

namespace tapa {

// Who computes the views of a run.
struct Workers {
  // One worker, which computes one view at a time, for each: the number of its
  // GPU, or -1: the CPU with all of its threads.
  std::vector<int> devices;
  // What the user should know about the choice; empty: nothing.
  std::string message;
};

// gpu_index: "-1", all GPUs, or numbers separated by commas; a GPU that is
// named twice has two workers. Without any GPU that can be used the CPU is; so
// it is for "-1" as long as the GPU backend has never run on a GPU. Throws
// Failure if the list is none, or names a GPU that is not there.
Workers ChooseWorkers(bool use_gpu, const std::string& gpu_index,
                      const DeviceList& list);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_WORKERS_H_
