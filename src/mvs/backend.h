#ifndef TAPA_SRC_MVS_BACKEND_H_
#define TAPA_SRC_MVS_BACKEND_H_

#include "src/base/progress.h"
#include "src/mvs/plane_set.h"
#include "src/mvs/problem.h"
#include "src/mvs/sweep/sweep_params.h"

namespace tapa {

// Who holds the state of an estimation and runs its sweeps. EstimateDepth calls
// it in this order: SetEstimate, then sweeps, between
// which the estimate may be read and replaced, then TakeResult.
//
// Functions that take long call `progress` now and then and return false soon
// after it did.
class Backend {
 public:
  virtual ~Backend() = default;

  // Replaces the estimate of every pixel and computes its costs. Pixels of
  // depth 0, whose normal is 0, too, are masked: sweeps leave them alone and
  // take them for the border of the image. All others have an estimate until
  // the last sweep, which may filter it.
  virtual bool SetEstimate(Map<float> depth, Map<Vec3> normal,
                           const ProgressCallback& progress) = 0;

  // One sweep, see schedule.h.
  virtual bool Sweep(const SweepParams& params,
                     const ProgressCallback& progress) = 0;

  // Weighs costs by the textureness of every pixel from now on, see
  // sweep/texture_weights.h.
  virtual void SetTextureness(Map<float> textureness) = 0;

  // Gives sweeps a further hypothesis of every pixel, within the problem's
  // range of depths, from now on. Only if the problem has a prior.
  virtual void SetDepthPrior(Map<PackedDepthNormal> prior) = 0;

  // Gives sweeps further hypotheses, until the next call.
  virtual void SetPlanes(PlaneSet fine, PlaneSet coarse) = 0;

  // The estimate as it is between two sweeps. Valid until the next call of
  // another function.
  virtual const Map<float>& Depth() = 0;
  virtual const Map<Vec3>& Normal() = 0;

  // Moves the result out; the backend cannot be used any more.
  virtual Estimate TakeResult() = 0;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_BACKEND_H_
