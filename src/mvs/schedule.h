#ifndef TAPA_SRC_MVS_SCHEDULE_H_
#define TAPA_SRC_MVS_SCHEDULE_H_

#include "src/mvs/options.h"
#include "src/mvs/sweep/sweep_params.h"

namespace tapa {

// The sweeps of an estimation: iterations of four, one in each direction.
// Random changes shrink by half in every iteration, and trust in the previous
// selection of views grows linearly from 0.
class Schedule {
 public:
  static constexpr int kSweepsPerIteration = kNumDirections;

  // has_start: whether the estimation starts from given maps, which then have
  // to be beaten (SearchOptions::hysteresis).
  Schedule(const Options& options, int num_sources, bool has_start);

  int num_sweeps() const { return num_iterations_ * kSweepsPerIteration; }

  // What sweep `index` does, 0 to num_sweeps() - 1.
  SweepParams At(int index) const;

  // Whether the last sweep looks for consistent views, which the result then
  // names (Estimate::consistent): for COLMAP's filter or for TAPA.
  static bool ChecksConsistency(const Options& options) {
    return options.filter || options.tapa.enabled;
  }

 private:
  const int num_iterations_;
  const bool has_start_;
  const double first_perturbation_;
  const bool checks_consistency_;
  // What all sweeps have in common.
  SweepParams common_;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SCHEDULE_H_
