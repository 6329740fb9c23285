#ifndef TAPA_SRC_MVS_CPU_ALIGNED_H_
#define TAPA_SRC_MVS_CPU_ALIGNED_H_

#include <hwy/aligned_allocator.h>

#include <cstddef>
#include <cstring>
#include <new>

namespace tapa {

// Array that starts on a SIMD vector's boundary, filled with zeros; T is a
// number. Throws std::bad_alloc.
template <typename T>
hwy::AlignedFreeUniquePtr<T[]> MakeAligned(size_t count) {
  auto array = hwy::AllocateAligned<T>(count);
  if (!array) {
    throw std::bad_alloc();
  }
  std::memset(array.get(), 0, count * sizeof(T));
  return array;
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CPU_ALIGNED_H_
