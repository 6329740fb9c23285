#include "src/colmap/worker_checks.h"

#include <optional>
#include <string>

#include "src/base/failure.h"
#include "src/colmap/options_record.h"
#include "util/misc.h"

namespace tapa {

void CheckPreparation(const StereoPlan& plan, const PassPlan& pass,
                      const ViewsRecord& inputs) {
  constexpr char kWayOut[] =
      "; run it with --PatchMatchStereo.step 0 and the options of all workers "
      "first";
  const std::string path = plan.location.RecordPath(pass.pass, pass.level);
  const std::optional<OptionValues> options = ReadOptionsRecord(path);
  if (!options) {
    throw Failure("This step has not been prepared: there is no " + path +
                  kWayOut);
  }
  const std::string differences = DescribeDifferences(*options, pass.record);
  if (!differences.empty()) {
    throw Failure(
        "This step was prepared with other options "
        "(PatchMatchStereo: " +
        differences + "), as " + path + " says" + kWayOut);
  }
  const std::string views_path =
      plan.location.ViewsRecordPath(pass.pass, pass.level);
  const ViewsRecord recorded = ReadViewsRecord(views_path);
  for (const auto& [name, current] : inputs) {
    const auto found = recorded.find(name);
    const std::string difference =
        found == recorded.end() ? "without it"
                                : DescribeDifference(found->second, current);
    if (!difference.empty()) {
      throw Failure("View " + name + " was prepared " +
                    (found == recorded.end() ? "" : "from ") + difference +
                    ", as " + views_path + " says" + kWayOut);
    }
  }
}

void CheckStepBefore(const StereoPlan& plan, const PassPlan& pass,
                     const PassPlan& before) {
  const auto check = [&](MapKind kind, int view) {
    const std::string path =
        plan.MapPath(kind, view, before.pass, before.level);
    // A source that is not computed lends its map of full size.
    if (!colmap::ExistsPath(path) &&
        !colmap::ExistsPath(plan.MapPath(kind, view, before.pass, 0))) {
      throw Failure("There is no " + path +
                    ", from which this step starts; all shares of the step "
                    "before have to be complete first");
    }
  };
  for (size_t i = 0; i < plan.problems.size(); ++i) {
    if (!pass.Computes(i)) {
      continue;
    }
    check(MapKind::kDepth, plan.problems[i].reference);
    check(MapKind::kNormal, plan.problems[i].reference);
    if (pass.takes_drafts && pass.writes_graphs) {
      check(MapKind::kConsistencyGraph, plan.problems[i].reference);
    }
    for (const int source : plan.problems[i].sources) {
      // Helpers have no drafts.
      if (pass.takes_drafts ? plan.is_result[source]
                            : pass.pass != Pass::kPhotometric) {
        check(MapKind::kDepth, source);
      }
    }
  }
}

}  // namespace tapa
