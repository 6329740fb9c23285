#ifndef TAPA_SRC_BASE_UNINITIALIZED_VECTOR_H_
#define TAPA_SRC_BASE_UNINITIALIZED_VECTOR_H_

#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace tapa {

// Leaves numbers as they are in memory instead of setting them to zero, which
// takes seconds for the gigabytes of a large problem.
template <typename T>
struct UninitializedAllocator : std::allocator<T> {
  template <typename U>
  struct rebind {
    using other = UninitializedAllocator<U>;
  };

  template <typename U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template <typename U, typename... Args>
  void construct(U* place, Args&&... args) {
    ::new (static_cast<void*>(place)) U(std::forward<Args>(args)...);
  }
};

// A vector of numbers whose constructor and resize() do not set them.
template <typename T>
using UninitializedVector = std::vector<T, UninitializedAllocator<T>>;

}  // namespace tapa

#endif  // TAPA_SRC_BASE_UNINITIALIZED_VECTOR_H_
