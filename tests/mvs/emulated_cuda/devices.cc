#include "tests/mvs/emulated_cuda/state.h"
#include "tests/mvs/emulated_cuda/threads.h"

using emulated_cuda::Call;
using emulated_cuda::State;

namespace {

thread_local int current_device = 0;

bool IsDevice(const State& state, int device) {
  return device >= 0 && device < state.settings.num_devices;
}

}  // namespace

const char* cudaGetErrorString(cudaError_t error) {
  switch (error) {
    case cudaSuccess:
      return "no error";
    case cudaErrorInvalidValue:
      return "invalid argument";
    case cudaErrorMemoryAllocation:
      return "out of memory";
    case cudaErrorInvalidConfiguration:
      return "invalid configuration argument";
    case cudaErrorInvalidDevice:
      return "invalid device ordinal";
    case cudaErrorNoDevice:
      return "no CUDA-capable device is detected";
    case cudaErrorInsufficientDriver:
      return "CUDA driver version is insufficient for CUDA runtime version";
    case cudaErrorInvalidResourceHandle:
      return "invalid resource handle";
    case cudaErrorLaunchFailure:
      return "unspecified launch failure";
  }
  return "unrecognized error code";
}

cudaError_t cudaGetDeviceCount(int* count) {
  return Call([&](State* state) {
    *count = state->settings.num_devices;
    return *count > 0 ? cudaSuccess : cudaErrorNoDevice;
  });
}

cudaError_t cudaSetDevice(int device) {
  return Call([&](State* state) {
    if (!IsDevice(*state, device)) {
      return cudaErrorInvalidDevice;
    }
    current_device = device;
    return cudaSuccess;
  });
}

cudaError_t cudaGetDevice(int* device) {
  return Call([&](State*) {
    *device = current_device;
    return cudaSuccess;
  });
}

cudaError_t cudaGetDeviceProperties(cudaDeviceProp* properties, int device) {
  return Call([&](State* state) {
    if (!IsDevice(*state, device)) {
      return cudaErrorInvalidDevice;
    }
    *properties = {"Emulated GPU", 9, 0, 1, 2048};
    return cudaSuccess;
  });
}

cudaError_t cudaDeviceGetAttribute(int* value, cudaDeviceAttr attribute, int) {
  return Call([&](State* state) {
    *value = attribute == cudaDevAttrClockRate ? state->settings.kilohertz
             : attribute == cudaDevAttrMultiProcessorCount
                 ? 1
                 : int{emulated_cuda::kMaxSharedBytes};
    return cudaSuccess;
  });
}

cudaError_t cudaDriverGetVersion(int* version) {
  return Call([&](State*) {
    *version = CUDART_VERSION;
    return cudaSuccess;
  });
}
