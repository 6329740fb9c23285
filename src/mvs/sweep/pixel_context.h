#ifndef TAPA_SRC_MVS_SWEEP_PIXEL_CONTEXT_H_
#define TAPA_SRC_MVS_SWEEP_PIXEL_CONTEXT_H_

#include "src/mvs/sweep/depth_normal.h"
#include "src/mvs/sweep/guide.h"
#include "src/mvs/sweep/pixel_scratch.h"
#include "src/mvs/sweep/random.h"
#include "src/mvs/sweep/source_cameras.h"
#include "src/mvs/sweep/sweep_params.h"

namespace tapa {

// A pixel of the reference image in a sweep: what is known of it, and memory to
// work in.
struct PixelContext {
  const SweepParams& params;
  const RefCamera& camera;
  const SourceCameras& views;
  const PixelScratch& scratch;
  float row;
  float col;
  Vec3 ray;
  // Draws of this pixel in this sweep.
  Random random;
  // Its estimate so far.
  DepthNormal current;
  PixelGuide guide;
};

// The pixel before on the sweep's line, with the estimate that it got, before
// filtering.
struct PreviousPixel {
  DepthNormal estimate;
  Vec3 ray;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_PIXEL_CONTEXT_H_
