#ifndef TAPA_SRC_MVS_TAPA_VIEW_VOTES_H_
#define TAPA_SRC_MVS_TAPA_VIEW_VOTES_H_

#include <cstdint>

#include "src/base/map.h"
#include "src/mvs/control.h"
#include "src/mvs/options.h"
#include "src/mvs/problem.h"

// Beyond TAPA-MVS: which of two surfaces other views speak for. See
// docs/tapa.md for what it gains.

namespace tapa {

// How many more votes one depth of a reference pixel has than another; 0 where
// `depth` has none. Where `other` has none, it has no votes. A source view
// gives a vote to a point that its own estimate, or its own triangle between
// textured estimates (triangle_planes.h), agrees with up to
// tapa_relative_plane_distance, and two against one that both lie behind.
// Source views need depth maps. Ends early, with a part of the votes, once
// control.stopped() says so.
Map<int16_t> CountVotes(const Options& options, const Problem& problem,
                        const Control& control, const Map<float>& depth,
                        const Map<float>& other);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_VIEW_VOTES_H_
