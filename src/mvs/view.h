#ifndef TAPA_SRC_MVS_VIEW_H_
#define TAPA_SRC_MVS_VIEW_H_

#include <array>
#include <cstdint>

#include "src/base/map.h"

namespace tapa {

// Pinhole camera. A world point X is seen at (x, y) with
//
//   depth * (x, y, 1)^T = K (R X + t),   K = [fx 0 cx; 0 fy cy; 0 0 1].
//
// As in COLMAP's sparse models pixel (row, col) covers [col, col + 1) x
// [row, row + 1), so its ray goes through (col + 0.5, row + 0.5), at every
// image size: an image that is scaled has K scaled by the same ratios, nothing
// else. Depth is planar: the z coordinate in the camera frame, in scene units.
struct Camera {
  double fx = 1.0;
  double fy = 1.0;
  double cx = 0.0;
  double cy = 0.0;
  // Rotation from world to camera, row-major.
  std::array<double, 9> R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  // Translation from world to camera, in scene units.
  std::array<double, 3> t = {0, 0, 0};
};

// One photograph. The maps are borrowed: whoever calls the engine keeps them
// alive for the duration of the call.
struct View {
  Camera camera;
  // Grey image, 0 to 255. Required, but where views judge each other
  // (tapa/consensus.h).
  const Map<uint8_t>* image = nullptr;
  // Depth map from the photometric pass or, where views judge each other, the
  // complete one: same size as the image, 0 where there is no estimate.
  // Required of the source views in a geometric pass.
  const Map<float>* depth = nullptr;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_VIEW_H_
