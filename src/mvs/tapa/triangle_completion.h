#ifndef TAPA_SRC_MVS_TAPA_TRIANGLE_COMPLETION_H_
#define TAPA_SRC_MVS_TAPA_TRIANGLE_COMPLETION_H_

#include <cstdint>

#include "src/base/map.h"
#include "src/mvs/control.h"
#include "src/mvs/options.h"
#include "src/mvs/problem.h"

// Beyond TAPA-MVS: see docs/tapa.md for what it gains.

namespace tapa {

// Gives pixels with a textureness below options.tapa.completion_textureness the
// plane of the triangle between trusted estimates with clear texture
// (triangle_planes.h) where source views (view_votes.h) and the anchors around
// (anchor_votes.h) have enough more votes for it than for their estimate, there
// and at similar pixels nearby (similar_mean.h), and notes their origin. Depth,
// normal and origin are those of the view; trusted: the depths that enough
// views support, 0 elsewhere. Source views need depth maps. Changes nothing
// once control.stopped() says so.
void CompleteWithTriangles(const Options& options, const Problem& problem,
                           const Control& control,
                           const Map<float>& textureness,
                           const Map<float>& trusted, Map<float>* depth,
                           Map<Vec3>* normal, Map<uint8_t>* origin);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_TRIANGLE_COMPLETION_H_
