#ifndef TAPA_SRC_MVS_BACKEND_H_
#define TAPA_SRC_MVS_BACKEND_H_

#include <cstdint>
#include <vector>

#include "src/base/progress.h"
#include "src/mvs/plane_set.h"
#include "src/mvs/problem.h"
#include "src/mvs/sweep/sweep_params.h"

namespace tapa {

// Who holds the state of an estimation and runs its sweeps. The schedule in
// estimate_depth.cc calls it in this order: SetEstimate, then sweeps, between
// which the estimate may be read and replaced, then TakeResult.
//
// Functions that take long call `progress` now and then and return false soon
// after it did.
class Backend {
 public:
  virtual ~Backend() = default;

  // Replaces the estimate of every pixel and computes its costs.
  virtual bool SetEstimate(Map<float> depth, Map<Vec3> normal,
                           const ProgressCallback& progress) = 0;

  // One sweep; params.index % 4 is its direction: down, left, up, right.
  virtual bool Sweep(const SweepParams& params,
                     const ProgressCallback& progress) = 0;

  // Weighs costs by the textureness of every pixel from now on, see
  // sweep/texture_weights.h.
  virtual void SetTextureness(Map<float> textureness) = 0;

  // Gives sweeps further hypotheses, until the next call.
  virtual void SetPlanes(PlaneSet fine, PlaneSet coarse) = 0;

  // The estimate as it is between two sweeps. Valid until the next call of
  // another function.
  virtual const Map<float>& Depth() = 0;
  virtual const Map<Vec3>& Normal() = 0;

  // Costs of the estimates as they are between two sweeps, in fixed point
  // (EncodeCost), at [pixel * number of views + view]. For tests. Gone after a
  // sweep with the filter.
  virtual std::vector<uint16_t> Costs() const = 0;

  // Moves the result out; the backend cannot be used any more.
  virtual Estimate TakeResult() = 0;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_BACKEND_H_
