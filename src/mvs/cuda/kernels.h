#ifndef TAPA_SRC_MVS_CUDA_KERNELS_H_
#define TAPA_SRC_MVS_CUDA_KERNELS_H_

#include <cuda_runtime_api.h>

#include "src/mvs/cuda/sweep_task.h"

namespace tapa {

struct DeviceProfile;

// What kernels read images through; 0 where it is not there.
struct TextureObjects {
  cudaTextureObject_t reference = 0;
  cudaTextureObject_t sources = 0;
  // With precise sampling in place of `sources`.
  cudaTextureObject_t exact_sources = 0;
  cudaTextureObject_t source_depths = 0;
};

// The instances that sweeps are compiled in. Few: each takes nvcc seconds for
// every architecture.
enum class KernelKind {
  // A warp per line, sizes as in CommonSizes.
  kCommon,
  // A warp per line, whatever the sizes.
  kAny,
  // As kAny, and source images are sampled precisely instead of with the
  // texture units' fractions of 8 bits, for comparisons with the CPU.
  kPrecise,
  // A thread per line, as the reference for speed. Sizes as in CommonSizes.
  kNaive,
};

// How kernels are launched for a problem.
struct KernelLaunch {
  // Throws DeviceLimitError if the device has too little shared memory.
  KernelLaunch(const SweepTask& task, KernelKind kind);

  KernelKind kind;
  int block_threads;
  int lines_per_block;
  size_t shared_bytes;
};

// All launch asynchronously in a stream and throw DeviceError if that fails.

// The costs of the estimates in rows [begin, end).
void LaunchInitialize(const KernelLaunch& launch, const SweepTask& task,
                      const TextureObjects& textures, int begin, int end,
                      cudaStream_t stream);

// The checkpoints of lines [begin, end).
void LaunchCheckpoints(const SweepTask& task, int begin, int end,
                       cudaStream_t stream);

// Pieces [begin_piece, end_piece) of lines [begin, end).
void LaunchSweepPieces(const KernelLaunch& launch, const SweepTask& task,
                       const TextureObjects& textures, int begin_piece,
                       int end_piece, int begin, int end, cudaStream_t stream);

// How many pieces the current device sweeps in about 40 ms, at least one: at
// the end of a launch warps wait for the slowest, while a device that also
// shows a screen must not be busy for long, nor one that is asked to stop.
int PiecesPerLaunch(const KernelLaunch& launch, const SweepTask& task);

// What the sweep's kernel takes on the current device.
void DescribeKernel(const KernelLaunch& launch, DeviceProfile* profile);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CUDA_KERNELS_H_
