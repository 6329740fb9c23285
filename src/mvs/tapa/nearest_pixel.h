#ifndef TAPA_SRC_MVS_TAPA_NEAREST_PIXEL_H_
#define TAPA_SRC_MVS_TAPA_NEAREST_PIXEL_H_

#include "src/mvs/sweep/geometric_cost.h"

namespace tapa {

// Finds the pixel of an image that a place lies in; false where that is outside
// of the image or no number.
inline bool FindNearestPixel(const Projection& place, int width, int height,
                             int* row, int* col) {
  if (!(place.col > -0.5f && place.row > -0.5f && place.col < width - 0.5f &&
        place.row < height - 0.5f)) {
    return false;
  }
  *row = static_cast<int>(place.row + 0.5f);
  *col = static_cast<int>(place.col + 0.5f);
  return true;
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_NEAREST_PIXEL_H_
