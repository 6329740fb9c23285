#ifndef TAPA_SRC_COLMAP_OPTION_LIST_H_
#define TAPA_SRC_COLMAP_OPTION_LIST_H_

#include "mvs/patch_match.h"
#include "src/mvs/option_entry.h"
#include "src/mvs/options.h"

namespace tapa {

// Calls visit(entry, pointer to the value) for every option of dense stereo:
// COLMAP's own, then those of HostOptions. Options:
// colmap::mvs::PatchMatchOptions, or the same as const.
template <typename Options, typename Visitor>
void VisitOptions(Options* options, const Visitor& visit) {
  using Range = OptionRange;
  const auto option = [&visit](const char* name, auto* member,
                               bool changes_maps, const Range& range = {}) {
    visit(OptionEntry{name, "", range, changes_maps}, member);
  };
  option("max_image_size", &options->max_image_size, true,
         Range::Positive().OrMinusOne("no limit"));
  option("gpu_index", &options->gpu_index, false);
  option("depth_min", &options->depth_min, true);
  option("depth_max", &options->depth_max, true);
  VisitSharedOptions(visit, options);
  option("cache_size", &options->cache_size, false, Range::Positive());
  option("allow_missing_files", &options->allow_missing_files, false);
  option("write_consistency_graph", &options->write_consistency_graph, false);
  VisitHostOptions(options, visit);
}

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_OPTION_LIST_H_
