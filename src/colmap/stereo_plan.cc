#include "src/colmap/stereo_plan.h"

#include <algorithm>
#include <iostream>
#include <optional>
#include <sstream>
#include <unordered_set>

#include "src/base/failure.h"
#include "src/colmap/engine_options.h"
#include "src/colmap/progress.h"
#include "util/misc.h"

namespace tapa {
namespace {

using colmap::ExistsPath;
using colmap::mvs::PatchMatchOptions;

// Finds images and maps that are missing, and views that have no sources.
class MissingFiles {
 public:
  // Throws Failure if something is missing that the options do not allow to
  // leave out, or if nothing is left.
  static void Drop(const PatchMatchOptions& options, StereoPlan* plan) {
    // A view that is dropped makes no map for others.
    while (MissingFiles(options, plan).DropOnce()) {
    }
    if (plan->problems.empty()) {
      throw Failure("There is no view left that stereo can be computed for");
    }
  }

 private:
  MissingFiles(const PatchMatchOptions& options, StereoPlan* plan)
      : options_(options), plan_(plan) {
    for (const ViewIndices& problem : plan->problems) {
      computed_.insert(problem.reference);
    }
  }

  // Returns whether it has dropped anything.
  bool DropOnce() {
    std::vector<ViewIndices> kept;
    for (const ViewIndices& problem : plan_->problems) {
      std::string lack = LackOf(problem.reference);
      ViewIndices rest;
      rest.reference = problem.reference;
      if (lack.empty()) {
        rest.sources = UsableSources(problem);
        if (rest.sources.empty()) {
          lack =
              "it has no source images (none shares enough points with it, or "
              "none is named)";
        }
      }
      if (lack.empty()) {
        kept.push_back(rest);
      } else {
        Report("View " + Name(problem.reference) +
               " cannot be computed: " + lack);
      }
    }
    plan_->problems = kept;
    return has_dropped_;
  }

  std::vector<int> UsableSources(const ViewIndices& problem) {
    std::vector<int> usable;
    for (const int source : problem.sources) {
      const std::string lack = LackOf(source);
      if (lack.empty()) {
        usable.push_back(source);
      } else {
        Report("Source image " + Name(source) + " of " +
               Name(problem.reference) + " cannot be used: " + lack);
      }
    }
    return usable;
  }

  // What a view lacks to be used; empty: nothing.
  std::string LackOf(int view) const {
    const std::string& image_path = plan_->View(view, 0).image_path;
    if (!ExistsPath(image_path)) {
      return "its image " + image_path + " is missing";
    }
    const std::string map_path =
        plan_->MapPath(MapKind::kDepth, view, Pass::kPhotometric, 0);
    if (options_.geom_consistency && computed_.count(view) == 0 &&
        !ExistsPath(map_path)) {
      return "the map " + map_path +
             " is missing and the view is not in the list of views to compute";
    }
    return "";
  }

  void Report(const std::string& what) {
    if (!options_.allow_missing_files) {
      throw Failure(what +
                    "; to leave it out, set "
                    "--PatchMatchStereo.allow_missing_files 1");
    }
    PrintWarning(what + "; it is left out");
    has_dropped_ = true;
  }

  const std::string& Name(int view) const { return plan_->View(view, 0).name; }

  const PatchMatchOptions& options_;
  StereoPlan* const plan_;
  std::unordered_set<int> computed_;
  bool has_dropped_ = false;
};

void CheckDepthRanges(const PatchMatchOptions& options,
                      const StereoPlan& plan) {
  for (const ViewIndices& problem : plan.problems) {
    const SceneView& view = plan.View(problem.reference, 0);
    if (options.depth_min < 0 && !(view.depth_min > 0)) {
      throw Failure("The sparse model has no points in view " + view.name +
                    " to take its range of depths from; set "
                    "--PatchMatchStereo.depth_min and depth_max");
    }
  }
}

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

int LongestSide(const std::vector<SceneView>& views) {
  int longest = 0;
  for (const SceneView& view : views) {
    longest = std::max({longest, view.width, view.height});
  }
  return longest;
}

// The passes, without what the maps that are there have to be asked for.
std::vector<PassPlan> Passes(const PatchMatchOptions& options,
                             const StereoPlan& plan) {
  std::vector<PassPlan> passes;
  const int num_levels = static_cast<int>(plan.views.size());
  std::string passes_before;
  for (int level = num_levels - 1; level >= 0; --level) {
    for (const Pass pass : {Pass::kPhotometric, Pass::kGeometric}) {
      if (pass > FinalPass(options)) {
        continue;
      }
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
      // No pass before the final one filters.
      const bool is_final = level == 0 && pass == FinalPass(options);
      to.writes_graphs = is_final && options.write_consistency_graph;
      to.writes_pictures =
          is_final && options.tapa.enabled && !options.tapa_debug.empty();
      passes.push_back(to);
    }
  }
  return passes;
}

// How a pass comes to values that nobody gave, if differences name such.
std::string PassLimits(const std::string& differences, bool is_final) {
  if (is_final && differences.find("num_iterations") != std::string::npos) {
    return "; in the geometric pass num_iterations is at most "
           "num_geom_iterations";
  }
  return "";
}

// Compares the options that made the maps of a pass with those of this run.
void CheckRecord(const StereoPlan& plan, const PassPlan& pass) {
  const std::string maps = std::string("The ") + PassName(pass.pass) +
                           " maps in " + plan.location.StereoPath() +
                           " were made with ";
  const std::optional<OptionValues> recorded =
      ReadOptionsRecord(plan.location.RecordPath(pass.pass, pass.level));
  if (!recorded) {
    PrintWarning(maps +
                 "options that are not known (by another version of COLMAP?); "
                 "they are kept");
    return;
  }
  const std::string differences = DescribeDifferences(*recorded, pass.record);
  if (differences.empty()) {
    return;
  }
  const auto was_on = [&recorded](const char* name) {
    const auto found = recorded->find(name);
    return found != recorded->end() && found->second == "1";
  };
  const bool is_final = pass.pass == plan.passes.back().pass;
  const bool was_final =
      !is_final && (was_on("filter") || was_on("tapa_refinement"));
  const std::string files = std::string("*.") + PassName(pass.pass) + ".bin";
  throw Failure(
      maps + "other options (PatchMatchStereo: " + differences +
      (was_final ? "; before a geometric pass nothing is filtered" : "") +
      PassLimits(differences, is_final) +
      "); take the same options, name another workspace, or remove all " +
      files + (is_final ? "" : " and *.geometric.bin") +
      " there to have them computed again");
}

// Whether a map is there. Throws Failure if it is damaged.
bool HasMap(const StereoPlan& plan, MapKind kind, int view, Pass pass,
            int level) {
  const std::string path = plan.MapPath(kind, view, pass, level);
  if (!ExistsPath(path)) {
    return false;
  }
  try {
    const SceneView& size = plan.View(view, level);
    CheckMapFile(path, kind, size.width, size.height);
  } catch (const Failure& error) {
    throw Failure(std::string(error.what()) +
                  "; remove it to have it computed again, or take the "
                  "max_image_size that it was computed with");
  }
  return true;
}

// Whether all maps of a view are there. Throws Failure if one is damaged.
bool IsDone(const StereoPlan& plan, const PassPlan& pass, int view) {
  const auto has = [&](MapKind kind) {
    return HasMap(plan, kind, view, pass.pass, pass.level);
  };
  const bool has_depth = has(MapKind::kDepth);
  const bool has_normal = has(MapKind::kNormal);
  const bool has_graph = !pass.writes_graphs || has(MapKind::kConsistencyGraph);
  return has_depth && has_normal && has_graph;
}

// Looks at the maps that are there already.
void CheckMaps(StereoPlan* plan) {
  const bool is_geometric = plan->passes.back().pass == Pass::kGeometric;
  for (PassPlan& pass : plan->passes) {
    for (const ViewIndices& problem : plan->problems) {
      pass.is_done.push_back(pass.has_maps &&
                             IsDone(*plan, pass, problem.reference));
    }
  }
  for (const ViewIndices& problem : plan->problems) {
    for (const int source : problem.sources) {
      if (is_geometric) {
        HasMap(*plan, MapKind::kDepth, source, Pass::kPhotometric, 0);
      }
    }
  }
}

// Maps of full size are what the user gets. A coarser one is needed for a view
// that starts from it, and for one that has that view as a source in a
// geometric pass.
void FindNeeded(StereoPlan* plan) {
  const size_t num_problems = plan->problems.size();
  std::vector<int> problem_of(plan->views[0].size(), -1);
  for (size_t i = 0; i < num_problems; ++i) {
    problem_of[plan->problems[i].reference] = static_cast<int>(i);
  }
  for (PassPlan& pass : plan->passes) {
    pass.is_needed.assign(num_problems, pass.level == 0);
  }
  for (size_t p = plan->passes.size() - 1; p > 0; --p) {
    const PassPlan& pass = plan->passes[p];
    std::vector<bool>& before = plan->passes[p - 1].is_needed;
    for (size_t i = 0; i < num_problems; ++i) {
      if (!pass.Computes(i)) {
        continue;
      }
      before[i] = true;
      for (const int source : plan->problems[i].sources) {
        if (pass.pass == Pass::kGeometric && problem_of[source] >= 0) {
          before[problem_of[source]] = true;
        }
      }
    }
  }
}

// Whether the maps of a coarse level can be gone on with: another run, with
// other options or photographs, may have left them when it was stopped.
bool IsUsable(const StereoPlan& plan, const PassPlan& pass) {
  try {
    const std::optional<OptionValues> recorded =
        ReadOptionsRecord(plan.location.RecordPath(pass.pass, pass.level));
    if (!recorded || *recorded != pass.record) {
      return false;
    }
    for (const ViewIndices& problem : plan.problems) {
      IsDone(plan, pass, problem.reference);
    }
    return true;
  } catch (const Failure&) {
    return false;
  }
}

// Compares the maps that are there with what this run would make. Those of
// coarse levels are nobody's result: all go if one does not fit.
void CheckRecords(StereoPlan* plan) {
  for (const PassPlan& pass : plan->passes) {
    if (pass.has_maps && pass.level == 0) {
      CheckRecord(*plan, pass);
    } else if (pass.has_maps && !IsUsable(*plan, pass)) {
      plan->drops_levels = true;
    }
  }
  if (plan->drops_levels) {
    for (PassPlan& pass : plan->passes) {
      pass.has_maps = pass.has_maps && pass.level == 0;
    }
  }
}

// Pictures show a computation, not its maps.
void WarnOfMissingPictures(const StereoPlan& plan) {
  const PassPlan& pass = plan.passes.back();
  if (pass.writes_pictures && pass.NumDone() > 0) {
    PrintWarning(std::to_string(pass.NumDone()) + " of " +
                 std::to_string(plan.problems.size()) +
                 " views have their maps already, so that this run draws no "
                 "pictures of them; to get some, remove their *." +
                 PassName(pass.pass) + ".bin");
  }
}

}  // namespace

int PassPlan::NumDone() const {
  return static_cast<int>(std::count(is_done.begin(), is_done.end(), true));
}

std::string StereoPlan::MapPath(MapKind kind, int view, Pass pass,
                                int level) const {
  return location.MapPath(kind, View(view, level).name, pass, level);
}

StereoPlan MakeStereoPlan(const PatchMatchOptions& options,
                          const WorkspaceLocation& location) {
  CheckOptions(options);
  std::cout << "Reading workspace " << location.path << " ..." << std::endl;
  const colmap::mvs::Model model = ReadWorkspace(location);
  StereoPlan plan;
  plan.location = location;
  plan.views.push_back(SceneViews(model, options.max_image_size));
  const int num_levels = NumLevels(options, LongestSide(plan.views[0]));
  for (int level = 1; level < num_levels; ++level) {
    plan.views.push_back(SceneViews(model, options.max_image_size, level));
  }
  plan.problems = ResolveProblems(ReadProblemConfig(location.ConfigPath()),
                                  model, options.min_triangulation_angle);
  MissingFiles::Drop(options, &plan);
  CheckDepthRanges(options, plan);
  plan.passes = Passes(options, plan);
  CheckRecords(&plan);
  CheckMaps(&plan);
  FindNeeded(&plan);
  WarnOfMissingPictures(plan);
  std::cout << "Configuration has " << plan.problems.size() << " views."
            << std::endl;
  return plan;
}

}  // namespace tapa
