#ifndef TAPA_SRC_MVS_TAPA_SPECKLES_H_
#define TAPA_SRC_MVS_TAPA_SPECKLES_H_

#include "src/base/map.h"

namespace tapa {

// When two neighbouring pixels belong together: their depths differ by at most
// `step` scene units or `share` of the smaller one, whichever is more.
struct Continuity {
  float step = 0;
  float share = 0;
};

// Sets small isolated regions of a depth map to 0 (TAPA-MVS, sections 4.1 and
// 5). A region is a set of pixels that hang together by steps to the left,
// right, up or down between continuous depths; those of at most max_size pixels
// are removed. What is no depth (IsDepth) belongs to no region and becomes 0,
// too. Time is linear in the number of pixels.
void RemoveSpeckles(const Continuity& continuity, int max_size,
                    Map<float>* depth);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_SPECKLES_H_
