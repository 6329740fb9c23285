// The kernels, for the emulated device.

#include "tests/mvs/emulated_cuda/device_code.h"
//
#include "src/mvs/cuda/kernels.cu"
