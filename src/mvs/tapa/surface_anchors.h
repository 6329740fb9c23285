#ifndef TAPA_SRC_MVS_TAPA_SURFACE_ANCHORS_H_
#define TAPA_SRC_MVS_TAPA_SURFACE_ANCHORS_H_

#include <vector>

#include "src/base/map.h"
#include "src/mvs/control.h"
#include "src/mvs/options.h"
#include "src/mvs/problem.h"
#include "src/mvs/sweep/ref_camera.h"
#include "src/mvs/tapa/triangle_planes.h"

// Beyond TAPA-MVS: where textured estimates of all views say that surfaces are.

namespace tapa {

// A point in the frame of the reference camera, and the pixel of the reference
// view that sees it.
struct SurfaceAnchor {
  Anchor pixel;
  Vec3 point;
};

// The anchors (triangle_planes.h) of the reference view and, if
// options.geom_consistency is set, those of the source views that it sees, in
// the order of the sources. camera, depth (0: none) and textureness are the
// reference view's. It sees a point unless the pixel is masked or has a depth
// that is less than the point's by more than tapa_relative_plane_distance.
// Source views without a depth map have no anchors. Ends early, with a part of
// them, once control.stopped() says so.
std::vector<SurfaceAnchor> FindSurfaceAnchors(const Options& options,
                                              const Problem& problem,
                                              const Control& control,
                                              const RefCamera& camera,
                                              const Map<float>& depth,
                                              const Map<float>& textureness);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_SURFACE_ANCHORS_H_
