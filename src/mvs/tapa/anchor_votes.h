#ifndef TAPA_SRC_MVS_TAPA_ANCHOR_VOTES_H_
#define TAPA_SRC_MVS_TAPA_ANCHOR_VOTES_H_

#include <vector>

#include "src/mvs/sweep/plane.h"
#include "src/mvs/tapa/triangle_planes.h"

// Beyond TAPA-MVS: whether a surface goes through what lies around it. See
// docs/tapa.md for what it gains.

namespace tapa {

// The anchors around triangles, as voters for planes. Refers to the triangles.
class AnchorVotes {
 public:
  // tolerance: how far a plane may miss an anchor, relative to its depth.
  AnchorVotes(const TrianglePlanes& triangles, double tolerance);

  // How many of a triangle's corners, and of the anchors that share a triangle
  // with one of them, lie on a plane. A plane without a normal has no votes.
  int Count(int triangle, const Plane& plane) const;

 private:
  const TrianglePlanes& triangles_;
  const float tolerance_;
  // By triangle; indices of anchors.
  std::vector<std::vector<int>> around_;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_ANCHOR_VOTES_H_
