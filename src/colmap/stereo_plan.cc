#include "src/colmap/stereo_plan.h"

#include <algorithm>
#include <iostream>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <sstream>

#include "src/base/failure.h"
#include "src/colmap/engine_options.h"
#include "src/colmap/masks.h"
#include "src/colmap/progress.h"
#include "src/colmap/worker_checks.h"
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

// Whether a plan depends on which maps a pass has. What a worker has to compute
// depends on its own maps and on those of later passes, which nobody computes
// at the same time.
bool LooksAtMaps(const StereoPlan& plan, size_t pass, size_t problem) {
  if (!plan.part.IsWorker()) {
    return true;
  }
  const size_t own_pass = plan.part.PassIndex(plan.passes.size());
  return pass > own_pass || (pass == own_pass && plan.IsOwn(problem));
}

// Looks at the maps that are there already.
void CheckMaps(StereoPlan* plan) {
  const bool is_geometric = plan->passes.back().pass == Pass::kGeometric;
  for (size_t p = 0; p < plan->passes.size(); ++p) {
    PassPlan& pass = plan->passes[p];
    for (size_t i = 0; i < plan->problems.size(); ++i) {
      const bool is_result = &pass == &plan->passes.back();
      pass.is_done.push_back(pass.has_maps &&
                             !(is_result && plan->IsHelper(i)) &&
                             LooksAtMaps(*plan, p, i) &&
                             IsDone(*plan, pass, plan->problems[i].reference));
    }
  }
  for (size_t i = 0; i < plan->problems.size(); ++i) {
    for (const int source : plan->problems[i].sources) {
      if (is_geometric && plan->IsOwn(i)) {
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
    for (size_t i = 0; i < num_problems; ++i) {
      pass.is_needed.push_back(pass.level == 0 && !plan->IsHelper(i));
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
        if (pass.pass == Pass::kGeometric && problem_of[source] >= 0) {
          before[problem_of[source]] = true;
        }
      }
    }
  }
}

// What the maps of problems, by their indices, are made from. views: at the
// size of their photographs.
ViewsRecord CurrentInputs(const StereoPlan& plan,
                          const std::vector<size_t>& problems,
                          const std::vector<SceneView>& views,
                          const PatchMatchOptions& options) {
  std::map<int, ViewFiles> files;
  const auto describe = [&](int view) {
    if (files.count(view) == 0) {
      const std::string& name = views[view].name;
      const auto describe_any = [](const std::string& path) {
        return path.empty() ? "" : DescribeFile(path);
      };
      files[view] = {DescribeFile(views[view].image_path),
                     describe_any(MaskPath(options.mask_path, name)),
                     describe_any(PriorPath(options.prior_path, name))};
    }
  };
  ViewsRecord inputs;
  for (const size_t i : problems) {
    const ViewIndices& problem = plan.problems[i];
    describe(problem.reference);
    std::for_each(problem.sources.begin(), problem.sources.end(), describe);
    inputs[views[problem.reference].name] =
        DescribeInputs(views, problem.reference, problem.sources, files);
  }
  return inputs;
}

// Maps of a pass that are made from something else than this run's.
struct StaleMaps {
  std::vector<std::string> names;
  // Of the first one.
  std::string difference;
  // Whether it is not known what others are made from.
  bool has_unknown = false;
};

StaleMaps FindStaleMaps(const StereoPlan& plan, const PassPlan& pass,
                        const ViewsRecord& recorded,
                        const ViewsRecord& current) {
  StaleMaps stale;
  for (const ViewIndices& problem : plan.problems) {
    const std::string& name = plan.View(problem.reference, 0).name;
    if (!ExistsPath(plan.MapPath(MapKind::kDepth, problem.reference, pass.pass,
                                 pass.level))) {
      continue;
    }
    const auto found = recorded.find(name);
    if (found == recorded.end()) {
      stale.has_unknown = true;
      continue;
    }
    const std::string difference =
        DescribeDifference(found->second, current.at(name));
    if (!difference.empty()) {
      if (stale.names.empty()) {
        stale.difference = difference;
      }
      stale.names.push_back(name);
    }
  }
  return stale;
}

// Compares what the maps of a pass were made from with what there is now.
void CheckInputs(const StereoPlan& plan, const PassPlan& pass,
                 const ViewsRecord& current) {
  const std::string path = plan.location.ViewsRecordPath(pass.pass, pass.level);
  const StaleMaps stale =
      FindStaleMaps(plan, pass, ReadViewsRecord(path), current);
  if (!stale.names.empty()) {
    throw Failure(
        std::string("The ") + PassName(pass.pass) + " maps of " +
        std::to_string(stale.names.size()) + " views, such as " +
        stale.names[0] + ", in " + plan.location.StereoPath() +
        " were made from " + stale.difference +
        " than there are now; remove their *.photometric.bin and "
        "*.geometric.bin to have them computed again, name another workspace, "
        "or remove " +
        path + " to keep these maps");
  }
  if (stale.has_unknown) {
    PrintWarning(
        std::string("It is not known which poses and photographs the ") +
        PassName(pass.pass) + " maps in " + plan.location.StereoPath() +
        " were made from; they are kept");
  }
}

// Whether the maps of a coarse level can be gone on with: another run, with
// other options or photographs, may have left them when it was stopped.
bool IsUsable(const StereoPlan& plan, const PassPlan& pass,
              const ViewsRecord& inputs) {
  try {
    const std::optional<OptionValues> recorded =
        ReadOptionsRecord(plan.location.RecordPath(pass.pass, pass.level));
    if (!recorded || *recorded != pass.record) {
      return false;
    }
    for (const ViewIndices& problem : plan.problems) {
      IsDone(plan, pass, problem.reference);
    }
    const StaleMaps stale = FindStaleMaps(
        plan, pass,
        ReadViewsRecord(plan.location.ViewsRecordPath(pass.pass, pass.level)),
        inputs);
    return stale.names.empty() && !stale.has_unknown;
  } catch (const Failure&) {
    return false;
  }
}

// Compares the maps that are there with what this run would make. Those of
// coarse levels are nobody's result: all go if one does not fit.
void CheckRecords(const ViewsRecord& inputs, StereoPlan* plan) {
  for (const PassPlan& pass : plan->passes) {
    if (pass.has_maps && pass.level == 0) {
      CheckRecord(*plan, pass);
      CheckInputs(*plan, pass, inputs);
    } else if (pass.has_maps && !IsUsable(*plan, pass, inputs)) {
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
  if (pass.writes_pictures && plan.NumDone() > 0) {
    PrintWarning(std::to_string(plan.NumDone()) + " of " +
                 std::to_string(plan.num_results) +
                 " views have their maps already, so that this run draws no "
                 "pictures of them; to get some, remove their *." +
                 PassName(pass.pass) + ".bin");
  }
}

void UpdateViewsRecords(const ViewsRecord& inputs, StereoPlan* plan) {
  for (PassPlan& pass : plan->passes) {
    if (pass.has_maps) {
      pass.views_record = ReadViewsRecord(
          plan->location.ViewsRecordPath(pass.pass, pass.level));
    }
    for (size_t i = 0; i < plan->problems.size(); ++i) {
      if (pass.Computes(i)) {
        const std::string& name =
            plan->View(plan->problems[i].reference, 0).name;
        pass.views_record[name] = inputs.at(name);
      }
    }
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
  MissingFiles::Drop(options, &plan);
  AddHelpers(options, &plan);
  CheckDepthRanges(options, plan);
  WarnOfFilter(options, plan);
  CheckMasks(options.mask_path, plan.views[0], ViewsToCompute(plan));
  plan.priors = PriorsOf(options, model, plan);
  plan.passes = Passes(options, plan);
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
