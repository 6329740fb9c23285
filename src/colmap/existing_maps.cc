#include "src/colmap/existing_maps.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "src/base/failure.h"
#include "src/colmap/masks.h"
#include "src/colmap/progress.h"
#include "src/colmap/tapa_debug.h"
#include "util/misc.h"

namespace tapa {
namespace {

using colmap::ExistsPath;
using colmap::mvs::PatchMatchOptions;

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
  // Pictures show how a draft came about; without them it has to do so again.
  const bool lacks_pictures =
      pass.writes_pictures && pass.pass == Pass::kDraft &&
      !HasTapaPictures(
          PictureFolder(pass.options.tapa_debug, plan.View(view, 0).name));
  return has_depth && has_normal && has_graph && !lacks_pictures;
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

// Whether drafts or the maps of a coarse level can be gone on with: another
// run, with other options or photographs, may have left them when it was
// stopped.
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

}  // namespace

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

void CheckRecords(const ViewsRecord& inputs, StereoPlan* plan) {
  for (const PassPlan& pass : plan->passes) {
    if (pass.has_maps && IsResult(pass.pass, pass.level)) {
      CheckRecord(*plan, pass);
      CheckInputs(*plan, pass, inputs);
    } else if (pass.has_maps && !IsUsable(*plan, pass, inputs)) {
      plan->drops_levels = true;
    }
  }
  if (plan->drops_levels) {
    for (PassPlan& pass : plan->passes) {
      pass.has_maps = pass.has_maps && IsResult(pass.pass, pass.level);
    }
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

}  // namespace tapa
