#ifndef TAPA_SRC_MVS_DEVICES_H_
#define TAPA_SRC_MVS_DEVICES_H_

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace tapa {

class Backend;
struct Options;
struct Problem;

// The GPUs of this machine, numbered from 0 as CUDA numbers them.
struct DeviceList {
  struct Device {
    std::string name;
    // Empty, or why the engine cannot compute on it.
    std::string unusable;
  };
  std::vector<Device> devices;
  // Why there is none that can be used, as half a sentence; empty: there is.
  std::string why_none;
};

// Never fails: without CUDA in the program, a driver or a device it says so.
DeviceList FindDevices();

// A GPU does not work, or has too little memory for a problem. The same problem
// can be computed on the CPU.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A problem is too large for the GPU, which can compute others.
class DeviceLimitError : public DeviceError {
 public:
  using DeviceError::DeviceError;
};

// It takes more memory than is free just now.
class DeviceMemoryError : public DeviceLimitError {
 public:
  using DeviceLimitError::DeviceLimitError;
};

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

// The backend on GPU options.device. Throws DeviceError, as all of its
// functions do; the problem can be computed by another one then. profile: not
// null: is filled from now on, for which the device waits between kernels.
std::unique_ptr<Backend> MakeCudaBackend(const Options& options,
                                         const Problem& problem,
                                         DeviceProfile* profile = nullptr);

// Bytes of device memory that the CUDA backend needs. For n source views and a
// reference view, all of w x h pixels:
//
//   w h (8 + 4 n + 1)     estimate, costs and probabilities, reference image
//   w h n                 source images
//   4 w h n               their depth maps, in the geometric pass
//   6 w h                 with TAPA: textureness and planes
//   about 8 n max(w, h)^1.5   messages on the way
//
// which makes 199 bytes per pixel at 20 views of 3200 x 2130, in the geometric
// pass with TAPA. What CUDA itself takes comes on top.
size_t EstimateDepthDeviceMemory(const Options& options,
                                 const Problem& problem);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_DEVICES_H_
