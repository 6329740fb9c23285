#ifndef TAPA_SRC_COLMAP_STEREO_PLAN_H_
#define TAPA_SRC_COLMAP_STEREO_PLAN_H_

#include <string>
#include <vector>

#include "mvs/patch_match.h"
#include "src/base/map_files.h"
#include "src/colmap/options_record.h"
#include "src/colmap/pass.h"
#include "src/colmap/problem_config.h"
#include "src/colmap/views.h"
#include "src/colmap/workspace.h"

namespace tapa {

// What a pass has to do.
struct PassPlan {
  Pass pass;
  // Those in force in it (PassOptions).
  colmap::mvs::PatchMatchOptions options;
  // For each of the plan's problems, whether its maps are there already.
  std::vector<bool> is_done;
  // What its maps depend on. To be written down if there are no maps yet, of
  // whatever view: the record is about all maps beside it.
  OptionValues record;
  bool has_maps = false;
  // What it writes besides depth and normal maps.
  bool writes_graphs = false;
  bool writes_pictures = false;

  int NumDone() const;
};

// What a run of dense stereo computes: the views that a workspace's
// configuration lists, without those that cannot be computed and without maps
// that are there already, so that a run that was stopped goes on where it was.
struct StereoPlan {
  WorkspaceLocation location;
  // All images of the model.
  std::vector<SceneView> views;
  // Indices into them.
  std::vector<ViewIndices> problems;
  // One after the other; the maps of the last one are the result.
  std::vector<PassPlan> passes;

  std::string MapPath(MapKind kind, int view, Pass pass) const;
};

// Looks, before anything is computed or written, for whatever can be wrong with
// options, model, configuration and maps that are there. Prints what the user
// should know. Throws Failure.
StereoPlan MakeStereoPlan(const colmap::mvs::PatchMatchOptions& options,
                          const WorkspaceLocation& location);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_STEREO_PLAN_H_
