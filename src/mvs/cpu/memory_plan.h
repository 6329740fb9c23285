#ifndef TAPA_SRC_MVS_CPU_MEMORY_PLAN_H_
#define TAPA_SRC_MVS_CPU_MEMORY_PLAN_H_

#include <cstddef>

#include "src/mvs/options.h"
#include "src/mvs/problem.h"

namespace tapa {

// Bytes of memory that the CPU backend needs, its result included. For n source
// views of w x h pixels:
//
//   w h (16 + 1 + 4 n) for the estimate, the image, the costs and probabilities
//   w h ceil(n / 8)    for Estimate::consistent, with Options::filter or TAPA
//   2 w h n            for the source images
size_t CpuBackendMemory(const Options& options, const Problem& problem);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CPU_MEMORY_PLAN_H_
