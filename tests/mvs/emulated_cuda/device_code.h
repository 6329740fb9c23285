#ifndef TAPA_TESTS_MVS_EMULATED_CUDA_DEVICE_CODE_H_
#define TAPA_TESTS_MVS_EMULATED_CUDA_DEVICE_CODE_H_

// Included before all others by files that are compiled as device code, see
// host_device.h.
#define TAPA_EMULATED_CUDA

#include "tests/mvs/emulated_cuda/cuda_runtime.h"

#endif  // TAPA_TESTS_MVS_EMULATED_CUDA_DEVICE_CODE_H_
