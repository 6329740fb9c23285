#ifndef TAPA_SRC_MVS_CUDA_DEVICE_PROFILE_H_
#define TAPA_SRC_MVS_CUDA_DEVICE_PROFILE_H_

#include <cstddef>
#include <string>

namespace tapa {

// Where the time on a GPU goes, for benchmarks.
struct DeviceProfile {
  std::string name;
  int num_multiprocessors = 0;
  double clock_hz = 0;
  // Of the kernel that sweeps: registers per thread, bytes of shared memory per
  // block, share of the device's threads that can be resident, and lines that
  // can be swept at a time.
  int registers = 0;
  size_t shared_bytes = 0;
  double occupancy = 0;
  int resident_lines = 0;
  // Seconds so far in each kernel: first costs, backward messages, sweeps.
  double initialize_seconds = 0;
  double checkpoint_seconds = 0;
  double sweep_seconds = 0;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CUDA_DEVICE_PROFILE_H_
