#ifndef TAPA_SRC_MVS_DEPTH_PLANES_H_
#define TAPA_SRC_MVS_DEPTH_PLANES_H_

#include "src/base/map.h"
#include "src/mvs/sweep/depth_normal.h"
#include "src/mvs/sweep/ref_camera.h"

namespace tapa {

// The planes that a depth map has the slope of.
class DepthPlanes {
 public:
  // depth: of any size, in scene units; what is no depth (IsDepth) is not
  // known. Must outlive the object. camera: for pixels of an image of the given
  // size, which the depth map covers.
  DepthPlanes(const Map<float>& depth, const RefCamera& camera, int width,
              int height);

  // The plane through the depth map's pixels around a pixel of the image,
  // without those beyond an edge; depth 0 where there is no depth. One with no
  // other on its surface faces along the axis of the camera.
  DepthNormal At(int row, int col) const;

 private:
  // One direction of the image, and the samples of the depth map along it: its
  // own pixels, or as far apart as the image's where it is larger.
  struct Axis {
    Axis(int image_size, int depth_size);

    // The pixel of the depth map that one of the image has its centre in, and
    // where the centre of a pixel of the depth map is in the image, in indices
    // of pixels.
    int ToDepth(int index) const;
    double ToImage(int index) const { return (index + 0.5) / scale - 0.5; }

    int size;
    double scale;
    int step;
  };
  class SlopeFit;

  SlopeFit FitAround(int depth_row, int depth_col, int row, int col) const;

  const Map<float>& depth_;
  const RefCamera camera_;
  const Axis rows_;
  const Axis cols_;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_DEPTH_PLANES_H_
