#ifndef TAPA_SRC_MVS_SWEEP_PIXEL_SCRATCH_H_
#define TAPA_SRC_MVS_SWEEP_PIXEL_SCRATCH_H_

#include "src/mvs/sweep/depth_normal.h"
#include "src/mvs/sweep/geometric_cost.h"

namespace tapa {

// Number of random numbers that DrawViews makes at a time.
constexpr int kDrawBlock = 32;

// Working memory for one pixel: arrays over the views, padded as in
// SourceCameras, if nothing else is said.
struct PixelScratch {
  // In and out: photometric cost of the pixel's estimate in every view.
  float* cost;
  // In: selection probability from the sweep before. Out: the new one.
  float* prob;
  // In: forward message (odds) of the pixel before. Out: this pixel's.
  float* forward;
  // In: backward message (odds).
  const float* backward;

  // Cumulative distribution of the sampled views.
  float* cdf;
  // How often each one was drawn.
  float* num_drawn;
  // The views that were drawn, those drawn most often first, of equal ones the
  // first; then, if SweepParams::NeedsAllViews, the others.
  int* order;
  // kDrawBlock random numbers.
  float* uniform;

  // Of each hypothesis: depth and normal, its HomographyVector, and the cost
  // that is added up so far.
  DepthNormal* hypothesis;
  Vec3* homography;
  float* sum;
  // Elements between the arrays of two hypotheses below.
  int stride;
  // Photometric costs at [hypothesis * stride + view], where measured. Not of
  // kCurrent: they are in `cost`.
  float* hypothesis_cost;
  // Geometric costs of the distinct depths at [DepthIndex * stride + view].
  float* geom_cost;
  Projection* projection;
  float* source_depth;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_PIXEL_SCRATCH_H_
