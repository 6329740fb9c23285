#ifndef TAPA_SRC_MVS_CPU_ALIGNED_H_
#define TAPA_SRC_MVS_CPU_ALIGNED_H_

#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <cstddef>

namespace tapa {

// Array that starts on a SIMD vector's boundary, filled with zeros.
template <typename T>
hwy::AlignedFreeUniquePtr<T[]> MakeAligned(size_t count) {
  auto array = hwy::AllocateAligned<T>(count);
  std::fill_n(array.get(), count, T());
  return array;
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CPU_ALIGNED_H_
