#include "src/colmap/stereo_plan.h"

#include <algorithm>
#include <iostream>
#include <optional>
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
    const std::string& image_path = plan_->views[view].image_path;
    if (!ExistsPath(image_path)) {
      return "its image " + image_path + " is missing";
    }
    const std::string map_path =
        plan_->MapPath(MapKind::kDepth, view, Pass::kPhotometric);
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

  const std::string& Name(int view) const { return plan_->views[view].name; }

  const PatchMatchOptions& options_;
  StereoPlan* const plan_;
  std::unordered_set<int> computed_;
  bool has_dropped_ = false;
};

void CheckDepthRanges(const PatchMatchOptions& options,
                      const StereoPlan& plan) {
  for (const ViewIndices& problem : plan.problems) {
    const SceneView& view = plan.views[problem.reference];
    if (options.depth_min < 0 && !(view.depth_min > 0)) {
      throw Failure("The sparse model has no points in view " + view.name +
                    " to take its range of depths from; set "
                    "--PatchMatchStereo.depth_min and depth_max");
    }
  }
}

// Views that this run does not compute count as well.
bool HasMaps(const StereoPlan& plan, Pass pass) {
  for (int view = 0; view < static_cast<int>(plan.views.size()); ++view) {
    for (const MapKind kind : {MapKind::kDepth, MapKind::kNormal}) {
      if (ExistsPath(plan.MapPath(kind, view, pass))) {
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

// The passes, without what the maps that are there have to be asked for.
std::vector<PassPlan> Passes(const PatchMatchOptions& options,
                             const StereoPlan& plan) {
  std::vector<PassPlan> passes;
  for (const Pass pass : {Pass::kPhotometric, Pass::kGeometric}) {
    if (pass > FinalPass(options)) {
      continue;
    }
    PassPlan to;
    to.pass = pass;
    to.options = PassOptions(options, pass);
    to.record = RecordOf(to.options, plan.views);
    if (!passes.empty()) {
      // It starts from the maps of the pass before, which may be gone later.
      for (const char* name : {"num_iterations", "window_step"}) {
        to.record[std::string("first_") + name] = passes.back().record.at(name);
      }
    }
    to.has_maps = HasMaps(plan, pass);
    // The pass before the final one does not filter.
    const bool is_final = pass == FinalPass(options);
    to.writes_graphs = is_final && options.write_consistency_graph;
    to.writes_pictures =
        is_final && options.tapa.enabled && !options.tapa_debug.empty();
    passes.push_back(to);
  }
  return passes;
}

// How a pass comes to values that nobody gave, if differences name such.
std::string PassLimits(const std::string& differences, bool is_final) {
  if (!is_final && differences.find("window_step") != std::string::npos) {
    return "; before a geometric pass window_step is at least "
           "first_window_step";
  }
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
      ReadOptionsRecord(plan.location.RecordPath(pass.pass));
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
bool HasMap(const StereoPlan& plan, MapKind kind, int view, Pass pass) {
  const std::string path = plan.MapPath(kind, view, pass);
  if (!ExistsPath(path)) {
    return false;
  }
  try {
    CheckMapFile(path, kind, plan.views[view].width, plan.views[view].height);
  } catch (const Failure& error) {
    throw Failure(std::string(error.what()) +
                  "; remove it to have it computed again, or take the "
                  "max_image_size that it was computed with");
  }
  return true;
}

// Whether all maps of a view are there. Throws Failure if one is damaged.
bool IsDone(const StereoPlan& plan, const PassPlan& pass, int view) {
  const bool has_depth = HasMap(plan, MapKind::kDepth, view, pass.pass);
  const bool has_normal = HasMap(plan, MapKind::kNormal, view, pass.pass);
  const bool has_graph =
      !pass.writes_graphs ||
      HasMap(plan, MapKind::kConsistencyGraph, view, pass.pass);
  return has_depth && has_normal && has_graph;
}

// Looks at the maps that are there already.
void CheckMaps(StereoPlan* plan) {
  const bool is_geometric = plan->passes.back().pass == Pass::kGeometric;
  for (const ViewIndices& problem : plan->problems) {
    for (PassPlan& pass : plan->passes) {
      pass.is_done.push_back(IsDone(*plan, pass, problem.reference));
    }
    for (const int source : problem.sources) {
      if (is_geometric) {
        HasMap(*plan, MapKind::kDepth, source, Pass::kPhotometric);
      }
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

std::string StereoPlan::MapPath(MapKind kind, int view, Pass pass) const {
  return location.MapPath(kind, views[view].name, pass);
}

StereoPlan MakeStereoPlan(const PatchMatchOptions& options,
                          const WorkspaceLocation& location) {
  CheckOptions(options);
  std::cout << "Reading workspace " << location.path << " ..." << std::endl;
  const colmap::mvs::Model model = ReadWorkspace(location);
  StereoPlan plan;
  plan.location = location;
  plan.views = SceneViews(model, options.max_image_size);
  plan.problems = ResolveProblems(ReadProblemConfig(location.ConfigPath()),
                                  model, options.min_triangulation_angle);
  MissingFiles::Drop(options, &plan);
  CheckDepthRanges(options, plan);
  plan.passes = Passes(options, plan);
  for (const PassPlan& pass : plan.passes) {
    if (pass.has_maps) {
      CheckRecord(plan, pass);
    }
  }
  CheckMaps(&plan);
  WarnOfMissingPictures(plan);
  std::cout << "Configuration has " << plan.problems.size() << " views."
            << std::endl;
  return plan;
}

}  // namespace tapa
