#ifndef TAPA_SRC_MVS_TAPA_SILHOUETTES_H_
#define TAPA_SRC_MVS_TAPA_SILHOUETTES_H_

#include <cstdint>

#include "src/base/map.h"
#include "src/mvs/options.h"
#include "src/mvs/problem.h"
#include "src/mvs/sweep/ref_camera.h"

// Beyond TAPA-MVS: see docs/tapa.md for what it gains.

namespace tapa {

// Mends estimates beside texture. A window that holds both a textured
// silhouette and the plain surface behind it sees the silhouette best, so the
// surface in front grows over the one behind by up to half a window. Further
// away the windows hold one surface only. So a pixel within
// options.window_radius of texture (above options.tapa.completion_textureness)
// asks pixels around that are further away from it, in a grid within three
// radii: their planes, where they meet the pixel's ray, have weights that fall
// off with difference in colour. If less than options.tapa.completion_agreement
// of the weight lies on the pixel's own depth, to relative_plane_distance, and
// at least as much on the weighted median (Ma, He, Wei, Sun and Wu, "Constant
// Time Weighted Median Filtering for Stereo Matching and Beyond", ICCV 2013),
// the pixel becomes part of the plane that gave the median.
//
// color: the reference photograph. Depth (0: none; such pixels stay without),
// normal and origin (completion.h) are the view's and of its size.
void MendSilhouettes(const Options& options, const Problem& problem,
                     const RefCamera& camera, const Map<Rgb>& color,
                     const Map<float>& textureness, Map<float>* depth,
                     Map<Vec3>* normal, Map<uint8_t>* origin);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_SILHOUETTES_H_
