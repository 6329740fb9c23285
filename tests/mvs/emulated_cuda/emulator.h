#ifndef TAPA_TESTS_MVS_EMULATED_CUDA_EMULATOR_H_
#define TAPA_TESTS_MVS_EMULATED_CUDA_EMULATOR_H_

#include <cstddef>
#include <cstdint>

#include "tests/mvs/emulated_cuda/cuda_runtime_api.h"

// A GPU with its driver, emulated on the CPU for tests. It is slow, and finds
// what a real one would answer with wrong results, now and then:
//
// - Kernels run when somebody waits for their stream, or at any time before
//   that, and copies from the host arrive as late: what does not wait where it
//   has to reads what was there before.
// - Threads take turns in any order (threads.h).
// - Device memory ends where it ends, holds no zeros to begin with, and cannot
//   be read by the host: a program that tries is stopped by a signal.
// - Any call can be made to fail.

namespace emulated_cuda {

struct Settings {
  int num_devices = 1;
  // Of all devices together.
  size_t memory_bytes = size_t{1} << 30;
  // Key of the order in which threads, blocks and streams take turns; 0:
  // ascending, and as late as can be.
  uint32_t turns = 0;
  // What it says of its clock. As slow as this, little is done in one launch.
  int kilohertz = 100000;
  // Whether textures filter precisely, not with fractions of 8 bits.
  bool exact_filtering = false;
  // As if the device computed wrong: textures are black.
  bool black_textures = false;
  // The number, from 1, of the call that fails, and how. Calls that give
  // something back are not counted: nobody asks whether they failed.
  int failing_call = 0;
  cudaError_t failure = cudaErrorLaunchFailure;
  // Whether all calls after it fail too, as after an invalid access.
  bool fails_for_good = false;
};

// What the program holds and has asked for since Reset.
struct Usage {
  int num_calls = 0;
  // Arrays, textures, streams, events and pieces of memory.
  int num_objects = 0;
  size_t bytes = 0;
  size_t peak_bytes = 0;
};

// Starts anew; whatever is still held must not be used any more. A program
// starts with settings from the environment: EMULATED_GPU_MEMORY_KB,
// EMULATED_GPU_FAILING_CALL, EMULATED_GPU_BLACK_TEXTURES.
void Reset(const Settings& settings);
Usage GetUsage();

}  // namespace emulated_cuda

#endif  // TAPA_TESTS_MVS_EMULATED_CUDA_EMULATOR_H_
