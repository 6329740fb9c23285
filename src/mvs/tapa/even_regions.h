#ifndef TAPA_SRC_MVS_TAPA_EVEN_REGIONS_H_
#define TAPA_SRC_MVS_TAPA_EVEN_REGIONS_H_

#include <cstdint>

#include "src/base/map.h"

// Beyond TAPA-MVS: which pixels have one colour, whose edges need not be in any
// superpixel.

namespace tapa {

// How high a step in colour there is at each pixel, in grey levels of the
// channel that changes most: the gradient of the photograph, smoothed by a
// Gaussian of two pixels, over that of a step of one grey level. Noise with a
// standard deviation of one grey level makes steps of 0.4.
Map<float> MeasureSteps(const Map<Rgb>& color);

// Connected pixels without an edge between them.
struct EvenRegions {
  static constexpr int32_t kNone = 0;

  // 1 to count, and kNone.
  Map<int32_t> labels;
  int count = 0;
};

// The regions (4-connected) of pixels with a textureness below 0.5 and a step
// below max_step, up to 8 pixels beyond what is left of them two pixels away
// from all others: narrow bridges do not connect. Regions of less than 1/500 of
// the image are none. steps and textureness have the same size.
EvenRegions FindEvenRegions(const Map<float>& steps,
                            const Map<float>& textureness, float max_step);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_EVEN_REGIONS_H_
