#ifndef TAPA_SRC_MVS_TAPA_REGION_PLANES_H_
#define TAPA_SRC_MVS_TAPA_REGION_PLANES_H_

#include <cstdint>

#include "src/base/map.h"
#include "src/mvs/control.h"
#include "src/mvs/options.h"
#include "src/mvs/problem.h"
#include "src/mvs/sweep/ref_camera.h"

// Beyond TAPA-MVS: see docs/tapa.md for what it gains.

namespace tapa {

// Gives regions of one colour (even_regions.h) the plane that goes through
// what surrounds them. An evenly coloured region is likely flat (TAPA-MVS,
// section 1), but nothing in it says where it is: its estimates are what they
// propagated from, on a ceiling often the wall below, and all views agree upon
// that. The anchors of all views (surface_anchors.h) in it and around it, up to
// the side of an anchor's square away, say more. Each square of the view counts
// once: a plane is on it if one of its anchors lies on the plane, by errors of
// depth up to relative_plane_distance. The region's plane is on most of them
// (RANSAC), at least 8 and half of all.
//
// Pixels of the region with a textureness below 0.5 whose own depth is further
// away from the plane than relative_plane_distance, or that have none, become
// part of it, as far as the plane is known as well as an anchor is: anchors
// along a line say nothing of what is beside it. But where there is no
// edge between two surfaces a region holds both: pixels stay that lie on the
// plane of most of the anchors that the first one misses, in at least 8
// squares, where that one is known, if a tenth of the region's pixels lay on it
// before this step. The plane may leave the problem's range of depths.
//
// Regions are tried that end at steps of 6 grey levels, then those that end at
// 3: what is found in the smaller ones has the last word.
//
// Masked pixels are in no region. color: the reference photograph. Depth (0:
// none), normal and origin (completion.h) are the view's and of its size. Ends
// early once control.stopped() says so.
void CompleteRegions(const Options& options, const Problem& problem,
                     const Control& control, const RefCamera& camera,
                     const Map<Rgb>& color, const Map<float>& textureness,
                     Map<float>* depth, Map<Vec3>* normal,
                     Map<uint8_t>* origin);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_REGION_PLANES_H_
