#ifndef TAPA_SRC_FUSION_OPTIONS_H_
#define TAPA_SRC_FUSION_OPTIONS_H_

#include "src/mvs/option_entry.h"

// COLMAP's own sources include this header, through
// src/colmap/fusion_options.h.

namespace tapa {

// Parameters of the fusion that weighs agreement (docs/design.md). What each is
// for, and its unit, stands in VisitFusionOptions.
struct FusionOptions {
  bool enabled = true;
  double depth_error = 0.002;
  double reproj_error = 0.5;
  double normal_error = 20;
  double doubt = 2;
  double threshold = 0.2;
  double spread = 0.1;
  int num_views = 20;
  double cache_size = 0.9;
};

// The table of these options: calls visit(entry, pointer to the member) for
// every one, bool, int or double. Options: FusionOptions, or the same as const.
template <typename Options, typename Visitor>
void VisitFusionOptions(Options* options, const Visitor& visit) {
  using Range = OptionRange;
  auto& o = *options;
  const auto option = [&visit](const char* name, auto* member, const char* help,
                               const Range& range = {}) {
    visit(OptionEntry{name, help, range}, member);
  };

  option("agreement", &o.enabled,
         "Weigh how well views agree and whether any sees through a point; 0: "
         "COLMAP's rule, which counts pixels. With 1 only these options and "
         "mask_path, num_threads, max_image_size and the bounding box matter; "
         "with 0 the options agreement_* do nothing");
  option("agreement_depth_error", &o.depth_error,
         "Relative difference of depth (standard deviation) at which agreement "
         "fades; beyond three times that views do not agree, and one that sees "
         "this far behind a point sees through it",
         Range::Positive());
  option("agreement_reproj_error", &o.reproj_error,
         "The same for the reprojection error, in pixels; a view sees through "
         "a point from 1.5 times that on",
         Range::Positive());
  option("agreement_normal_error", &o.normal_error,
         "The same for the angle between normals, in degrees",
         Range::From(0, 180).WithoutMin());
  option("agreement_doubt", &o.doubt,
         "What a view that sees through a point counts, where one that agrees "
         "in full counts 1",
         Range::AtLeast(0));
  option("agreement_threshold", &o.threshold,
         "Agreement less doubt that makes a point", Range::AtLeast(-1000));
  option("agreement_spread", &o.spread,
         "Pixels of the same surface count with their mean, up to this share "
         "of the image's longest side; 0: each pixel by itself",
         Range::From(0, 1));
  option("agreement_num_views", &o.num_views,
         "Views that are asked about the pixels of one, those that share most "
         "points with it",
         Range::From(1, 64));
  option("agreement_cache_size", &o.cache_size,
         "Gigabytes of maps to keep in memory, and four times those of points; "
         "other maps are read when needed, other points are kept in a file",
         Range::Positive());
}

// Throws std::invalid_argument that names the option that is not valid.
void CheckFusionOptions(const FusionOptions& options);

}  // namespace tapa

#endif  // TAPA_SRC_FUSION_OPTIONS_H_
