// Streams, events and launches.

#include <algorithm>
#include <exception>
#include <numeric>
#include <utility>
#include <vector>

#include "tests/mvs/emulated_cuda/cuda_runtime.h"
#include "tests/mvs/emulated_cuda/state.h"

void CUstream_st::Add(std::function<void()> item) {
  work.push_back(std::move(item));
  ++num_added;
}

void CUstream_st::RunOne() {
  if (!work.empty()) {
    const std::function<void()> item = std::move(work.front());
    work.pop_front();
    ++num_done;
    item();
  }
}

void CUstream_st::RunUntil(uint64_t num) {
  while (num_done < num) {
    try {
      RunOne();
    } catch (...) {
      // Destructors that are called for an error must not throw another one.
      if (std::uncaught_exceptions() == 0) {
        throw;
      }
    }
  }
}

namespace emulated_cuda {
namespace {

constexpr size_t kUsualSharedBytes = 48 * 1024;
constexpr unsigned kMaxThreads = 1024;

void RunGrid(unsigned num_blocks, unsigned num_threads, size_t shared_bytes,
             uint32_t turns, const std::function<void()>& thread) {
  const MemoryAccess access;
  std::vector<unsigned> blocks(num_blocks);
  std::iota(blocks.begin(), blocks.end(), 0);
  if (turns != 0) {
    std::shuffle(blocks.begin(), blocks.end(), std::mt19937(turns));
  }
  for (const unsigned block : blocks) {
    RunBlock(block, num_threads, shared_bytes, turns, thread);
  }
}

}  // namespace

cudaError_t Launch(const cudaLaunchConfig_t& config, const void* kernel,
                   std::function<void()> thread) {
  return Call([&](State* state) {
    const unsigned num_blocks = config.gridDim.x;
    const unsigned num_threads = config.blockDim.x;
    // The emulator knows no more than the backend uses: one dimension, no
    // attributes, whole warps.
    if (num_blocks == 0 || num_threads == 0 || num_threads > kMaxThreads ||
        num_threads % kWarpSize != 0 || config.gridDim.y != 1 ||
        config.gridDim.z != 1 || config.blockDim.y != 1 ||
        config.blockDim.z != 1 || config.numAttrs != 0) {
      return cudaErrorInvalidConfiguration;
    }
    const auto limit = state->max_shared_bytes.find(kernel);
    if (config.dynamicSmemBytes > (limit == state->max_shared_bytes.end()
                                       ? kUsualSharedBytes
                                       : limit->second)) {
      return cudaErrorInvalidValue;
    }
    if (state->streams.count(config.stream) == 0) {
      return cudaErrorInvalidResourceHandle;
    }
    config.stream->Add([=, thread = std::move(thread),
                        shared_bytes = config.dynamicSmemBytes,
                        turns = state->settings.turns] {
      RunGrid(num_blocks, num_threads, shared_bytes, turns, thread);
    });
    return cudaSuccess;
  });
}

}  // namespace emulated_cuda

using emulated_cuda::Call;
using emulated_cuda::CallToGiveBack;
using emulated_cuda::State;

cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned flags) {
  return Call([&](State* state) {
    // Others would wait for copies.
    if (flags != cudaStreamNonBlocking) {
      return cudaErrorInvalidValue;
    }
    state->Take(0);
    *stream = new CUstream_st;
    state->streams.insert(*stream);
    return cudaSuccess;
  });
}

cudaError_t cudaStreamDestroy(cudaStream_t stream) {
  return CallToGiveBack([&](State* state) {
    if (state->streams.erase(stream) > 0) {
      if (!state->IsBroken()) {
        stream->RunAll();
      }
      state->GiveBack(0);
      delete stream;
    }
  });
}

cudaError_t cudaStreamSynchronize(cudaStream_t stream) {
  return Call([&](State* state) {
    if (stream == nullptr) {
      state->default_stream.RunAll();
    } else if (state->streams.count(stream) == 0) {
      return cudaErrorInvalidResourceHandle;
    } else {
      stream->RunAll();
    }
    return cudaSuccess;
  });
}

cudaError_t cudaEventCreateWithFlags(cudaEvent_t* event, unsigned flags) {
  return Call([&](State* state) {
    if (flags & ~(cudaEventBlockingSync | cudaEventDisableTiming)) {
      return cudaErrorInvalidValue;
    }
    state->Take(0);
    *event = new CUevent_st;
    return cudaSuccess;
  });
}

cudaError_t cudaEventDestroy(cudaEvent_t event) {
  return CallToGiveBack([&](State* state) {
    if (event != nullptr) {
      state->GiveBack(0);
      delete event;
    }
  });
}

cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream) {
  return Call([&](State* state) {
    if (state->streams.count(stream) == 0) {
      return cudaErrorInvalidResourceHandle;
    }
    *event = {stream, stream->num_added};
    return cudaSuccess;
  });
}

cudaError_t cudaEventSynchronize(cudaEvent_t event) {
  return Call([&](State* state) {
    if (state->streams.count(event->stream) > 0) {
      event->stream->RunUntil(event->num_before);
    }
    return cudaSuccess;
  });
}

cudaError_t cudaFuncSetAttribute(const void* kernel, cudaFuncAttribute,
                                 int value) {
  return Call([&](State* state) {
    if (value < 0 || value > int{emulated_cuda::kMaxSharedBytes}) {
      return cudaErrorInvalidValue;
    }
    state->max_shared_bytes[kernel] = value;
    return cudaSuccess;
  });
}

cudaError_t cudaFuncGetAttributes(cudaFuncAttributes* attributes, const void*) {
  return Call([&](State*) {
    *attributes = {};
    return cudaSuccess;
  });
}

cudaError_t cudaOccupancyMaxActiveBlocksPerMultiprocessor(int* num_blocks,
                                                          const void*, int,
                                                          size_t) {
  return Call([&](State*) {
    *num_blocks = 1;
    return cudaSuccess;
  });
}
