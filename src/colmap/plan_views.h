#ifndef TAPA_SRC_COLMAP_PLAN_VIEWS_H_
#define TAPA_SRC_COLMAP_PLAN_VIEWS_H_

#include "src/colmap/stereo_plan.h"

namespace tapa {

// Chooses which of the plan's problems a run computes: those whose files are
// there, with the sources that are, and the helpers that they need. Throws
// Failure where something is missing that the options do not allow to leave
// out, or if nothing is left; warns of what is left out, and of views with
// fewer sources than the filter asks for.
void ChooseViews(const colmap::mvs::PatchMatchOptions& options,
                 StereoPlan* plan);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_PLAN_VIEWS_H_
