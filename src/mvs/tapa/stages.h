#ifndef TAPA_SRC_MVS_TAPA_STAGES_H_
#define TAPA_SRC_MVS_TAPA_STAGES_H_

#include <vector>

#include "src/mvs/backend.h"
#include "src/mvs/estimate_depth.h"
#include "src/mvs/tapa/speckles.h"
#include "src/mvs/tapa/superpixel_planes.h"
#include "src/mvs/tapa/superpixels.h"

namespace tapa {

// A segmentation with the planes last fitted to it.
struct Segmentation {
  Superpixels superpixels;
  std::vector<FittedPlane> planes;
};

// What TAPA did with one view, for pictures and tests.
struct TapaRecord {
  Map<float> textureness;
  // Without superpixels where that part is off.
  Segmentation fine;
  Segmentation coarse;
  // Hypothesis (sweep.h) that each pixel chose in the last sweep.
  Map<uint8_t> chosen;
  // Depth after the last sweep, and without speckles.
  Map<float> swept_depth;
  Map<float> filtered_depth;
};

// The stages of TAPA, which the schedule of the estimation calls at its points.
// `problem` must outlive the object.
class TapaStages {
 public:
  TapaStages(const Options& options, const Problem& problem);

  // Before the first sweep: weights, and in the geometric pass planes.
  void Begin(Backend* backend);

  // Between two iterations: planes fitted to the estimate.
  void ProposePlanes(int iteration, Backend* backend);

  // After the last sweep, in place of the filter.
  void Refine(Estimate* estimate);

  TapaRecord TakeRecord() { return std::move(record_); }

 private:
  PlaneSet FitAndDraw(const Map<float>& depth, int iteration, uint64_t stream,
                      Segmentation* segmentation) const;
  int MaxSpeckleSize() const;
  Continuity SpeckleContinuity() const;

  const Options options_;
  const Problem& problem_;
  const RefCamera camera_;
  TapaRecord record_;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_STAGES_H_
