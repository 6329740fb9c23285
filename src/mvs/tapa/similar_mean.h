#ifndef TAPA_SRC_MVS_TAPA_SIMILAR_MEAN_H_
#define TAPA_SRC_MVS_TAPA_SIMILAR_MEAN_H_

#include <cstdint>

#include "src/base/map.h"

namespace tapa {

// The mean of values over the pixels around each pixel, those that look like it
// first: what the guided filter of OpenCV (He, Sun and Tang, "Guided Image
// Filtering", PAMI 2013) makes of `values`, divided by what it makes of
// `weights`. So a mean spreads over an even surface and ends at the edges of
// the image. weights: 1 where a value counts, 0 where it does not, and where it
// has to be 0 itself. Where hardly any around count, the value stays.
// radius: half size of the filter's squares, in pixels. variance: of
// intensities (0 to 1), above which an image has edges.
Map<float> MeanOverSimilarPixels(const Map<uint8_t>& image,
                                 const Map<float>& values,
                                 const Map<float>& weights, int radius,
                                 double variance);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_SIMILAR_MEAN_H_
