#include <cuda_runtime.h>

#include <algorithm>

#include "src/mvs/cuda/device_textures.h"
#include "src/mvs/cuda/kernels.h"
#include "src/mvs/cuda/lanes.h"
#include "src/mvs/cuda/memory.h"
#include "src/mvs/cuda/sweep_body.h"
#include "src/mvs/device_error.h"
#include "src/mvs/sweep/lanes.h"
#include "src/mvs/testing.h"

namespace tapa {

// The memory that a block shares: the cameras, which lanes read at different
// views at a time, for which constant memory is slow, then the scratch of each
// warp.
extern __shared__ __align__(16) float shared_words[];

namespace {

constexpr int kWarpSize = WarpLanes::kSize;
// Lines of a block of warps: neighbours, which read the same parts of images.
constexpr int kWarpsPerBlock = 4;
constexpr int kBlockThreads = kWarpsPerBlock * kWarpSize;
// 16 warps per multiprocessor: with more, of fewer registers, an H200 is no
// faster (docs/results.md). Turing has shared memory for 12.
constexpr int kMinBlocks = 4;
// As COLMAP's kernel has.
constexpr int kNaiveBlockThreads = 32;
// Pixels that a warp initializes one after the other.
constexpr int kPixelsPerWarp = 32;

template <class Sizes>
__host__ __device__ int CameraWords(const SweepTask& task) {
  return SourceCameras::kNumCoefficients * Sizes::Stride(task.num_views);
}

// The cameras, copied to shared memory by the threads of a block.
template <class Sizes>
__device__ __forceinline__ SourceCameras LoadCameras(const SweepTask& task,
                                                     float* shared) {
  const int n = task.num_views;
  const int stride = Sizes::Stride(n);
  for (int i = threadIdx.x; i < SourceCameras::kNumCoefficients * n;
       i += blockDim.x) {
    shared[i / n * stride + i % n] = task.cameras[i];
  }
  __syncthreads();
  return ArrangeCameras(shared, stride, n, n);
}

template <class Sizes>
__device__ __forceinline__ float* WarpScratch(const SweepTask& task,
                                              float* shared) {
  return shared + CameraWords<Sizes>(task) +
         threadIdx.x / kWarpSize *
             ScratchWords<WarpLanes, Sizes>(task.window, task.num_views,
                                            task.geometric);
}

template <class Sizes, bool kPrecise>
__global__ void __launch_bounds__(kBlockThreads, kMinBlocks)
    SweepPiecesKernel(const __grid_constant__ SweepTask task,
                      const __grid_constant__ TextureObjects objects,
                      int begin_piece, int end_piece, int begin, int end) {
  const SourceCameras views = LoadCameras<Sizes>(task, shared_words);
  const int line = begin + (blockIdx.x * blockDim.x + threadIdx.x) / kWarpSize;
  if (line < end) {
    SweepPieces<WarpLanes, Sizes>(
        task, views, DeviceTextures<kPrecise>(objects), line, begin_piece,
        end_piece, WarpScratch<Sizes>(task, shared_words));
  }
}

template <class Sizes, bool kPrecise>
__global__ void __launch_bounds__(kBlockThreads, kMinBlocks)
    InitializeKernel(const __grid_constant__ SweepTask task,
                     const __grid_constant__ TextureObjects objects,
                     size_t begin, size_t end) {
  const SourceCameras views = LoadCameras<Sizes>(task, shared_words);
  const size_t warp =
      (static_cast<size_t>(blockIdx.x) * blockDim.x + threadIdx.x) / kWarpSize;
  const size_t first = begin + warp * kPixelsPerWarp;
  for (size_t i = first; i < first + kPixelsPerWarp && i < end; ++i) {
    InitializePixel<WarpLanes, Sizes>(
        task, views, DeviceTextures<kPrecise>(objects),
        static_cast<int>(i / task.width), static_cast<int>(i % task.width),
        WarpScratch<Sizes>(task, shared_words));
  }
}

__global__ void CheckpointKernel(const __grid_constant__ SweepTask task,
                                 int begin, int end) {
  const int line = begin + (blockIdx.x * blockDim.x + threadIdx.x) / kWarpSize;
  if (line < end) {
    ComputeCheckpoints<WarpLanes>(task, line);
  }
}

// The reference: a thread does everything for its line.
__global__ void NaiveSweepPiecesKernel(
    const __grid_constant__ SweepTask task,
    const __grid_constant__ TextureObjects objects, int begin_piece,
    int end_piece, int begin, int end) {
  const SourceCameras views = LoadCameras<CommonSizes>(task, shared_words);
  constexpr int kWords =
      (kViewArrays + kGeometricArrays) * CommonSizes::kMaxViews +
      kPaddedFixedWords + kPatchSampleWords * CommonSizes::kNumSamples;
  __align__(16) float words[kWords];
  const int line = begin + blockIdx.x * blockDim.x + threadIdx.x;
  if (line < end) {
    SweepPieces<SerialLanes, CommonSizes>(task, views,
                                          DeviceTextures<false>(objects), line,
                                          begin_piece, end_piece, words);
  }
}

using SweepKernel = void (*)(SweepTask, TextureObjects, int, int, int, int);
using InitializeKernelPointer = void (*)(SweepTask, TextureObjects, size_t,
                                         size_t);

SweepKernel SweepKernelOf(KernelKind kind) {
  switch (kind) {
    case KernelKind::kCommon:
      return SweepPiecesKernel<CommonSizes, false>;
    case KernelKind::kAny:
      return SweepPiecesKernel<AnySizes, false>;
    case KernelKind::kPrecise:
      return SweepPiecesKernel<AnySizes, true>;
    case KernelKind::kNaive:
      break;
  }
  return NaiveSweepPiecesKernel;
}

InitializeKernelPointer InitializeKernelOf(KernelKind kind) {
  switch (kind) {
    case KernelKind::kAny:
      return InitializeKernel<AnySizes, false>;
    case KernelKind::kPrecise:
      return InitializeKernel<AnySizes, true>;
    default:
      return InitializeKernel<CommonSizes, false>;
  }
}

// How many threads run a kernel, and where. what: for messages.
struct Grid {
  int num_blocks;
  int block_threads;
  size_t shared_bytes;
  cudaStream_t stream;
  const char* what;
};

template <typename... Params, typename... Args>
void Launch(void (*kernel)(Params...), const Grid& grid, const Args&... args) {
  cudaLaunchConfig_t config = {};
  config.gridDim = grid.num_blocks;
  config.blockDim = grid.block_threads;
  config.dynamicSmemBytes = grid.shared_bytes;
  config.stream = grid.stream;
  CheckCuda(cudaLaunchKernelEx(&config, kernel, args...), grid.what);
}

int NumBlocks(size_t count, size_t per_block) {
  return static_cast<int>((count + per_block - 1) / per_block);
}

size_t SharedBytes(const SweepTask& task, KernelKind kind, int num_warps) {
  const bool common = kind == KernelKind::kCommon || kind == KernelKind::kNaive;
  const int cameras =
      common ? CameraWords<CommonSizes>(task) : CameraWords<AnySizes>(task);
  const int scratch = kind == KernelKind::kNaive ? 0
                      : common
                          ? ScratchWords<WarpLanes, CommonSizes>(
                                task.window, task.num_views, task.geometric)
                          : ScratchWords<WarpLanes, AnySizes>(
                                task.window, task.num_views, task.geometric);
  return (cameras + static_cast<size_t>(num_warps) * scratch) * sizeof(float);
}

int DeviceAttribute(cudaDeviceAttr attribute) {
  int device = 0;
  int value = 0;
  CheckCuda(cudaGetDevice(&device), "asking for the GPU");
  CheckCuda(cudaDeviceGetAttribute(&value, attribute, device),
            "asking for the GPU's properties");
  return value;
}

int MaxSharedBytes() {
  return DeviceAttribute(cudaDevAttrMaxSharedMemoryPerBlockOptin);
}

// As much as there is, whatever the problem: the limit is one for all threads
// of the program, and others may be between two launches that need more.
void AllowSharedBytes(const void* kernel) {
  CheckCuda(
      cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize,
                           MaxSharedBytes()),
      "setting a kernel's shared memory");
}

}  // namespace

KernelLaunch::KernelLaunch(const SweepTask& task, KernelKind kind)
    : kind(kind) {
  const bool naive = kind == KernelKind::kNaive;
  // Large windows and many views leave room for fewer warps in a block.
  int num_warps = naive ? 0 : kWarpsPerBlock;
  constexpr size_t kUsualBytes = 48 * 1024;
  while (num_warps > 1 && SharedBytes(task, kind, num_warps) > kUsualBytes) {
    num_warps /= 2;
  }
  shared_bytes = SharedBytes(task, kind, num_warps);
  if (shared_bytes > static_cast<size_t>(MaxSharedBytes())) {
    throw DeviceLimitError(
        "the window is too large, or there are too many source views, for the "
        "GPU's shared memory");
  }
  block_threads = naive ? kNaiveBlockThreads : num_warps * kWarpSize;
  lines_per_block = naive ? kNaiveBlockThreads : num_warps;
  AllowSharedBytes(reinterpret_cast<const void*>(SweepKernelOf(kind)));
  AllowSharedBytes(reinterpret_cast<const void*>(InitializeKernelOf(kind)));
}

void LaunchInitialize(const KernelLaunch& launch, const SweepTask& task,
                      const TextureObjects& textures, int begin, int end,
                      cudaStream_t stream) {
  const size_t first = task.Pixel(begin, 0);
  const size_t last = task.Pixel(end, 0);
  // The naive kernel is one for sweeps only.
  const KernelLaunch usual = launch.kind == KernelKind::kNaive
                                 ? KernelLaunch(task, KernelKind::kCommon)
                                 : launch;
  const InitializeKernelPointer kernel = InitializeKernelOf(usual.kind);
  const size_t pixels_per_block = usual.lines_per_block * kPixelsPerWarp;
  Launch(kernel,
         {NumBlocks(last - first, pixels_per_block), usual.block_threads,
          usual.shared_bytes, stream, "computing first costs on the GPU"},
         task, textures, first, last);
}

void LaunchCheckpoints(const SweepTask& task, int begin, int end,
                       cudaStream_t stream) {
  Launch(CheckpointKernel,
         {NumBlocks(end - begin, kWarpsPerBlock), kBlockThreads, 0, stream,
          "computing messages on the GPU"},
         task, begin, end);
}

int PiecesPerLaunch(const KernelLaunch& launch, const SweepTask& task) {
  constexpr double kSeconds = 0.04;
  // An estimate: what a pixel takes beside correlations counts as some more.
  constexpr double kCorrelationsPerPixel = 40;
  // A quarter of what texture units can do.
  constexpr double kSamplesPerCycle = 1;
  if (launch.kind == KernelKind::kNaive) {
    return 1;
  }
  const double samples_per_second =
      kSamplesPerCycle * 1e3 * DeviceAttribute(cudaDevAttrClockRate) *
      DeviceAttribute(cudaDevAttrMultiProcessorCount);
  const double samples_per_piece = kCorrelationsPerPixel *
                                   task.window.NumSamples() *
                                   task.piece_length * task.NumLines();
  const double pieces = kSeconds * samples_per_second / samples_per_piece;
  return static_cast<int>(std::clamp<double>(pieces, 1, task.NumPieces()));
}

void LaunchSweepPieces(const KernelLaunch& launch, const SweepTask& task,
                       const TextureObjects& textures, int begin_piece,
                       int end_piece, int begin, int end, cudaStream_t stream) {
  Launch(SweepKernelOf(launch.kind),
         {NumBlocks(end - begin, launch.lines_per_block), launch.block_threads,
          launch.shared_bytes, stream, "sweeping on the GPU"},
         task, textures, begin_piece, end_piece, begin, end);
}

void DescribeKernel(const KernelLaunch& launch, DeviceProfile* profile) {
  const void* kernel =
      reinterpret_cast<const void*>(SweepKernelOf(launch.kind));
  cudaFuncAttributes attributes;
  CheckCuda(cudaFuncGetAttributes(&attributes, kernel), "asking for a kernel");
  int blocks = 0;
  CheckCuda(cudaOccupancyMaxActiveBlocksPerMultiprocessor(
                &blocks, kernel, launch.block_threads, launch.shared_bytes),
            "asking for a kernel's occupancy");
  int device = 0;
  cudaDeviceProp properties;
  CheckCuda(cudaGetDevice(&device), "asking for the GPU");
  CheckCuda(cudaGetDeviceProperties(&properties, device),
            "asking for the GPU's properties");
  profile->registers = attributes.numRegs;
  profile->shared_bytes = attributes.sharedSizeBytes + launch.shared_bytes;
  profile->occupancy = static_cast<double>(blocks) * launch.block_threads /
                       properties.maxThreadsPerMultiProcessor;
  profile->resident_lines =
      blocks * launch.lines_per_block * properties.multiProcessorCount;
}

}  // namespace tapa
