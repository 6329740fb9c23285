#ifndef TAPA_SRC_COLMAP_FUSION_OPTIONS_H_
#define TAPA_SRC_COLMAP_FUSION_OPTIONS_H_

#include "src/fusion/options.h"

// This header is included by COLMAP's own sources.

namespace tapa {

// The options of fusion that COLMAP itself does not have. COLMAP's
// StereoFusionOptions derive from them.
struct FusionHostOptions {
  FusionOptions agreement;
};

// Fits the thresholds of COLMAP's rule to maps that TAPA has made, as its paper
// does: such maps are complete, with planes where nothing could be measured, so
// points have to agree better (half the reprojection error), while normals of
// surfaces without texture are less sure (twice the error).
template <typename Options>
void FitFusionToTapa(Options* options) {
  options->max_reproj_error *= 0.5;
  options->max_normal_error *= 2;
}

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_FUSION_OPTIONS_H_
