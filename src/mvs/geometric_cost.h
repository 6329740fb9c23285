#ifndef TAPA_SRC_MVS_GEOMETRIC_COST_H_
#define TAPA_SRC_MVS_GEOMETRIC_COST_H_

#include <cmath>

#include "src/mvs/source_cameras.h"

namespace tapa {

// A reference pixel's place in a source image, in pixels of that image;
// (-1, -1) for points that are not in front of the camera.
struct Projection {
  float col;
  float row;
};

TAPA_INLINE Projection ProjectToSource(const SourceCameras& views, int m,
                                       float row, float col, float depth) {
  const float x =
      depth * (views.A[0][m] * col + views.A[1][m] * row + views.A[2][m]) +
      views.b[0][m];
  const float y =
      depth * (views.A[3][m] * col + views.A[4][m] * row + views.A[5][m]) +
      views.b[1][m];
  const float z =
      depth * (views.A[6][m] * col + views.A[7][m] * row + views.A[8][m]) +
      views.b[2][m];
  const float inv_z = 1.0f / z;
  const bool in_front = z > 0.0f;
  return {in_front ? x * inv_z : -1.0f, in_front ? y * inv_z : -1.0f};
}

// Forward-backward reprojection error in reference pixels, at most max_cost:
// the distance of (row, col) to where its projection into the source view comes
// back to, given the source view's own depth there. max_cost where that view
// has no estimate (depth 0).
TAPA_INLINE float ReprojectionError(const SourceCameras& views, int m,
                                    float row, float col,
                                    const Projection& projection,
                                    float source_depth, float max_cost) {
  const float u = projection.col;
  const float v = projection.row;
  const float x =
      source_depth * (views.B[0][m] * u + views.B[1][m] * v + views.B[2][m]) +
      views.g[0][m];
  const float y =
      source_depth * (views.B[3][m] * u + views.B[4][m] * v + views.B[5][m]) +
      views.g[1][m];
  const float z =
      source_depth * (views.B[6][m] * u + views.B[7][m] * v + views.B[8][m]) +
      views.g[2][m];
  const float inv_z = 1.0f / z;
  const float dx = col - x * inv_z;
  const float dy = row - y * inv_z;
  const float error = sqrtf(dx * dx + dy * dy);
  // Also false for errors that are not a number.
  const bool valid = (source_depth > 0.0f) & (error < max_cost);
  return valid ? error : max_cost;
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_GEOMETRIC_COST_H_
