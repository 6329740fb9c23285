#ifndef TAPA_SRC_MVS_PROBLEM_H_
#define TAPA_SRC_MVS_PROBLEM_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/base/map.h"
#include "src/base/uninitialized_vector.h"
#include "src/base/vec3.h"
#include "src/mvs/view.h"

namespace tapa {

// One reference view and the source views that its pixels are compared with.
struct Problem {
  View reference;
  // At least one. Views may differ in size and camera.
  std::vector<View> sources;
  // Range of the first random depths, in scene units: 0 < min <= max.
  float depth_min = 0;
  float depth_max = 0;
  // The reference photograph in colour, of the same size as its grey image,
  // for TAPA's superpixels, silhouettes and regions; not there: they see the
  // grey image. Borrowed.
  const Map<Rgb>* reference_color = nullptr;
  // Where the estimation starts: depth in scene units and unit normals in the
  // reference camera's frame, both of the reference image's size. Pixels
  // without a depth (IsDepth) or whose normal faces away from the camera start
  // at random. A photometric pass without them starts at random altogether.
  Map<float> depth;
  Map<Vec3> normal;
  // Depth of the reference view from elsewhere, in scene units, of any size;
  // what is no depth (IsDepth) is not known. It is tried as a hypothesis of
  // every pixel. Empty: there is none.
  Map<float> prior;
  // Pixels of the reference image to leave alone, where it is not 0: they get
  // no estimate, cost no time and lend nothing to others. Of the image's size,
  // or empty: there are none. What source views show is not masked.
  Map<uint8_t> mask;

  // pixel: row * width + col.
  bool IsMasked(size_t pixel) const {
    return !mask.empty() && mask.data()[pixel] != 0;
  }
};

// The result: what is known of every pixel of the reference view.
struct Estimate {
  // Depth in scene units, 0 where the estimate was filtered or is masked.
  Map<float> depth;
  // Unit normals in the reference camera's frame, 0 where there is no depth.
  Map<Vec3> normal;
  // Probability that source view m sees a pixel, 0 to 1, at
  // [pixel * sources + m], in fixed point: value / 65535. 0 where masked.
  UninitializedVector<uint16_t> selection_prob;
  // With Options::filter or TAPA: which source views are consistent with the
  // estimate, ConsistencyMaskBytes per pixel (sweep/consistency_mask.h). TAPA's
  // geometric pass looks at depths and angles only, not at selection
  // probabilities.
  std::vector<uint8_t> consistent;
  // With TAPA: the hypothesis (sweep/hypotheses.h) that each pixel chose last.
  Map<uint8_t> chosen;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_PROBLEM_H_
