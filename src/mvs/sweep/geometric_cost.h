#ifndef TAPA_SRC_MVS_SWEEP_GEOMETRIC_COST_H_
#define TAPA_SRC_MVS_SWEEP_GEOMETRIC_COST_H_

#include <cmath>

#include "src/mvs/sweep/source_cameras.h"

namespace tapa {

// Homogeneous coordinates of the point at `depth` on the ray of pixel (col,
// row) in view m's other camera: depth M (col, row, 1)^T + v, where M and v are
// A and b, or B and g, of SourceCameras.
TAPA_INLINE Vec3 TransferPoint(const float* const M[9], const float* const v[3],
                               int m, float col, float row, float depth) {
  return {depth * (M[0][m] * col + M[1][m] * row + M[2][m]) + v[0][m],
          depth * (M[3][m] * col + M[4][m] * row + M[5][m]) + v[1][m],
          depth * (M[6][m] * col + M[7][m] * row + M[8][m]) + v[2][m]};
}

// A reference pixel's place in a source image: whole numbers are the centres of
// that image's pixels; (-1, -1) for points that are not in front of the camera.
struct Projection {
  float col;
  float row;
};

TAPA_INLINE Projection ProjectToSource(const SourceCameras& views, int m,
                                       float row, float col, float depth) {
  const Vec3 p = TransferPoint(views.A, views.b, m, col, row, depth);
  const float inv_z = 1.0f / p.z;
  const bool in_front = p.z > 0.0f;
  return {in_front ? p.x * inv_z : -1.0f, in_front ? p.y * inv_z : -1.0f};
}

// Forward-backward reprojection error in reference pixels, at most max_cost:
// the distance of (row, col) to where its projection into the source view comes
// back to, given the source view's own depth there. max_cost where that view
// has no estimate (depth 0).
TAPA_INLINE float ReprojectionError(const SourceCameras& views, int m,
                                    float row, float col,
                                    const Projection& projection,
                                    float source_depth, float max_cost) {
  const Vec3 p = TransferPoint(views.B, views.g, m, projection.col,
                               projection.row, source_depth);
  const float inv_z = 1.0f / p.z;
  const float dx = col - p.x * inv_z;
  const float dy = row - p.y * inv_z;
  const float error = sqrtf(dx * dx + dy * dy);
  // Also false where the error is NaN.
  const bool valid = (source_depth > 0.0f) & (error < max_cost);
  return valid ? error : max_cost;
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_GEOMETRIC_COST_H_
