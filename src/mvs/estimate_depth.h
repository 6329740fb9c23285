#ifndef TAPA_SRC_MVS_ESTIMATE_DEPTH_H_
#define TAPA_SRC_MVS_ESTIMATE_DEPTH_H_

#include <cstddef>
#include <optional>

#include "src/mvs/control.h"
#include "src/mvs/options.h"
#include "src/mvs/problem.h"

namespace tapa {

// Estimates depth and normal of every pixel of the reference view. Returns
// nothing if control.stopped() said so. Throws std::invalid_argument for
// options or a problem that make no sense, and DeviceError (device_error.h) if
// a GPU fails, which the CPU does not. The result depends neither on the number
// of threads nor on what was estimated before. Takes the problem by value: move
// it in where its maps are large.
std::optional<Estimate> EstimateDepth(const Options& options, Problem problem,
                                      const Control& control = Control());

// Bytes of memory that EstimateDepth needs besides the images and depth maps of
// the views: for w x h pixels what the CPU backend takes (cpu/memory_plan.h),
// 37 w h for TAPA, w h for a mask, and 8 w h and the prior itself for a prior.
// For n source views the views themselves need w h (1 + n) and, in the
// geometric pass, 4 w h n.
size_t EstimateDepthMemory(const Options& options, const Problem& problem);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_ESTIMATE_DEPTH_H_
