#ifndef TAPA_SRC_PICTURES_COLOR_MAP_H_
#define TAPA_SRC_PICTURES_COLOR_MAP_H_

#include <opencv2/core.hpp>

#include "src/base/map.h"
#include "src/base/vec3.h"

namespace tapa {

// Maps as pictures. All have the size of their map, 8 bits, and OpenCV's order
// of colours (blue, green, red).

inline const cv::Vec3b kNoEstimateColor(0, 0, 0);

// Depths between which colours change, in scene units: 0 < near <= far.
struct DepthRange {
  float near = 1;
  float far = 1;
};

// The 2nd to the 98th percentile of the depths above 0; 1 to 1 if there is
// none.
DepthRange RobustDepthRange(const Map<float>& depth);

// Inverse depth on the TURBO scale, red near and blue far, which keeps apart
// what stereo can tell apart. Depths beyond the range have its end's colour,
// pixels without depth the colour `missing`.
cv::Mat ColorDepth(const Map<float>& depth, const DepthRange& range,
                   const cv::Vec3b& missing = kNoEstimateColor);

// The colour of a single depth above 0.
cv::Vec3b DepthColor(float depth, const DepthRange& range);

// A normal's x, y, z, towards the right, the top and the camera, as red, green
// and blue: light blue is a surface that faces the camera.
cv::Mat ColorNormals(const Map<Vec3>& normal);

// The colour of a single normal in the camera frame (x right, y down, z away).
cv::Vec3b NormalColor(const Vec3& normal);

}  // namespace tapa

#endif  // TAPA_SRC_PICTURES_COLOR_MAP_H_
