#ifndef TAPA_SRC_MVS_TAPA_SIGHTINGS_H_
#define TAPA_SRC_MVS_TAPA_SIGHTINGS_H_

#include "src/base/map.h"
#include "src/mvs/control.h"
#include "src/mvs/options.h"
#include "src/mvs/problem.h"

// Beyond TAPA-MVS: what other views know of the surfaces that the reference
// view sees. See docs/tapa.md for what it gains.

namespace tapa {

// Depths, in the reference view, of what source views see at pixels that are
// not masked and where `known` has no depth: their estimates that at least
// options.filter_min_num_consistent other views are consistent with, the
// reference view with its depths `swept` among them, under the filter's
// conditions. Of several the nearest; 0 where there is none. Source views need
// depth maps. Ends early, with a part of them, once control.stopped() says so.
Map<float> FindSightings(const Options& options, const Problem& problem,
                         const Control& control, const Map<float>& swept,
                         const Map<float>& known);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_SIGHTINGS_H_
