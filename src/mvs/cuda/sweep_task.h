#ifndef TAPA_SRC_MVS_CUDA_SWEEP_TASK_H_
#define TAPA_SRC_MVS_CUDA_SWEEP_TASK_H_

#include <cstddef>
#include <cstdint>

#include "src/mvs/cuda/layout.h"
#include "src/mvs/cuda/packed_plane.h"
#include "src/mvs/sweep/scene_plane.h"
#include "src/mvs/sweep/sweep_params.h"

namespace tapa {

// Pixels of a line in the order of a sweep.
struct SweepLine {
  int row;
  int col;
  int row_step;
  int col_step;
  int length;

  TAPA_INLINE int Row(int i) const { return row + i * row_step; }
  TAPA_INLINE int Col(int i) const { return col + i * col_step; }
};

// direction: 0 to 3 for down, left, up, right. Lines are columns in vertical
// directions, otherwise rows.
TAPA_INLINE SweepLine LineOf(int direction, int index, int width, int height) {
  switch (direction) {
    case 0:
      return {0, index, 1, 0, height};
    case 1:
      return {index, width - 1, 0, -1, width};
    case 2:
      return {height - 1, index, -1, 0, height};
    default:
      return {index, 0, 0, 1, width};
  }
}

// Textureness (0 to 1) in 16 bits such that one half, at which the weights of
// all hypotheses are the same number, comes back exactly.
constexpr float kTexturenessScale = 65534.0f;
TAPA_INLINE uint16_t EncodeTextureness(float t) {
  return static_cast<uint16_t>(
      static_cast<int32_t>(t * kTexturenessScale + 0.5f));
}
TAPA_INLINE float DecodeTextureness(uint16_t code) {
  // A product: GPUs divide without rounding exactly.
  constexpr float kInverse = 1.0f / kTexturenessScale;
  return static_cast<float>(static_cast<int32_t>(code)) * kInverse;
}

// A PlaneSet in device memory. index == nullptr: no pixel tries any plane.
struct PlaneTable {
  const ScenePlane* planes = nullptr;
  const uint16_t* index = nullptr;
};

// Everything that kernels read and write; pointers are those of the device.
// Values of a pixel for all n views lie side by side, as on the CPU, so that
// columns and rows are swept alike and nothing is rotated.
struct SweepTask {
  int width = 0;
  int height = 0;
  int num_views = 0;
  // Whether this is the geometric pass, as in the parameters of all its sweeps.
  bool geometric = false;
  WindowShape window;
  RefCamera camera;
  // The coefficients of SourceCameras, n of each.
  const float* cameras = nullptr;

  PackedPlane* planes = nullptr;
  // As in SweepState, at [pixel * n + m]. In the last sweep, the one with the
  // filter, a cost is not needed any more once its pixel is done: the pixel's
  // place then holds its bits of Estimate::consistent, and in the byte after
  // them its Estimate::chosen. That saves an allocation.
  uint16_t* cost = nullptr;
  uint16_t* prob = nullptr;

  // See SweepGuide. nullptr: costs are not weighted.
  const uint16_t* textureness = nullptr;
  float weight_range = 0;
  float depth_min = 0;
  float depth_max = 0;
  PlaneTable fine;
  PlaneTable coarse;

  SweepParams params;
  // Lines are swept in pieces of this many pixels, so that launches can be
  // short and that the backward messages of a piece are all that has to be
  // kept.
  int piece_length = 0;
  // At [(piece * lines + line) * n + m]: the message to the last pixel of the
  // piece from the pixel after it. Not set for a line's last piece.
  float* checkpoints = nullptr;
  // Messages of a piece, at [(line * piece_length + i) * n + m].
  float* backward = nullptr;
  // What a line's next piece goes on with: forward messages at [line * n + m],
  // and the plane chosen last, which is not rounded as that in the map is.
  float* forward = nullptr;
  Plane* previous = nullptr;

  TAPA_INLINE int Direction() const { return params.index % 4; }
  TAPA_INLINE int NumLines() const {
    return Direction() % 2 == 0 ? width : height;
  }
  TAPA_INLINE int LineLength() const {
    return Direction() % 2 == 0 ? height : width;
  }
  TAPA_INLINE int NumPieces() const {
    return (LineLength() + piece_length - 1) / piece_length;
  }
  TAPA_INLINE size_t Pixel(int row, int col) const {
    return static_cast<size_t>(row) * width + col;
  }
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CUDA_SWEEP_TASK_H_
