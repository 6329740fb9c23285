#include "src/colmap/stereo_plan.h"

#include <algorithm>
#include <iostream>
#include <map>
#include <numeric>
#include <set>
#include <string>

#include "src/colmap/engine_options.h"
#include "src/colmap/existing_maps.h"
#include "src/colmap/masks.h"
#include "src/colmap/plan_passes.h"
#include "src/colmap/plan_views.h"
#include "src/colmap/progress.h"
#include "src/colmap/worker_checks.h"

namespace tapa {
namespace {

using colmap::mvs::PatchMatchOptions;

int LongestSide(const std::vector<SceneView>& views) {
  int longest = 0;
  for (const SceneView& view : views) {
    longest = std::max({longest, view.width, view.height});
  }
  return longest;
}

std::vector<int> ViewsToCompute(const StereoPlan& plan) {
  std::vector<int> views;
  for (size_t i = 0; i < plan.problems.size(); ++i) {
    if (plan.IsOwn(i)) {
      views.push_back(plan.problems[i].reference);
    }
  }
  return views;
}

std::map<int, FittedPrior> PriorsOf(const PatchMatchOptions& options,
                                    const colmap::mvs::Model& model,
                                    const StereoPlan& plan) {
  std::vector<int> views = ViewsToCompute(plan);
  if (plan.part.IsWorker()) {
    // That some view of the run has one was seen when it was prepared.
    const auto has_none = [&](int view) {
      return PriorPath(options.prior_path, plan.View(view, 0).name).empty();
    };
    views.erase(std::remove_if(views.begin(), views.end(), has_none),
                views.end());
    if (views.empty()) {
      return {};
    }
  }
  return FitPriors(options.prior_path, model, plan.views[0], views);
}

// Maps of full size are what the user gets. A coarser one, or a draft, is
// needed for a view that starts from it, and for one that has that view as a
// source in a geometric pass.
void FindNeeded(StereoPlan* plan) {
  const size_t num_problems = plan->problems.size();
  std::vector<int> problem_of(plan->views[0].size(), -1);
  for (size_t i = 0; i < num_problems; ++i) {
    problem_of[plan->problems[i].reference] = static_cast<int>(i);
  }
  for (PassPlan& pass : plan->passes) {
    for (size_t i = 0; i < num_problems; ++i) {
      pass.is_needed.push_back(IsResult(pass.pass, pass.level) &&
                               !plan->IsHelper(i));
    }
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
        // Helpers have no drafts.
        const int other = problem_of[source];
        if (pass.pass != Pass::kPhotometric && other >= 0 &&
            !(pass.takes_drafts && plan->IsHelper(other))) {
          before[other] = true;
        }
      }
    }
  }
}

// Pictures show a computation, not its maps.
void WarnOfMissingPictures(const StereoPlan& plan) {
  const PassPlan& pass = plan.passes.back();
  if (pass.writes_pictures && plan.NumDone() > 0) {
    PrintWarning(std::to_string(plan.NumDone()) + " of " +
                 std::to_string(plan.num_results) +
                 " views have their maps already, so that this run draws no "
                 "pictures of them; to get some, remove their *." +
                 PassName(pass.pass) + ".bin");
  }
}

// Leaves to a worker its share of its pass.
void KeepShare(StereoPlan* plan) {
  const size_t own_pass = plan->part.PassIndex(plan->passes.size());
  for (size_t p = 0; p < plan->passes.size(); ++p) {
    std::vector<bool>& is_needed = plan->passes[p].is_needed;
    for (size_t i = 0; i < is_needed.size(); ++i) {
      is_needed[i] = is_needed[i] && p == own_pass && plan->IsOwn(i);
    }
  }
}

std::string Describe(const PassPlan& pass) {
  return "level " + std::to_string(pass.level) + " " + PassName(pass.pass);
}

// What a worker computes, of which it looks at nothing that others do.
void PlanShare(const PatchMatchOptions& options,
               const std::vector<SceneView>& full_size, StereoPlan* plan) {
  const size_t p = plan->part.PassIndex(plan->passes.size());
  CheckMaps(plan);
  FindNeeded(plan);
  KeepShare(plan);
  const PassPlan& pass = plan->passes[p];
  std::vector<size_t> computed;
  for (size_t i = 0; i < plan->problems.size(); ++i) {
    if (pass.Computes(i)) {
      computed.push_back(i);
    }
  }
  if (!computed.empty()) {
    CheckPreparation(*plan, pass,
                     CurrentInputs(*plan, computed, full_size, options));
    if (p > 0) {
      CheckStepBefore(*plan, pass, plan->passes[p - 1]);
    }
  }
  std::cout << "Share " << options.share << " of step " << options.step << ", "
            << Describe(pass) << ", has " << computed.size()
            << " views to compute." << std::endl;
}

// evaluation/cluster reads these lines.
void PrintSteps(const StereoPlan& plan) {
  for (size_t p = 0; p < plan.passes.size(); ++p) {
    size_t num_views = 0;
    for (size_t i = 0; i < plan.problems.size(); ++i) {
      num_views += plan.passes[p].Computes(i);
    }
    std::cout << "Step " << p + 1 << " of " << plan.passes.size() << ": "
              << Describe(plan.passes[p]) << ", " << num_views
              << " views to compute" << std::endl;
  }
}

void PrintViews(const StereoPlan& plan) {
  std::cout << "Configuration has " << plan.num_results << " views.";
  const size_t num_helpers = plan.problems.size() - plan.num_results;
  if (num_helpers > 0) {
    std::cout << " " << num_helpers
              << " further ones are their sources and get photometric maps.";
  }
  std::cout << std::endl;
  if (plan.NumDone() == static_cast<int>(plan.num_results)) {
    std::cout << "All of them have their maps already: there is nothing to do. "
                 "To have maps computed again, remove them from "
              << plan.location.StereoPath() << "." << std::endl;
  }
}

}  // namespace

bool StereoPlan::IsOwn(size_t problem) const {
  // Helpers are none any more for who plans when they have their maps.
  return IsHelper(problem) ? part.HasNumber(problems[problem].reference)
                           : part.HasItem(problem, num_results);
}

bool StereoPlan::Draws(const PassPlan& pass, size_t problem) const {
  return pass.writes_pictures && passes.back().Computes(problem);
}

int StereoPlan::NumDone() const {
  const std::vector<bool>& is_done = passes.back().is_done;
  return static_cast<int>(std::count(is_done.begin(), is_done.end(), true));
}

double StereoPlan::MaxMegapixels() const {
  double max = 0;
  for (const ViewIndices& problem : problems) {
    const SceneView& view = View(problem.reference, 0);
    max = std::max(max, 1e-6 * view.width * view.height);
  }
  return max;
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
  plan.part = RunPart(options);
  plan.views.push_back(SceneViews(model, options.max_image_size));
  const int num_levels = NumLevels(options, LongestSide(plan.views[0]));
  for (int level = 1; level < num_levels; ++level) {
    plan.views.push_back(SceneViews(model, options.max_image_size, level));
  }
  std::set<std::string> names;
  for (const SceneView& view : plan.views[0]) {
    names.insert(view.name);
  }
  const std::vector<ViewConfig> config = ReadProblemConfig(
      location.ConfigPath(),
      [&names](const std::string& name) { return names.count(name) > 0; });
  plan.problems =
      ResolveProblems(config, model, options.min_triangulation_angle);
  ChooseViews(options, &plan);
  CheckMasks(options.mask_path, plan.views[0], ViewsToCompute(plan));
  plan.priors = PriorsOf(options, model, plan);
  plan.passes = PlanPasses(options, plan);
  const std::vector<SceneView> full_size =
      SceneViews(model, /* max_image_size */ -1);
  if (plan.part.IsWorker()) {
    PlanShare(options, full_size, &plan);
    return plan;
  }
  std::vector<size_t> all(plan.problems.size());
  std::iota(all.begin(), all.end(), 0);
  const ViewsRecord inputs = CurrentInputs(plan, all, full_size, options);
  CheckRecords(inputs, &plan);
  CheckMaps(&plan);
  FindNeeded(&plan);
  UpdateViewsRecords(inputs, &plan);
  WarnOfMissingPictures(plan);
  PrintViews(plan);
  if (plan.part.IsPreparation()) {
    PrintSteps(plan);
  }
  return plan;
}

}  // namespace tapa
