#include "src/mvs/schedule.h"

#include <algorithm>
#include <cmath>

#include "src/base/angle.h"

namespace tapa {

Schedule::Schedule(const Options& options, int num_sources, bool has_start)
    : num_iterations_(options.num_iterations),
      has_start_(has_start),
      first_perturbation_(options.first_perturbation),
      checks_consistency_(ChecksConsistency(options)) {
  common_.seed = options.seed;
  common_.num_samples = options.num_samples;
  common_.try_all = options.search.try_all;
  // From random estimates little is known of which views see a pixel.
  common_.measure_all = options.search.measure_all || !has_start;
  if (has_start) {
    common_.random_share = static_cast<float>(options.search.random_share);
    common_.hysteresis = static_cast<float>(options.search.hysteresis);
  }
  common_.window_radius = static_cast<float>(options.window_radius);
  common_.selection = ViewSelection::FromSigma(options.ncc_sigma);
  common_.prior = ViewPrior::FromAngles(options.min_triangulation_angle,
                                        options.incident_angle_sigma);
  common_.geometric = options.geom_consistency;
  common_.geom_weight =
      static_cast<float>(options.geom_consistency_regularizer);
  common_.geom_max_cost = static_cast<float>(options.geom_consistency_max_cost);
  common_.filter_min_prob = common_.selection.Emission(
      static_cast<float>(1.0 - options.filter_min_ncc));
  common_.filter_cos_min_triangulation = static_cast<float>(
      std::cos(DegToRad(options.filter_min_triangulation_angle)));
  common_.filter_geom_max_cost =
      static_cast<float>(options.filter_geom_consistency_max_cost);
  common_.filter_min_num_consistent =
      std::min(options.filter_min_num_consistent, num_sources);
  // TAPA decides itself what becomes of estimates, by their consistent views;
  // patches without texture have no photometric evidence, so it does not count.
  if (options.tapa.enabled) {
    common_.filter_min_num_consistent = 0;
    if (options.geom_consistency) {
      common_.filter_min_prob = 0;
    }
  }
}

SweepParams Schedule::At(int index) const {
  const int iteration = index / kSweepsPerIteration;
  const int sweep = index % kSweepsPerIteration;
  SweepParams params = common_;
  params.index = index;
  const double shrinkage =
      std::pow(2.0, -(iteration + sweep / double{kSweepsPerIteration}));
  params.perturbation = static_cast<float>(first_perturbation_ * shrinkage);
  params.lost_perturbation = static_cast<float>(shrinkage);
  params.prev_prob_weight = static_cast<float>(index) / num_sweeps();
  // Planes stay the same in an iteration: what lost to a pixel's estimate hardly
  // ever wins in the next sweep.
  params.try_planes = common_.try_all || !has_start_ || sweep % 2 == 1;
  params.check_consistency = checks_consistency_ && index + 1 == num_sweeps();
  return params;
}

}  // namespace tapa
