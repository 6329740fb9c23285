#include "src/colmap/plan_passes.h"

#include <algorithm>
#include <sstream>
#include <string>

#include "src/colmap/engine_options.h"
#include "util/misc.h"

namespace tapa {
namespace {

using colmap::ExistsPath;
using colmap::mvs::PatchMatchOptions;

// Views that this run does not compute count as well.
bool HasMaps(const StereoPlan& plan, Pass pass, int level) {
  for (int view = 0; view < static_cast<int>(plan.views[0].size()); ++view) {
    for (const MapKind kind : {MapKind::kDepth, MapKind::kNormal}) {
      if (ExistsPath(plan.MapPath(kind, view, pass, level))) {
        return true;
      }
    }
  }
  return false;
}

std::vector<Pass> PassesAt(int level, const PatchMatchOptions& options) {
  std::vector<Pass> passes = {Pass::kPhotometric};
  if (level == 0 && HasDrafts(options)) {
    passes.push_back(Pass::kDraft);
  }
  if (options.geom_consistency) {
    passes.push_back(Pass::kGeometric);
  }
  return passes;
}

OptionValues RecordOf(PatchMatchOptions options,
                      const std::vector<SceneView>& views) {
  // A limit that no photograph reaches is none.
  const bool is_limited =
      std::any_of(views.begin(), views.end(), [](const SceneView& view) {
        return view.width != view.photo_width ||
               view.height != view.photo_height;
      });
  if (!is_limited) {
    options.max_image_size = -1;
  }
  return OptionsOfMaps(options);
}

// What a record says of the passes before, whose maps may be gone later.
std::string DescribePass(const PassPlan& pass) {
  std::ostringstream text;
  text << "level " << pass.level << " " << PassName(pass.pass) << " "
       << pass.options.num_iterations << " from "
       << pass.options.first_perturbation;
  return text.str();
}

}  // namespace

std::vector<PassPlan> PlanPasses(const PatchMatchOptions& options,
                                 const StereoPlan& plan) {
  std::vector<PassPlan> passes;
  const int num_levels = static_cast<int>(plan.views.size());
  std::string passes_before;
  for (int level = num_levels - 1; level >= 0; --level) {
    for (const Pass pass : PassesAt(level, options)) {
      PassPlan to;
      to.pass = pass;
      to.level = level;
      to.options = PassOptions(options, pass, level, num_levels);
      to.has_start = !passes.empty();
      to.record = RecordOf(to.options, plan.views[0]);
      if (to.has_start) {
        to.record["passes_before"] = passes_before;
      }
      passes_before += (to.has_start ? ", " : "") + DescribePass(to);
      to.has_maps = HasMaps(plan, pass, level);
      to.takes_drafts =
          level == 0 && pass == Pass::kGeometric && HasDrafts(options);
      const bool filters = Filters(options, pass, level);
      to.writes_graphs = filters && options.write_consistency_graph;
      to.writes_pictures =
          filters && options.tapa.enabled && !options.tapa_debug.empty();
      passes.push_back(to);
    }
  }
  return passes;
}

}  // namespace tapa
