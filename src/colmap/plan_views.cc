#include "src/colmap/plan_views.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <string>

#include "src/base/failure.h"
#include "src/colmap/progress.h"
#include "util/misc.h"

namespace tapa {
namespace {

using colmap::ExistsPath;
using colmap::mvs::PatchMatchOptions;

// Finds images that are missing, and views that have no sources.
class MissingFiles {
 public:
  // Throws Failure if something is missing that the options do not allow to
  // leave out, or if nothing is left.
  static void Drop(const PatchMatchOptions& options, StereoPlan* plan) {
    MissingFiles(options, plan).Drop();
    if (plan->problems.empty()) {
      throw Failure("There is no view left that stereo can be computed for");
    }
  }

 private:
  MissingFiles(const PatchMatchOptions& options, StereoPlan* plan)
      : options_(options), plan_(plan) {}

  void Drop() {
    std::vector<ViewIndices> kept;
    for (const ViewIndices& problem : plan_->problems) {
      std::string lack = LackOf(problem.reference);
      ViewIndices rest;
      rest.reference = problem.reference;
      if (lack.empty()) {
        rest.sources = UsableSources(problem);
        if (rest.sources.empty()) {
          lack =
              "it has no source images (none shares enough points with it, "
              "none is named, or none is there)";
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
    return "";
  }

  void Report(const std::string& what) {
    if (!options_.allow_missing_files) {
      throw Failure(what +
                    "; to leave it out, set "
                    "--PatchMatchStereo.allow_missing_files 1");
    }
    PrintWarning(what + "; it is left out");
  }

  const std::string& Name(int view) const { return plan_->View(view, 0).name; }

  const PatchMatchOptions& options_;
  StereoPlan* const plan_;
};

// The geometric pass of a view needs maps of its sources. Those that are not
// listed and have none are computed with the views that they are sources of,
// and with the other sources of these.
void AddHelpers(const PatchMatchOptions& options, StereoPlan* plan) {
  plan->num_results = plan->problems.size();
  plan->is_result.assign(plan->views[0].size(), false);
  for (const ViewIndices& problem : plan->problems) {
    plan->is_result[problem.reference] = true;
  }
  if (!options.geom_consistency) {
    return;
  }
  std::set<int> listed;
  size_t max_num_sources = 0;
  for (const ViewIndices& problem : plan->problems) {
    listed.insert(problem.reference);
    max_num_sources = std::max(max_num_sources, problem.sources.size());
  }
  std::map<int, std::vector<int>> helpers;
  for (const ViewIndices& problem : plan->problems) {
    for (const int source : problem.sources) {
      if (listed.count(source) == 0 &&
          !ExistsPath(
              plan->MapPath(MapKind::kDepth, source, Pass::kPhotometric, 0))) {
        std::vector<int>& around = helpers[source];
        around.push_back(problem.reference);
        around.insert(around.end(), problem.sources.begin(),
                      problem.sources.end());
      }
    }
  }
  for (const auto& [helper, around] : helpers) {
    ViewIndices problem;
    problem.reference = helper;
    std::set<int> used = {helper};
    for (const int view : around) {
      if (problem.sources.size() < max_num_sources &&
          used.insert(view).second) {
        problem.sources.push_back(view);
      }
    }
    plan->problems.push_back(problem);
  }
}

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

// A filter that asks for more views than there are makes do with all of them.
void WarnOfFilter(const PatchMatchOptions& options, const StereoPlan& plan) {
  const auto num_needed =
      static_cast<size_t>(std::max(options.filter_min_num_consistent, 0));
  std::vector<std::string> names;
  for (size_t i = 0; i < plan.num_results; ++i) {
    if (plan.problems[i].sources.size() < num_needed) {
      names.push_back(plan.View(plan.problems[i].reference, 0).name);
    }
  }
  if (options.filter && !names.empty()) {
    PrintWarning(std::to_string(names.size()) + " of " +
                 std::to_string(plan.num_results) + " views, such as " +
                 names[0] +
                 ", have fewer source images than "
                 "filter_min_num_consistent (" +
                 std::to_string(options.filter_min_num_consistent) +
                 "), so that fewer have to agree on them; to fuse them with "
                 "--StereoFusion.agreement 0 lower "
                 "--StereoFusion.min_num_pixels to their number");
  }
}

}  // namespace

void ChooseViews(const PatchMatchOptions& options, StereoPlan* plan) {
  MissingFiles::Drop(options, plan);
  AddHelpers(options, plan);
  CheckDepthRanges(options, *plan);
  WarnOfFilter(options, *plan);
}

}  // namespace tapa
