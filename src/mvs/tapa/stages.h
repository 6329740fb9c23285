#ifndef TAPA_SRC_MVS_TAPA_STAGES_H_
#define TAPA_SRC_MVS_TAPA_STAGES_H_

#include <utility>

#include "src/mvs/backend.h"
#include "src/mvs/control.h"
#include "src/mvs/options.h"
#include "src/mvs/problem.h"
#include "src/mvs/tapa/completion.h"
#include "src/mvs/tapa/speckles.h"
#include "src/mvs/tapa/superpixel_planes.h"
#include "src/mvs/tapa/superpixels.h"

namespace tapa {

// What TAPA did with one view, for pictures and tests.
struct TapaRecord {
  Map<float> textureness;
  // Without superpixels where that part is off.
  Segmentation fine;
  Segmentation coarse;
  // Hypothesis (sweep/hypotheses.h) that each pixel chose in the last sweep;
  // kNumHypotheses where masked.
  Map<uint8_t> chosen;
  // Depth after the last sweep.
  Map<float> swept_depth;
  // The same without what no source view is consistent with and without
  // speckles; empty where refinement is off.
  Map<float> filtered_depth;
  // How much the estimates nearby speak for the best plane (completion.h);
  // empty where completion is off.
  Map<float> agreement;
  // One Origin per pixel; empty where refinement is off.
  Map<uint8_t> origin;
};

// The stages of TAPA, which the schedule of the estimation calls at its points.
// `problem` and `control` must outlive the object.
class TapaStages {
 public:
  // Once control.stopped() said so, the stages end early, with results that
  // make no sense.
  TapaStages(const Options& options, const Problem& problem,
             const Control& control);

  // Before the first sweep: weights and, if it starts from given maps, planes.
  void Begin(bool has_start, Backend* backend);

  // Between two iterations: planes fitted to the estimate.
  void ProposePlanes(int iteration, Backend* backend);

  // After the last sweep, in place of the filter.
  void Refine(Estimate* estimate);

  TapaRecord TakeRecord() { return std::move(record_); }

 private:
  PlaneSet FitAndDraw(const Map<float>& depth, int iteration, uint64_t stream,
                      Segmentation* segmentation) const;
  void KeepConsistent(int min_num_consistent, const Estimate& estimate,
                      Map<float>* depth) const;
  Map<float> AddSightings(const Map<float>& trusted,
                          const Map<float>& depth) const;
  void Complete(const Map<float>& evidence, const Map<float>& trusted,
                Estimate* estimate);
  void Fill(Estimate* estimate) const;
  void FollowColors(Estimate* estimate);
  void NoteOrigin(Origin origin, const Map<float>& depth);
  void ClearOthers(Estimate* estimate) const;
  int MaxSpeckleSize() const;
  Continuity SpeckleContinuity() const;

  const Options options_;
  const Problem& problem_;
  const Control& control_;
  const RefCamera camera_;
  TapaRecord record_;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_STAGES_H_
