#ifndef TAPA_SRC_COLMAP_PLAN_PASSES_H_
#define TAPA_SRC_COLMAP_PLAN_PASSES_H_

#include <vector>

#include "src/colmap/stereo_plan.h"

namespace tapa {

// The passes of a run at the plan's levels, one after the other, without what
// the maps that are there have to be asked for (PassPlan::is_done, is_needed
// and views_record).
std::vector<PassPlan> PlanPasses(const colmap::mvs::PatchMatchOptions& options,
                                 const StereoPlan& plan);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_PLAN_PASSES_H_
