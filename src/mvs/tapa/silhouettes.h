#ifndef TAPA_SRC_MVS_TAPA_SILHOUETTES_H_
#define TAPA_SRC_MVS_TAPA_SILHOUETTES_H_

#include <cstdint>

#include "src/base/map.h"
#include "src/mvs/control.h"
#include "src/mvs/options.h"
#include "src/mvs/problem.h"
#include "src/mvs/sweep/ref_camera.h"

// Beyond TAPA-MVS: see docs/tapa.md for what it gains.

namespace tapa {

// Mends estimates beside texture. A window that holds both a textured
// silhouette and the plain surface behind it sees the silhouette best, so the
// surface in front grows over the one behind by up to half a window. Further
// away the windows hold one surface only. So a pixel within
// options.window_radius of texture (textureness above 0.5) asks pixels around
// that are further away from it, in a grid within three radii: their planes,
// where they meet the pixel's ray, have weights that fall off with difference
// in colour, to 1 / e at 10 grey levels. If less than half of the weight lies
// on the pixel's own depth, to relative_plane_distance, and at least half on
// the weighted median (Ma, He, Wei, Sun and Wu, "Constant Time Weighted Median
// Filtering for Stereo Matching and Beyond", ICCV 2013), the pixel becomes part
// of the plane that gave the median, also where views agree upon its own: they
// all grow alike. Where the weights sum up to no more than 4 of 64, as beside
// things that have texture all over, it stays.
//
// color: the reference photograph. Depth (0: none; such pixels stay without),
// normal and origin (completion.h) are the view's and of its size. Ends early
// once control.stopped() says so.
void MendSilhouettes(const Options& options, const Problem& problem,
                     const Control& control, const RefCamera& camera,
                     const Map<Rgb>& color, const Map<float>& textureness,
                     Map<float>* depth, Map<Vec3>* normal,
                     Map<uint8_t>* origin);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_SILHOUETTES_H_
