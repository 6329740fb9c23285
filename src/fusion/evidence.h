#ifndef TAPA_SRC_FUSION_EVIDENCE_H_
#define TAPA_SRC_FUSION_EVIDENCE_H_

#include <cstdint>

#include "src/base/map.h"
#include "src/base/vec3.h"
#include "src/fusion/options.h"
#include "src/fusion/surface_map.h"
#include "src/fusion/view_pair.h"
#include "src/mvs/view.h"

namespace tapa {

// What other views say of the pixels of one. Neighbours are numbered from 0 in
// the order in which they are asked, at most 64.
struct ViewEvidence {
  ViewEvidence(int width, int height);

  // Sums over the views that agree, of their agreement; of agreement times
  // precision; and with that as weight.
  Map<float> agreement;
  Map<float> precision;
  Map<float> depth_offset;
  Map<Vec3> normal;
  // Number of views that see through the point.
  Map<uint8_t> doubt;
  // Bit n: neighbour n sees the point; its pixel shows no other one.
  Map<uint64_t> visible;
  Map<uint64_t> same;
};

// Asks one neighbour about the rows [begin, end). Rows are independent.
void AskNeighbor(const ViewPair& pair, const SurfaceMap& view,
                 const SurfaceMap& other, int number, int begin, int end,
                 ViewEvidence* evidence);

// Agreement less doubt of each pixel, in views, between -3 and 3, for the rows
// [begin, end).
void WeighEvidence(const ViewEvidence& evidence, double doubt, int begin,
                   int end, Map<float>* weight);

// To the weight of each pixel in the rows [begin, end) adds the mean over
// pixels around it that lie on the same surface: in its tangential plane, with
// similar normals. radius: how far they are looked for, in pixels, in 7 x 7
// places. A flat wall that is confirmed in part is confirmed as a whole.
void SpreadEvidence(const Camera& camera, const SurfaceMap& view, int radius,
                    const Map<float>& weight, int begin, int end,
                    Map<float>* spread);

}  // namespace tapa

#endif  // TAPA_SRC_FUSION_EVIDENCE_H_
