#ifndef TAPA_SRC_MVS_TESTING_H_
#define TAPA_SRC_MVS_TESTING_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "src/mvs/backend.h"
#include "src/mvs/options.h"
#include "src/mvs/problem.h"

// FOR TESTS AND BENCHMARKS ONLY: what they see of the backends and switch in
// them. Nothing of the product includes this but the backends.

namespace tapa {

// Where the time on a GPU goes, over all calls.
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

// How a GPU sweeps.
struct CudaSwitches {
  // Samples source images as precisely as the CPU does.
  bool precise_textures = false;
  // Runs one thread per line.
  bool naive_kernel = false;
  // Filled from now on if not null, for which the device waits between kernels.
  DeviceProfile* profile = nullptr;
};

class BackendForTesting : public Backend {
 public:
  // Costs of the estimates as they are between two sweeps, in fixed point
  // (EncodeCost), at [pixel * number of views + view]. Gone after a sweep that
  // checks consistency.
  virtual std::vector<uint16_t> Costs() const = 0;
};

// The backends of backends.h.
std::unique_ptr<BackendForTesting> MakeCpuBackendForTesting(
    const Options& options, const Problem& problem);
// Throws std::invalid_argument for the naive kernel where it is not made for
// the problem's sizes.
std::unique_ptr<BackendForTesting> MakeCudaBackendForTesting(
    const Options& options, const Problem& problem,
    const CudaSwitches& switches = CudaSwitches());

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TESTING_H_
