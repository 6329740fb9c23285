#ifndef TAPA_SRC_MVS_SWEEP_REF_CAMERA_H_
#define TAPA_SRC_MVS_SWEEP_REF_CAMERA_H_

#include "src/base/vec3.h"

namespace tapa {

// Intrinsics of the reference camera in the form that sweeps need: for indices
// of pixels (see CameraTable).
struct RefCamera {
  float inv_fx;
  float inv_fy;
  // (0.5 - cx) / fx and (0.5 - cy) / fy.
  float offset_x;
  float offset_y;

  // Ray of a pixel's centre in the camera's frame, scaled to depth 1.
  TAPA_INLINE Vec3 Ray(float row, float col) const {
    return {inv_fx * col + offset_x, inv_fy * row + offset_y, 1.0f};
  }
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_REF_CAMERA_H_
