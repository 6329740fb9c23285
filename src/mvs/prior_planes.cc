#include "src/mvs/prior_planes.h"

#include "src/mvs/camera_table.h"
#include "src/mvs/depth_planes.h"

namespace tapa {

Map<PackedDepthNormal> PriorPlanes(const Problem& problem) {
  const Map<uint8_t>& image = *problem.reference.image;
  const DepthPlanes surface(problem.prior, CameraTable(problem).reference(),
                            image.width(), image.height());
  Map<PackedDepthNormal> planes(image.width(), image.height(), PackNothing());
  for (int row = 0; row < image.height(); ++row) {
    for (int col = 0; col < image.width(); ++col) {
      const DepthNormal plane = surface.At(row, col);
      if (plane.depth >= problem.depth_min &&
          plane.depth <= problem.depth_max) {
        planes.At(row, col) = Pack(plane);
      }
    }
  }
  return planes;
}

}  // namespace tapa
