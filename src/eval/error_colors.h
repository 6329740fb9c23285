#ifndef TAPA_SRC_EVAL_ERROR_COLORS_H_
#define TAPA_SRC_EVAL_ERROR_COLORS_H_

#include <opencv2/core.hpp>

#include "src/base/map.h"

namespace tapa {

// Errors of depth as pictures, as in color_map.h.

inline const cv::Vec3b kNoMeasurementColor(150, 150, 150);

// The relative errors at the ends of the error colours.
constexpr float kLeastError = 0.001f;
constexpr float kMostError = 0.1f;

// Error relative to the true depth at the pixels of the ground truth, on a
// logarithmic scale from green (0.1 % and less) over yellow (1 %) to red (10 %
// and more); grey where nothing was measured. Sizes may differ as in
// DepthMapScorer.
cv::Mat ColorError(const Map<float>& depth, const Map<float>& ground_truth);

// The colour of a single relative error.
cv::Vec3b ErrorColor(float relative_error);

}  // namespace tapa

#endif  // TAPA_SRC_EVAL_ERROR_COLORS_H_
