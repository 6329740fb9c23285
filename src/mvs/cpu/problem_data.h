#ifndef TAPA_SRC_MVS_CPU_PROBLEM_DATA_H_
#define TAPA_SRC_MVS_CPU_PROBLEM_DATA_H_

#include <vector>

#include "src/base/uninitialized_vector.h"
#include "src/mvs/camera_table.h"
#include "src/mvs/cpu/source_image.h"
#include "src/mvs/cpu/window.h"
#include "src/mvs/options.h"
#include "src/mvs/plane_set.h"
#include "src/mvs/problem.h"
#include "src/mvs/sweep/guide.h"

namespace tapa {

// A depth map of somebody else's, so that a look at a pixel is one at memory.
struct DepthView {
  const float* data;
  int width;
  int height;
};

// What the CPU reads in a sweep and never changes: images and cameras in the
// layout that sweeps want.
struct ProblemData {
  ProblemData(const Options& options, const Problem& problem);

  size_t NumPixels() const { return static_cast<size_t>(width) * height; }
  size_t Pixel(int row, int col) const {
    return static_cast<size_t>(row) * width + col;
  }

  int width;
  int height;
  int num_sources;
  Window window;
  RefImage reference;
  CameraTable cameras;
  std::vector<SourceImage> sources;
  // Source depth maps; empty in the photometric pass.
  std::vector<DepthView> source_depths;
};

// What sweeps change, for every pixel in row-major order. Values of one pixel
// for all views lie side by side, so that vertical and horizontal sweeps read
// whole cache lines alike.
struct SweepState {
  // Leaves the estimate empty, and costs and probabilities undefined until
  // ComputeCosts.
  // with_mask: with `consistent`.
  SweepState(const ProblemData& data, bool with_mask);

  DepthNormal At(size_t pixel) const {
    return {depth.data()[pixel], normal.data()[pixel]};
  }
  // As in Backend::SetEstimate; of a pixel that is yet to be swept.
  bool IsMasked(size_t pixel) const { return depth.data()[pixel] == 0; }

  Map<float> depth;
  Map<Vec3> normal;
  // Photometric cost and selection probability at [pixel * sources + m], in the
  // fixed point of view_selection.h.
  UninitializedVector<uint16_t> cost;
  UninitializedVector<uint16_t> prob;
  // As in Estimate::consistent.
  std::vector<uint8_t> consistent;
  // The hypothesis that each pixel chose last; empty: not kept.
  Map<uint8_t> chosen;
};

// What comes to sweeps from outside and changes between them.
struct GuideMaps {
  // Empty: costs are not weighted.
  Map<float> textureness;
  // As in SweepGuide.
  float weight_range = 0;
  float depth_min = 0;
  float depth_max = 0;
  PlaneSet fine;
  PlaneSet coarse;
  // Empty: none.
  Map<PackedDepthNormal> depth_prior;

  // Points into these maps.
  SweepGuide<float> Guide() const {
    return {textureness.empty() ? nullptr : textureness.data(),
            weight_range,
            depth_min,
            depth_max,
            fine.Table(),
            coarse.Table(),
            depth_prior.empty() ? nullptr : depth_prior.data()};
  }
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CPU_PROBLEM_DATA_H_
