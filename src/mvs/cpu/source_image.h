#ifndef TAPA_SRC_MVS_CPU_SOURCE_IMAGE_H_
#define TAPA_SRC_MVS_CPU_SOURCE_IMAGE_H_

#include <cstdint>

#include "src/base/map.h"
#include "src/mvs/cpu/aligned.h"

namespace tapa {

// Source image in the layout that bilinear sampling wants: every element holds
// a pixel and the one below it, so that one 32-bit load at (row, col) brings
// the four neighbours
//
//   byte 0: (row, col)   byte 1: (row + 1, col)
//   byte 2: (row, col+1) byte 3: (row + 1, col + 1).
//
// A black border of one pixel surrounds the image, so `row` and `col` count
// from 0 at pixel (-1, -1) up to height and width of the image, inclusive.
// Needs two bytes per pixel.
class SourceImage {
 public:
  explicit SourceImage(const Map<uint8_t>& image);

  const uint16_t* data() const { return pairs_.get(); }
  // Elements from one row to the next.
  int stride() const { return width_ + 3; }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  int width_;
  int height_;
  hwy::AlignedFreeUniquePtr<uint16_t[]> pairs_;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CPU_SOURCE_IMAGE_H_
