#ifndef TAPA_TESTS_MVS_EMULATED_CUDA_THREADS_H_
#define TAPA_TESTS_MVS_EMULATED_CUDA_THREADS_H_

#include <cstddef>
#include <cstdint>
#include <functional>

struct dim3 {
  unsigned x = 1;
  unsigned y = 1;
  unsigned z = 1;

  dim3() = default;
  dim3(unsigned x) : x(x) {}  // NOLINT: as CUDA's.
};

// Those of the thread that runs.
extern thread_local dim3 threadIdx;
extern thread_local dim3 blockIdx;
extern thread_local dim3 blockDim;

namespace emulated_cuda {

constexpr int kWarpSize = 32;
// As on Hopper.
constexpr size_t kMaxSharedBytes = 227 * 1024;

// Runs body() in all threads of a block, one after the other, each until it
// waits for others. Finds what would hang or be undefined on a GPU, with a
// std::logic_error: threads that wait for one which does not come to where they
// are or comes for something else, and writes beyond the shared memory. It does
// not find a shuffle that is taken for a barrier of memory. Nobody gets shared
// memory that was set before. turns: key of the order in which threads take
// turns, 0: ascending; a missing synchronisation shows as a result that depends
// on it. Exceptions of body() are thrown here.
void RunBlock(unsigned block, unsigned num_threads, size_t shared_bytes,
              uint32_t turns, const std::function<void()>& body);

// A block of one warp.
void RunWarp(uint32_t turns, const std::function<void()>& body);

// For body(): waits for all threads of the block,
void SyncBlock();
// for the lanes of the mask, an aligned group of a power of two that the thread
// belongs to,
void SyncLanes(unsigned mask);
// and returns what lane `source` of the mask gave.
// what: names the operation; lanes that meet must have come for the same.
uint32_t Shuffle(unsigned mask, uint32_t value, int source, int what = 0);

}  // namespace emulated_cuda

#endif  // TAPA_TESTS_MVS_EMULATED_CUDA_THREADS_H_
