// What the program has in place of the CUDA backend where it is built without.

#include "src/mvs/backends.h"
#include "src/mvs/device_error.h"
#include "src/mvs/devices.h"
#include "src/mvs/testing.h"

namespace tapa {

DeviceList FindDevices() {
  DeviceList list;
  list.why_none = "this program was built without CUDA";
  return list;
}

std::unique_ptr<BackendForTesting> MakeCudaBackendForTesting(
    const Options&, const Problem&, const CudaSwitches&) {
  throw DeviceError(FindDevices().why_none);
}

std::unique_ptr<Backend> MakeCudaBackend(const Options& options,
                                         const Problem& problem) {
  return MakeCudaBackendForTesting(options, problem);
}

}  // namespace tapa
