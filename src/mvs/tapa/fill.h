#ifndef TAPA_SRC_MVS_TAPA_FILL_H_
#define TAPA_SRC_MVS_TAPA_FILL_H_

#include <cstdint>

#include "src/base/map.h"
#include "src/mvs/sweep/depth_normal.h"

namespace tapa {

struct FillOptions {
  // Half size of the window, in pixels.
  int radius = 5;
  // How often to repeat; pixels filled in one round serve the next.
  int num_rounds = 1;
  // Share of the whole window's pixels that the fullest bin has to hold.
  double min_share = 0;
  // Pixels that stay as they are, as in Problem::mask; not there: none.
  // Borrowed.
  const Map<uint8_t>* mask = nullptr;
  // Standard deviations of the weights: over distance in pixels, and over
  // difference in intensity (0 to 1).
  float sigma_spatial = 5;
  float sigma_color = 0.2f;
};

// Fills missing estimates (depth 0) from those around them (TAPA-MVS, section
// 5): the depths in the window make a histogram of three bins between the
// smallest and the largest; depth and normal become the bilaterally weighted
// mean of the pixels in the fullest bin (of equally full ones the nearest to
// the camera). This approximates a weighted median and keeps discontinuities. A
// pixel with no estimate in its window, or whose mean normal would face away
// from the camera, stays as it is.
void FillMissing(const FillOptions& options, const RefCamera& camera,
                 const Map<uint8_t>& image, Map<float>* depth,
                 Map<Vec3>* normal);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_FILL_H_
