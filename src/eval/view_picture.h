#ifndef TAPA_SRC_EVAL_VIEW_PICTURE_H_
#define TAPA_SRC_EVAL_VIEW_PICTURE_H_

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "src/base/map.h"
#include "src/base/vec3.h"

namespace tapa {

// What is shown of one view. The maps are borrowed; they may differ in size
// from the photograph and from each other.
struct ViewPicture {
  std::string title;
  // 8 bits; blue, green, red.
  cv::Mat photograph;
  // Required, in scene units.
  const Map<float>* depth = nullptr;
  // Without them their panels are left out.
  const Map<Vec3>* normal = nullptr;
  const Map<float>* ground_truth = nullptr;
  // Lines for the legend.
  std::vector<std::string> notes;
};

// Draws photograph, depth, normals, ground truth and error (see color_map.h)
// side by side, with captions and a legend, at most 2000 pixels wide. The
// colours of depth span the ground truth's range, or without it the estimates'.
cv::Mat DrawView(const ViewPicture& view);

}  // namespace tapa

#endif  // TAPA_SRC_EVAL_VIEW_PICTURE_H_
