#ifndef TAPA_SRC_MVS_TAPA_CONSENSUS_H_
#define TAPA_SRC_MVS_TAPA_CONSENSUS_H_

#include <cstddef>

#include "src/base/map.h"
#include "src/base/vec3.h"
#include "src/mvs/control.h"
#include "src/mvs/options.h"
#include "src/mvs/problem.h"

// Beyond TAPA-MVS: what complete views say of each other. See docs/tapa.md for
// what it gains.

namespace tapa {

// Lets the source views judge depth (0: none) and normal of the reference view,
// when all of them are complete. They vote for what they see, too, and against
// what they see through (jury.h).
//
// An estimate with more votes against it than for it gives way to what some
// source view sees first on the pixel's ray, of several to that with the
// largest lead, if that is at least three votes, the view's own among them.
// Without such it goes. A pixel without an estimate is filled under the same
// condition. Masked pixels get nothing. New estimates lie on the plane through
// the source view's pixels around what it sees.
//
// Only cameras and depth maps of the views are looked at; a source view without
// a depth map has no votes. The result does not depend on the number of
// threads. Returns false, with maps that make no sense, if control.stopped()
// said so.
bool ReachConsensus(const Options& options, const Problem& problem,
                    const Control& control, Map<float>* depth,
                    Map<Vec3>* normal);

// Bytes of memory that it needs with the views' maps: for w x h pixels, n
// source views of that size and t threads, or n if these are more, w h (24 + 4
// t + 4 n).
size_t ConsensusMemory(const Options& options, const Problem& problem,
                       int width, int height);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_CONSENSUS_H_
