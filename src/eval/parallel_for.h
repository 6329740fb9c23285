#ifndef TAPA_SRC_EVAL_PARALLEL_FOR_H_
#define TAPA_SRC_EVAL_PARALLEL_FOR_H_

#include <algorithm>
#include <cstddef>

#include "src/base/parallel.h"

namespace tapa {

// Calls run(thread, i) once for every i in [0, count). Each thread takes blocks
// of `block_size` neighbouring indices.
template <typename Run>
void ParallelFor(size_t count, size_t block_size, ThreadTeam* team,
                 const Run& run) {
  const size_t num_blocks = (count + block_size - 1) / block_size;
  team->For(
      static_cast<int>(num_blocks), 1,
      [&](int thread, int begin, int end, const ContinueCheck&) {
        const size_t last = std::min(count, end * block_size);
        for (size_t i = begin * block_size; i < last; ++i) run(thread, i);
      },
      [](double) { return true; });
}

}  // namespace tapa

#endif  // TAPA_SRC_EVAL_PARALLEL_FOR_H_
