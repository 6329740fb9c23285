#ifndef TAPA_SRC_COLMAP_FUSION_OPTION_LIST_H_
#define TAPA_SRC_COLMAP_FUSION_OPTION_LIST_H_

#include "mvs/fusion.h"
#include "src/fusion/options.h"

namespace tapa {

// Calls visit(entry, pointer to the value) for every option of fusion that the
// command line has: COLMAP's own, then those of FusionOptions. Options:
// colmap::mvs::StereoFusionOptions, or the same as const.
template <typename Options, typename Visitor>
void VisitStereoFusionOptions(Options* options, const Visitor& visit) {
  const auto option = [&visit](const char* name, auto* member) {
    visit(OptionEntry{name, ""}, member);
  };
  option("mask_path", &options->mask_path);
  option("num_threads", &options->num_threads);
  option("max_image_size", &options->max_image_size);
  option("min_num_pixels", &options->min_num_pixels);
  option("max_num_pixels", &options->max_num_pixels);
  option("max_traversal_depth", &options->max_traversal_depth);
  option("max_reproj_error", &options->max_reproj_error);
  option("max_depth_error", &options->max_depth_error);
  option("max_normal_error", &options->max_normal_error);
  option("check_num_images", &options->check_num_images);
  option("cache_size", &options->cache_size);
  option("use_cache", &options->use_cache);
  VisitFusionOptions(&options->agreement, visit);
}

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_FUSION_OPTION_LIST_H_
