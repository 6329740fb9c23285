#include "src/mvs/devices.h"

#include <cuda_runtime_api.h>

namespace tapa {
namespace {

// Turing.
constexpr int kMinCapability = 75;

std::string Version(int version) {
  return std::to_string(version / 1000) + "." +
         std::to_string(version % 1000 / 10);
}

// Why the driver gives no devices.
std::string DescribeError(cudaError_t status) {
  int driver = 0;
  cudaDriverGetVersion(&driver);
  if (driver == 0) {
    return "there is no NVIDIA driver on this machine";
  }
  if (status == cudaErrorInsufficientDriver) {
    return "the NVIDIA driver is too old: it is for CUDA " + Version(driver) +
           ", this program needs " + Version(CUDART_VERSION);
  }
  if (status == cudaErrorNoDevice) {
    return "there is no NVIDIA GPU that this program may use";
  }
  return std::string("the NVIDIA driver says: ") + cudaGetErrorString(status);
}

DeviceList::Device Describe(int index) {
  DeviceList::Device device;
  cudaDeviceProp properties;
  const cudaError_t status = cudaGetDeviceProperties(&properties, index);
  if (status != cudaSuccess) {
    device.unusable = cudaGetErrorString(status);
    return device;
  }
  device.name = properties.name;
  const int capability = 10 * properties.major + properties.minor;
  if (capability < kMinCapability) {
    device.unusable = "it is older than Turing (compute capability 7.5)";
  }
  return device;
}

}  // namespace

DeviceList FindDevices() {
  DeviceList list;
  int count = 0;
  const cudaError_t status = cudaGetDeviceCount(&count);
  if (status != cudaSuccess) {
    list.why_none = DescribeError(status);
    return list;
  }
  bool any = false;
  for (int i = 0; i < count; ++i) {
    list.devices.push_back(Describe(i));
    any = any || list.devices.back().unusable.empty();
  }
  if (!any) {
    list.why_none = count == 0
                        ? "there is no NVIDIA GPU"
                        : list.devices[0].name +
                              " cannot be used: " + list.devices[0].unusable;
  }
  return list;
}

}  // namespace tapa
