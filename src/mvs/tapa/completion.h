#ifndef TAPA_SRC_MVS_TAPA_COMPLETION_H_
#define TAPA_SRC_MVS_TAPA_COMPLETION_H_

#include <cstdint>
#include <vector>

#include "src/mvs/options.h"
#include "src/mvs/problem.h"
#include "src/mvs/tapa/superpixel_planes.h"

// Beyond TAPA-MVS: which estimates to believe in after the last sweep, and how
// to complete the others. See docs/tapa.md for what it gains.

namespace tapa {

// Where the final estimate of a pixel comes from.
enum Origin : uint8_t { kNoEstimate, kSwept, kFromPlane, kFilled };

// Removes depths (sets them to 0) that fewer than min_num_consistent source
// views are consistent with, by Estimate::consistent.
void RemoveInconsistent(const std::vector<uint8_t>& consistent, int num_sources,
                        int min_num_consistent, Map<float>* depth);

// A plane for every pixel, and how much the estimates near it speak for it.
struct LocalPlanes {
  // Depth 0: there is none.
  Map<float> depth;
  Map<Vec3> normal;
  // Share, 0 to 1, of the estimates that lie on the plane: those of the pixel's
  // superpixel, of which the ones outside of a square around the pixel count
  // only a fifth. One in 200 of the square's pixels is taken to speak against
  // the plane, so that few estimates do not count for much.
  Map<float> agreement;
};

// The plane of each pixel's own superpixel. radius: half size of the square
// around a pixel whose estimates count, in pixels. Planes outside of the
// problem's range of depths are left out, and masked pixels get none. depth:
// estimates to trust. Time is linear in the number of pixels in the
// superpixels' bounding boxes and does not depend on the radius.
LocalPlanes FindLocalPlanes(const Problem& problem, const RefCamera& camera,
                            const Map<float>& depth,
                            const Segmentation& segmentation, int radius);

// Keeps, at every pixel, the plane that has more agreement.
void MergeLocalPlanes(const LocalPlanes& other, LocalPlanes* planes);

// Gives pixels the plane that at least options.completion_agreement of the
// estimates near them lie on, where they have no estimate, or one that is not
// trusted (0 in `trusted`) at a textureness below
// options.completion_textureness: there, what most estimates around say is
// worth more than the pixel's own. Notes their origin.
void CompleteWithPlanes(const TapaOptions& options, const LocalPlanes& planes,
                        const Map<float>& textureness,
                        const Map<float>& trusted, Map<float>* depth,
                        Map<Vec3>* normal, Map<uint8_t>* origin);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_COMPLETION_H_
