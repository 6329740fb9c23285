#ifndef TAPA_SRC_MVS_SWEEP_LINE_H_
#define TAPA_SRC_MVS_SWEEP_LINE_H_

#include <cstdint>

#include "src/mvs/sweep/host_device.h"

namespace tapa {

// The directions of sweeps, which follow each other in this order. Lines are
// columns in vertical directions, otherwise rows.
enum class Direction { kDown, kLeft, kUp, kRight };
constexpr int kNumDirections = 4;

// Of the sweep of this number.
TAPA_INLINE Direction DirectionOf(uint32_t sweep) {
  return static_cast<Direction>(sweep % kNumDirections);
}

TAPA_INLINE bool IsVertical(Direction direction) {
  return direction == Direction::kDown || direction == Direction::kUp;
}

// Lines of an image, and pixels of each.
TAPA_INLINE int NumLines(Direction direction, int width, int height) {
  return IsVertical(direction) ? width : height;
}
TAPA_INLINE int LineLength(Direction direction, int width, int height) {
  return IsVertical(direction) ? height : width;
}

// Pixels of a line in the order of the sweep.
struct SweepLine {
  int row;
  int col;
  int row_step;
  int col_step;
  int length;

  TAPA_INLINE int Row(int i) const { return row + i * row_step; }
  TAPA_INLINE int Col(int i) const { return col + i * col_step; }
};

TAPA_INLINE SweepLine LineOf(Direction direction, int index, int width,
                             int height) {
  switch (direction) {
    case Direction::kDown:
      return {0, index, 1, 0, height};
    case Direction::kLeft:
      return {index, width - 1, 0, -1, width};
    case Direction::kUp:
      return {height - 1, index, -1, 0, height};
    case Direction::kRight:
      break;
  }
  return {index, 0, 0, 1, width};
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_LINE_H_
