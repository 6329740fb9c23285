#ifndef TAPA_TESTS_MVS_EMULATED_CUDA_STATE_H_
#define TAPA_TESTS_MVS_EMULATED_CUDA_STATE_H_

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <random>
#include <set>
#include <vector>

#include "tests/mvs/emulated_cuda/emulator.h"

// A stream: its work, which is done in order.
struct CUstream_st {
  std::deque<std::function<void()>> work;
  uint64_t num_added = 0;
  uint64_t num_done = 0;

  void Add(std::function<void()> item);
  void RunOne();
  void RunUntil(uint64_t num);
  void RunAll() { RunUntil(num_added); }
};

struct CUevent_st {
  // Where it was recorded; null: nowhere.
  cudaStream_t stream = nullptr;
  uint64_t num_before = 0;
};

struct cudaArray {
  size_t bytes_per_element = 0;
  cudaChannelFormatKind kind = cudaChannelFormatKindUnsigned;
  size_t width = 0;
  size_t height = 0;
  // 0: a plain image.
  size_t num_layers = 0;
  std::vector<uint8_t> bytes;
};

namespace emulated_cuda {

struct Texture {
  const cudaArray* array;
  cudaTextureDesc description;
};

// All that the parts of the emulator share. One call at a time: calls lock it.
struct State {
  std::recursive_mutex mutex;
  Settings settings;
  Usage usage;
  std::mt19937 random;
  // Bytes of every piece of device memory.
  std::map<void*, size_t> memory;
  std::map<cudaTextureObject_t, Texture> textures;
  cudaTextureObject_t last_texture = 0;
  std::set<cudaStream_t> streams;
  // That of copies.
  CUstream_st default_stream;
  // Of dynamic shared memory, by kernel.
  std::map<const void*, size_t> max_shared_bytes;

  bool IsBroken() const {
    return settings.failing_call > 0 && settings.fails_for_good &&
           usage.num_calls >= settings.failing_call;
  }
  bool CallFails() const {
    return IsBroken() || (settings.failing_call > 0 &&
                          usage.num_calls == settings.failing_call);
  }
  // Does what a device may have done in the meantime.
  void RunSomeWork();
  void RunAllWork();
  bool Take(size_t bytes);
  void GiveBack(size_t bytes);
};

State& GetState();

// Lets kernels and copies at device memory, which is out of reach otherwise.
class MemoryAccess {
 public:
  MemoryAccess();
  ~MemoryAccess();
};

// Does what a function of the runtime does, unless it has to fail.
template <class Run>
cudaError_t Call(const Run& run) {
  State& state = GetState();
  const std::lock_guard<std::recursive_mutex> lock(state.mutex);
  ++state.usage.num_calls;
  if (state.CallFails()) {
    return state.settings.failure;
  }
  state.RunSomeWork();
  return run(&state);
}

// The same for functions that give something back.
template <class Run>
cudaError_t CallToGiveBack(const Run& run) {
  State& state = GetState();
  const std::lock_guard<std::recursive_mutex> lock(state.mutex);
  run(&state);
  return cudaSuccess;
}

}  // namespace emulated_cuda

#endif  // TAPA_TESTS_MVS_EMULATED_CUDA_STATE_H_
