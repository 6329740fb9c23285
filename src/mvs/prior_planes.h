#ifndef TAPA_SRC_MVS_PRIOR_PLANES_H_
#define TAPA_SRC_MVS_PRIOR_PLANES_H_

#include "src/base/map.h"
#include "src/mvs/problem.h"
#include "src/mvs/sweep/packed_depth_normal.h"

namespace tapa {

// What Problem::prior says of every pixel of the reference image: the plane
// that the prior's pixels around it lie on, which has the slope for a normal.
// Nothing where the prior has no depth, or one outside the problem's range.
Map<PackedDepthNormal> PriorPlanes(const Problem& problem);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_PRIOR_PLANES_H_
