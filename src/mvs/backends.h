#ifndef TAPA_SRC_MVS_BACKENDS_H_
#define TAPA_SRC_MVS_BACKENDS_H_

#include <memory>

#include "src/mvs/backend.h"
#include "src/mvs/options.h"
#include "src/mvs/problem.h"

namespace tapa {

// The backends there are.

// options.num_threads threads of the CPU, with its widest SIMD instructions.
std::unique_ptr<Backend> MakeCpuBackend(const Options& options,
                                        const Problem& problem);

// GPU options.device. Throws DeviceError, as all functions of this backend do;
// the problem can be computed by another one then.
std::unique_ptr<Backend> MakeCudaBackend(const Options& options,
                                         const Problem& problem);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_BACKENDS_H_
