#ifndef TAPA_SRC_COLMAP_OPTION_LIST_H_
#define TAPA_SRC_COLMAP_OPTION_LIST_H_

#include <string>

#include "mvs/patch_match.h"

namespace tapa {

// Calls visit(name, value) for every option of dense stereo: COLMAP's own, then
// those of HostOptions.
template <typename Visitor>
void VisitOptions(const colmap::mvs::PatchMatchOptions& options,
                  const Visitor& visit) {
#define TAPA_VISIT_OPTION(option) visit(std::string(#option), options.option)
  TAPA_VISIT_OPTION(max_image_size);
  TAPA_VISIT_OPTION(gpu_index);
  TAPA_VISIT_OPTION(depth_min);
  TAPA_VISIT_OPTION(depth_max);
  TAPA_VISIT_OPTION(window_radius);
  TAPA_VISIT_OPTION(window_step);
  TAPA_VISIT_OPTION(sigma_spatial);
  TAPA_VISIT_OPTION(sigma_color);
  TAPA_VISIT_OPTION(num_samples);
  TAPA_VISIT_OPTION(ncc_sigma);
  TAPA_VISIT_OPTION(min_triangulation_angle);
  TAPA_VISIT_OPTION(incident_angle_sigma);
  TAPA_VISIT_OPTION(num_iterations);
  TAPA_VISIT_OPTION(geom_consistency);
  TAPA_VISIT_OPTION(geom_consistency_regularizer);
  TAPA_VISIT_OPTION(geom_consistency_max_cost);
  TAPA_VISIT_OPTION(filter);
  TAPA_VISIT_OPTION(filter_min_ncc);
  TAPA_VISIT_OPTION(filter_min_triangulation_angle);
  TAPA_VISIT_OPTION(filter_min_num_consistent);
  TAPA_VISIT_OPTION(filter_geom_consistency_max_cost);
  TAPA_VISIT_OPTION(cache_size);
  TAPA_VISIT_OPTION(allow_missing_files);
  TAPA_VISIT_OPTION(write_consistency_graph);
#undef TAPA_VISIT_OPTION
  options.Visit(
      [&visit](const std::string& name, const auto* value,
               const std::string& /* help */) { visit(name, *value); });
}

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_OPTION_LIST_H_
