// Device memory, arrays and copies.

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "tests/mvs/emulated_cuda/cuda_runtime.h"
#include "tests/mvs/emulated_cuda/state.h"

namespace emulated_cuda {
namespace {

// What was never written: not a number, and no zeros.
constexpr int kUnset = 0xFF;

// Memory lies at the end of its pages, behind which there is nothing.
struct Pages {
  explicit Pages(size_t size) {
    const size_t page = sysconf(_SC_PAGESIZE);
    bytes = (size + page - 1) / page * page;
    // Aligned for all that is read at once.
    offset = (bytes - size) & ~size_t{15};
  }
  size_t bytes;
  size_t offset;
};

void Protect(int protection) {
  for (const auto& [memory, size] : GetState().memory) {
    const Pages pages(size);
    mprotect(static_cast<char*>(memory) - pages.offset, pages.bytes,
             protection);
  }
}

}  // namespace

MemoryAccess::MemoryAccess() { Protect(PROT_READ | PROT_WRITE); }
MemoryAccess::~MemoryAccess() { Protect(PROT_NONE); }

}  // namespace emulated_cuda

using emulated_cuda::Call;
using emulated_cuda::CallToGiveBack;
using emulated_cuda::MemoryAccess;
using emulated_cuda::Pages;
using emulated_cuda::State;

cudaError_t cudaMemGetInfo(size_t* free_bytes, size_t* total_bytes) {
  return Call([&](State* state) {
    *total_bytes = state->settings.memory_bytes;
    *free_bytes = *total_bytes - state->usage.bytes;
    return cudaSuccess;
  });
}

cudaError_t cudaMalloc(void** memory, size_t bytes) {
  return Call([&](State* state) {
    if (!state->Take(bytes)) {
      return cudaErrorMemoryAllocation;
    }
    const Pages pages(bytes);
    // One page more, which nobody may touch.
    const size_t guard = sysconf(_SC_PAGESIZE);
    char* const begin =
        static_cast<char*>(mmap(nullptr, pages.bytes + guard, PROT_NONE,
                                MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
    *memory = begin + pages.offset;
    state->memory[*memory] = bytes;
    const MemoryAccess access;
    std::memset(*memory, emulated_cuda::kUnset, bytes);
    return cudaSuccess;
  });
}

cudaError_t cudaFree(void* memory) {
  return CallToGiveBack([&](State* state) {
    const auto found = state->memory.find(memory);
    if (found == state->memory.end()) {
      return;
    }
    state->RunAllWork();
    const Pages pages(found->second);
    munmap(static_cast<char*>(memory) - pages.offset,
           pages.bytes + sysconf(_SC_PAGESIZE));
    state->GiveBack(found->second);
    state->memory.erase(found);
  });
}

cudaError_t cudaMemcpy(void* to, const void* from, size_t bytes,
                       cudaMemcpyKind kind) {
  return Call([&](State* state) {
    if (kind == cudaMemcpyDeviceToHost) {
      state->default_stream.RunAll();
      const MemoryAccess access;
      std::memcpy(to, from, bytes);
      return cudaSuccess;
    }
    // Read at once, but it arrives later.
    const char* const begin = static_cast<const char*>(from);
    state->default_stream.Add(
        [to, data = std::vector<char>(begin, begin + bytes)] {
          const MemoryAccess access;
          std::copy(data.begin(), data.end(), static_cast<char*>(to));
        });
    return cudaSuccess;
  });
}

cudaError_t cudaMalloc3DArray(cudaArray_t* array,
                              const cudaChannelFormatDesc* format,
                              cudaExtent extent, unsigned flags) {
  return Call([&](State* state) {
    const bool layered = flags == cudaArrayLayered;
    if (extent.width == 0 || extent.height == 0 ||
        layered != (extent.depth > 0) || format->y + format->z + format->w) {
      return cudaErrorInvalidValue;
    }
    cudaArray made;
    made.bytes_per_element = format->x / 8;
    made.kind = format->f;
    made.width = extent.width;
    made.height = extent.height;
    made.num_layers = extent.depth;
    const size_t bytes = made.bytes_per_element * made.width * made.height *
                         (layered ? made.num_layers : 1);
    if (!state->Take(bytes)) {
      return cudaErrorMemoryAllocation;
    }
    made.bytes.assign(bytes, emulated_cuda::kUnset);
    *array = new cudaArray(std::move(made));
    return cudaSuccess;
  });
}

cudaError_t cudaFreeArray(cudaArray_t array) {
  return CallToGiveBack([&](State* state) {
    if (array != nullptr) {
      state->RunAllWork();
      state->GiveBack(array->bytes.size());
      delete array;
    }
  });
}

cudaError_t cudaMemcpy3D(const cudaMemcpy3DParms* copy) {
  return Call([&](State* state) {
    const cudaExtent& extent = copy->extent;
    const cudaPos& to = copy->dstPos;
    cudaArray* const array = copy->dstArray;
    const size_t num_layers = array->num_layers > 0 ? array->num_layers : 1;
    const size_t row_bytes = extent.width * array->bytes_per_element;
    if (copy->kind != cudaMemcpyHostToDevice || extent.depth != 1 ||
        to.x + extent.width > array->width ||
        to.y + extent.height > array->height || to.z >= num_layers ||
        copy->srcPtr.pitch < row_bytes || copy->srcPos.x != 0 ||
        copy->srcPos.y != 0 || copy->srcPos.z != 0) {
      return cudaErrorInvalidValue;
    }
    std::vector<char> data;
    for (size_t row = 0; row < extent.height; ++row) {
      const char* const from =
          static_cast<const char*>(copy->srcPtr.ptr) + row * copy->srcPtr.pitch;
      data.insert(data.end(), from, from + row_bytes);
    }
    state->default_stream.Add([=, data = std::move(data)] {
      for (size_t row = 0; row < extent.height; ++row) {
        const size_t element =
            (to.z * array->height + to.y + row) * array->width + to.x;
        std::memcpy(array->bytes.data() + element * array->bytes_per_element,
                    data.data() + row * row_bytes, row_bytes);
      }
    });
    return cudaSuccess;
  });
}
