#ifndef TAPA_TESTS_MVS_EMULATED_CUDA_CUDA_RUNTIME_H_
#define TAPA_TESTS_MVS_EMULATED_CUDA_CUDA_RUNTIME_H_

// As cuda_runtime_api.h, with what CUDA has for C++ and for device code.

#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>

#include "tests/mvs/emulated_cuda/cuda_runtime_api.h"
#include "tests/mvs/emulated_cuda/textures.h"
#include "tests/mvs/emulated_cuda/threads.h"

// Device code is plain C++ here.
#define __host__
#define __device__
#define __forceinline__ inline
#define __global__
#define __grid_constant__
#define __launch_bounds__(...)
#define __align__(bytes) __attribute__((aligned(bytes)))
// A kernel's dynamic shared memory, which the emulator gives to a block at a
// time, has to be named shared_words and be declared in namespace tapa.
#define __shared__

inline cudaExtent make_cudaExtent(size_t width, size_t height, size_t depth) {
  return {width, height, depth};
}
inline cudaPos make_cudaPos(size_t x, size_t y, size_t z) { return {x, y, z}; }
inline cudaPitchedPtr make_cudaPitchedPtr(void* data, size_t pitch,
                                          size_t width, size_t height) {
  return {data, pitch, width, height};
}

// Launches.

struct cudaLaunchConfig_t {
  dim3 gridDim;
  dim3 blockDim;
  size_t dynamicSmemBytes;
  cudaStream_t stream;
  void* attrs;
  unsigned numAttrs;
};

namespace emulated_cuda {

cudaError_t Launch(const cudaLaunchConfig_t& config, const void* kernel,
                   std::function<void()> thread);

}  // namespace emulated_cuda

template <typename... Params, typename... Args>
cudaError_t cudaLaunchKernelEx(const cudaLaunchConfig_t* config,
                               void (*kernel)(Params...), Args&&... args) {
  // Arguments are copied at once, as a launch does.
  return emulated_cuda::Launch(*config, reinterpret_cast<const void*>(kernel),
                               std::bind(kernel, static_cast<Params>(args)...));
}

// Device functions, as exact as the device's.

inline float __expf(float x) { return std::exp2(x * 1.44269504f); }

inline void __syncthreads() { emulated_cuda::SyncBlock(); }
inline void __syncwarp(unsigned mask = 0xFFFFFFFFu) {
  emulated_cuda::SyncLanes(mask);
}
template <typename T>
T __shfl_sync(unsigned mask, T value, int source, int what = 0) {
  static_assert(sizeof(T) == sizeof(uint32_t), "");
  uint32_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  bits = emulated_cuda::Shuffle(mask, bits, source, what);
  std::memcpy(&value, &bits, sizeof(bits));
  return value;
}
template <typename T>
T __shfl_xor_sync(unsigned mask, T value, int lane_mask) {
  const int lane = threadIdx.x % emulated_cuda::kWarpSize;
  return __shfl_sync(mask, value, lane ^ lane_mask, lane_mask);
}

template <typename T>
T tex2D(cudaTextureObject_t object, float x, float y) {
  return emulated_cuda::FetchTexture<T>(object, x, y, emulated_cuda::kNoLayers);
}
template <typename T>
T tex2DLayered(cudaTextureObject_t object, float x, float y, int layer) {
  return emulated_cuda::FetchTexture<T>(object, x, y, layer);
}

#endif  // TAPA_TESTS_MVS_EMULATED_CUDA_CUDA_RUNTIME_H_
