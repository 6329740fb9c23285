#ifndef TAPA_SRC_COLMAP_EXISTING_MAPS_H_
#define TAPA_SRC_COLMAP_EXISTING_MAPS_H_

#include <cstddef>
#include <vector>

#include "src/colmap/stereo_plan.h"

namespace tapa {

// What a run finds in its workspace: maps of an earlier one that it goes on
// with, if they are what it would make itself.

// What the maps of problems, by their indices, are made from. views: at the
// size of their photographs.
ViewsRecord CurrentInputs(const StereoPlan& plan,
                          const std::vector<size_t>& problems,
                          const std::vector<SceneView>& views,
                          const colmap::mvs::PatchMatchOptions& options);

// Compares the maps that are there with what this run would make, from
// `inputs`. Those of coarse levels and drafts are nobody's result: all go if
// one does not fit. Throws Failure if those of full size do not.
void CheckRecords(const ViewsRecord& inputs, StereoPlan* plan);

// Looks at the maps that are there already (PassPlan::is_done). Throws Failure
// if one is damaged.
void CheckMaps(StereoPlan* plan);

// Notes what the maps that are there and those to be computed are made from.
void UpdateViewsRecords(const ViewsRecord& inputs, StereoPlan* plan);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_EXISTING_MAPS_H_
