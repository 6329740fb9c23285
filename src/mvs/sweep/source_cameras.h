#ifndef TAPA_SRC_MVS_SWEEP_SOURCE_CAMERAS_H_
#define TAPA_SRC_MVS_SWEEP_SOURCE_CAMERAS_H_

#include "src/base/vec3.h"

namespace tapa {

// Geometry of all source views relative to the reference view, one array per
// coefficient so that loops over the views vectorize. Pixels are named by their
// indices, p = (col, row, 1)^T. With the intrinsics for these (see
// CameraTable), K of the reference and K_m of the source, and the relative pose
// (R, t), which takes points from the reference frame to the source frame:
//
//   A = K_m R K^-1, b = K_m t:      reference pixel p at depth d projects to
//                                   d A p + b; a plane maps p to (A + b m^T) p
//   B = K R^T K_m^-1, g = K C:      source pixel q at depth d projects back to
//                                   d B q + g
//   C = -R^T t:                     centre of the source camera
//
// Arrays are padded to a multiple of kPadding with copies of view 0; `valid` is
// 1 for real views and 0 for the padding.
struct SourceCameras {
  static constexpr int kPadding = 16;
  static constexpr int kNumCoefficients = 9 + 3 + 9 + 3 + 3 + 1;

  int count = 0;
  int padded_count = 0;
  const float* A[9];
  const float* b[3];
  const float* B[9];
  const float* g[3];
  const float* C[3];
  const float* valid;
};

// The cameras in a table of kNumCoefficients arrays, in the order above, each
// `stride` elements after the one before.
TAPA_INLINE SourceCameras ArrangeCameras(const float* table, int stride,
                                         int count, int padded_count) {
  SourceCameras views;
  views.count = count;
  views.padded_count = padded_count;
  for (int i = 0; i < 9; ++i) {
    views.A[i] = table + i * stride;
    views.B[i] = table + (12 + i) * stride;
  }
  for (int i = 0; i < 3; ++i) {
    views.b[i] = table + (9 + i) * stride;
    views.g[i] = table + (21 + i) * stride;
    views.C[i] = table + (24 + i) * stride;
  }
  views.valid = table + 27 * stride;
  return views;
}

// Homogeneous coordinates in a source image of the pixels around a reference
// pixel (row, col) on a plane: the pixel at (row + dy, col + dx) is seen at
// origin + dx * step_x + dy * step_y.
struct Warp {
  Vec3 origin;
  Vec3 step_x;
  Vec3 step_y;

  TAPA_INLINE Vec3 At(float dx, float dy) const {
    return {origin.x + dx * step_x.x + dy * step_y.x,
            origin.y + dx * step_x.y + dy * step_y.y,
            origin.z + dx * step_x.z + dy * step_y.z};
  }
};

TAPA_INLINE Warp ComputeWarp(const SourceCameras& views, int m, float row,
                             float col, const Vec3& h) {
  const float bx = views.b[0][m];
  const float by = views.b[1][m];
  const float bz = views.b[2][m];
  Warp warp;
  warp.step_x = {views.A[0][m] + bx * h.x, views.A[3][m] + by * h.x,
                 views.A[6][m] + bz * h.x};
  warp.step_y = {views.A[1][m] + bx * h.y, views.A[4][m] + by * h.y,
                 views.A[7][m] + bz * h.y};
  warp.origin = {
      warp.step_x.x * col + warp.step_y.x * row + views.A[2][m] + bx * h.z,
      warp.step_x.y * col + warp.step_y.y * row + views.A[5][m] + by * h.z,
      warp.step_x.z * col + warp.step_y.z * row + views.A[8][m] + bz * h.z};
  return warp;
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_SOURCE_CAMERAS_H_
