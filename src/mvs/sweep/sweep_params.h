#ifndef TAPA_SRC_MVS_SWEEP_SWEEP_PARAMS_H_
#define TAPA_SRC_MVS_SWEEP_SWEEP_PARAMS_H_

#include <cstdint>

#include "src/mvs/sweep/line.h"
#include "src/mvs/sweep/view_prior.h"
#include "src/mvs/sweep/view_selection.h"

namespace tapa {

// Parameters of one sweep.
struct SweepParams {
  // Number of the sweep since the estimation began, which says its direction
  // and keys the random numbers.
  uint32_t index = 0;
  uint64_t seed = 0;
  // Relative size of the random changes, at most 1, and that of a pixel whose
  // estimate no view supports.
  float perturbation = 1;
  float lost_perturbation = 1;
  // Weight of the selection probability of the sweep before, 0 to 1.
  float prev_prob_weight = 0;
  int num_samples = 3;
  // As in SearchOptions.
  bool try_all = false;
  float random_share = 1;
  // Whether this sweep tries the planes of superpixels.
  bool try_planes = true;
  bool measure_all = false;
  // By how much the cost per drawn view must fall before an estimate without
  // any texture is given up, see Hysteresis.
  float hysteresis = 0;
  // Half size of the correlation window, in pixels.
  float window_radius = 5;
  ViewSelection selection;
  ViewPrior prior;

  // The geometric pass.
  bool geometric = false;
  float geom_weight = 0.3f;
  float geom_max_cost = 3;

  // The last sweep: which views are consistent with the estimates is looked
  // for, and estimates with fewer than filter_min_num_consistent are removed.
  bool check_consistency = false;
  float filter_min_prob = 0;
  float filter_cos_min_triangulation = 1;
  float filter_geom_max_cost = 1;
  int filter_min_num_consistent = 2;

  // Whether views that were not drawn for a pixel count there, too.
  TAPA_INLINE bool NeedsAllViews() const {
    return measure_all || check_consistency;
  }
  TAPA_INLINE Direction SweepDirection() const { return DirectionOf(index); }
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_SWEEP_PARAMS_H_
