#ifndef TAPA_SRC_COLMAP_STEREO_PLAN_H_
#define TAPA_SRC_COLMAP_STEREO_PLAN_H_

#include <map>
#include <string>
#include <vector>

#include "mvs/patch_match.h"
#include "src/base/map_files.h"
#include "src/colmap/options_record.h"
#include "src/colmap/pass.h"
#include "src/colmap/priors.h"
#include "src/colmap/problem_config.h"
#include "src/colmap/run_part.h"
#include "src/colmap/views.h"
#include "src/colmap/views_record.h"
#include "src/colmap/workspace.h"

namespace tapa {

// What a pass at a level has to do.
struct PassPlan {
  Pass pass;
  // See src/mvs/levels.h.
  int level;
  // Those in force in it (PassOptions).
  colmap::mvs::PatchMatchOptions options;
  // Whether its estimation starts from the maps of the pass before.
  bool has_start = false;
  // Whether it lets views judge each other's drafts rather than estimate.
  bool takes_drafts = false;
  // For each of the plan's problems, whether its maps are there already, and
  // whether anything needs them.
  std::vector<bool> is_done;
  std::vector<bool> is_needed;
  // What its maps depend on. To be written down if there are no maps yet, of
  // whatever view: the record is about all maps beside it.
  OptionValues record;
  bool has_maps = false;
  // What the maps beside it are made from, with those that the pass computes.
  ViewsRecord views_record;
  // What it writes besides depth and normal maps.
  bool writes_graphs = false;
  bool writes_pictures = false;

  bool Computes(size_t problem) const {
    return is_needed[problem] && !is_done[problem];
  }
};

// What a run of dense stereo computes: the views that a workspace's
// configuration lists, without those that cannot be computed and without maps
// that are there already, so that a run that was stopped goes on where it was.
struct StereoPlan {
  WorkspaceLocation location;
  // All images of the model, at each level.
  std::vector<std::vector<SceneView>> views;
  // Indices into them: of the views whose maps are the result, then of helpers,
  // sources that are not among those and have no map. The geometric pass of the
  // others needs their photometric maps.
  std::vector<ViewIndices> problems;
  size_t num_results = 0;
  // By view: whether its maps are a result.
  std::vector<bool> is_result;
  // By view; others have none.
  std::map<int, FittedPrior> priors;
  // One after the other; the maps of the last one are the result.
  std::vector<PassPlan> passes;
  // What this program does of them.
  RunPart part;
  // Whether maps of coarse levels or drafts are there that this run cannot go
  // on with.
  bool drops_levels = false;

  bool IsHelper(size_t problem) const { return problem >= num_results; }
  // Whether a problem is this program's part; all are, but of a worker's.
  bool IsOwn(size_t problem) const;
  // Whether a pass draws what it does with a problem's view: it shows how the
  // result came about, so it does where that is computed.
  bool Draws(const PassPlan& pass, size_t problem) const;
  // Number of views whose result is there.
  int NumDone() const;
  // Of the largest view that is computed, at level 0.
  double MaxMegapixels() const;
  const SceneView& View(int view, int level) const {
    return views[level][view];
  }
  std::string MapPath(MapKind kind, int view, Pass pass, int level) const;
};

// Looks, before anything is computed or written, for whatever can be wrong with
// options, model, configuration and maps that are there. Prints what the user
// should know. Throws Failure.
StereoPlan MakeStereoPlan(const colmap::mvs::PatchMatchOptions& options,
                          const WorkspaceLocation& location);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_STEREO_PLAN_H_
