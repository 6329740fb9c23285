#ifndef TAPA_BENCHMARKS_NAIVE_CORRELATION_H_
#define TAPA_BENCHMARKS_NAIVE_CORRELATION_H_

#include "src/base/map.h"
#include "src/mvs/cpu/window.h"
#include "src/mvs/sweep/source_cameras.h"

namespace tapa {

// What the SIMD correlation is measured against: one sample after the other in
// single precision, with the same prepared weights.
float NaiveCorrelationCost(const Window& window, const Patch& patch,
                           const Map<uint8_t>& source, const Warp& warp);

}  // namespace tapa

#endif  // TAPA_BENCHMARKS_NAIVE_CORRELATION_H_
