#ifndef TAPA_SRC_MVS_LEVELS_H_
#define TAPA_SRC_MVS_LEVELS_H_

#include "src/base/map.h"
#include "src/base/vec3.h"
#include "src/mvs/view.h"

// Coarse to fine. Level 0 has images of full size, level k of 2^-k of that.
// Estimation begins at the coarsest level, where images are small and windows
// see far; every other one starts from the estimates of the level above it. All
// views finish a level before the next one begins, so that each sees its
// neighbours' maps of its own level: coarse ones would pull it towards their
// errors.

namespace tapa {

// The longest side of an image at a level, in pixels, if it is `longest_side`
// at level 0: half of that per level, but at least kMinLongestSide, and never
// more than at level 0.
int LongestSideAtLevel(int longest_side, int level);

// As many levels as there are that make the images smaller.
int AutomaticNumLevels(int longest_side);

// Depth and unit normals of every pixel, as in Problem.
struct DepthNormalMaps {
  Map<float> depth;
  Map<Vec3> normal;
};

// Hands estimates up from one level to a finer one: every pixel gets the plane
// of the coarse pixel that it lies in, with the depth of that plane at its own
// centre. Pixels whose plane is not seen from the front there get depth 0. Of
// `coarse` and `fine` the camera counts, and of `fine` the image's size.
DepthNormalMaps HandUp(const DepthNormalMaps& estimate, const Camera& coarse,
                       const View& fine);

// Every pixel has the depth of the pixel of `depth` that its centre lies in.
Map<float> ReduceDepth(const Map<float>& depth, int width, int height);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_LEVELS_H_
