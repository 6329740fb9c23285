#ifndef TAPA_SRC_MVS_TAPA_SUPERPIXEL_PLANES_H_
#define TAPA_SRC_MVS_TAPA_SUPERPIXEL_PLANES_H_

#include <cstdint>
#include <vector>

#include "src/mvs/options.h"
#include "src/mvs/plane_set.h"
#include "src/mvs/tapa/plane_fit.h"
#include "src/mvs/tapa/superpixels.h"

namespace tapa {

// A segmentation with the planes last fitted to it.
struct Segmentation {
  Superpixels superpixels;
  std::vector<FittedPlane> planes;
};

// Fits a plane to the 3D points of every superpixel (TAPA-MVS, section 4.1).
// `depth` are depths of the reference view, 0 where there is none. The largest
// distance of a point from its plane is options.plane_distance or, if that is
// <= 0, options.relative_plane_distance times the median depth of the
// superpixel. A superpixel with points at less than one in a hundred of its
// pixels, or that FitPlane finds none for, has a plane of inlier ratio 0.
std::vector<FittedPlane> FitPlanes(const TapaOptions& options,
                                   const RefCamera& camera,
                                   const Map<float>& depth,
                                   const Superpixels& superpixels,
                                   uint64_t seed);

// Draws the plane that every pixel tries: that of its own superpixel with the
// probability of its inlier ratio, otherwise that of a neighbouring superpixel,
// in proportion to the similarity of their colours. Neighbours without a plane
// are not drawn; where no plane is left the pixel tries none. `round` makes
// draws differ.
PlaneSet DrawPlanes(const Superpixels& superpixels,
                    const std::vector<FittedPlane>& planes, uint64_t seed,
                    uint32_t round);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_SUPERPIXEL_PLANES_H_
