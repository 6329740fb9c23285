#ifndef TAPA_SRC_MVS_CUDA_SWEEP_TASK_H_
#define TAPA_SRC_MVS_CUDA_SWEEP_TASK_H_

#include <cstddef>
#include <cstdint>

#include "src/mvs/cuda/layout.h"
#include "src/mvs/sweep/guide.h"
#include "src/mvs/sweep/line.h"
#include "src/mvs/sweep/packed_depth_normal.h"
#include "src/mvs/sweep/sweep_params.h"

namespace tapa {

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

  PackedDepthNormal* estimates = nullptr;
  // Whether there are masked pixels, so that others need not ask.
  bool has_masked = false;
  // As in SweepState, at [pixel * n + m]. In the sweep that checks consistency,
  // the last one, a cost is not needed any more once its pixel is done: the
  // pixel's place then holds its bits of Estimate::consistent, and in the byte
  // after them its Estimate::chosen. That saves an allocation. Of a masked
  // pixel all is 0 from the start.
  uint16_t* cost = nullptr;
  uint16_t* prob = nullptr;

  SweepGuide<uint16_t> guide;

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
  // and the estimate chosen last, which is not rounded as that in the map is.
  float* forward = nullptr;
  DepthNormal* previous = nullptr;

  TAPA_INLINE SweepLine Line(int index) const {
    return LineOf(params.SweepDirection(), index, width, height);
  }
  TAPA_INLINE int NumLines() const {
    return tapa::NumLines(params.SweepDirection(), width, height);
  }
  TAPA_INLINE int LineLength() const {
    return tapa::LineLength(params.SweepDirection(), width, height);
  }
  TAPA_INLINE int NumPieces() const {
    return (LineLength() + piece_length - 1) / piece_length;
  }
  TAPA_INLINE size_t Pixel(int row, int col) const {
    return static_cast<size_t>(row) * width + col;
  }
  // As in Backend::SetEstimate; of a pixel that is yet to be swept.
  TAPA_INLINE bool IsMasked(size_t pixel) const {
    return has_masked && estimates[pixel].depth == 0.0f;
  }
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CUDA_SWEEP_TASK_H_
