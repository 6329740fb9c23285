#include "src/mvs/options.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace tapa {
namespace {

template <typename T>
void CheckRange(const char* name, T value, bool valid, const char* range) {
  if (!valid) {
    std::ostringstream message;
    message << name << " is " << value << ", but must be " << range;
    throw std::invalid_argument(message.str());
  }
}

}  // namespace

// TAPA's fields are called by the names that they have on the command line.
#define TAPA_CHECK_FIELD(name, condition, range) \
  CheckRange("tapa_" #name, name, condition, range)

void TapaOptions::Check() const {
  const auto is_share = [](double value) { return value >= 0 && value <= 1; };
  const auto is_finite_positive = [](double value) {
    return value > 0 && std::isfinite(value);
  };
  TAPA_CHECK_FIELD(textureness_variance,
                   is_finite_positive(textureness_variance), "positive");
  TAPA_CHECK_FIELD(min_textureness, min_textureness > 0 && min_textureness <= 1,
                   "above 0 and at most 1");
  TAPA_CHECK_FIELD(weight_range, is_share(weight_range), "from 0 to 1");
  TAPA_CHECK_FIELD(fine_divisor, is_finite_positive(fine_divisor), "positive");
  TAPA_CHECK_FIELD(coarse_divisor, is_finite_positive(coarse_divisor),
                   "positive");
  TAPA_CHECK_FIELD(plane_distance, std::isfinite(plane_distance),
                   "a number (not positive: relative)");
  TAPA_CHECK_FIELD(relative_plane_distance,
                   is_finite_positive(relative_plane_distance), "positive");
  TAPA_CHECK_FIELD(speckle_size, is_share(speckle_size), "from 0 to 1");
  TAPA_CHECK_FIELD(speckle_continuity,
                   speckle_continuity >= 0 && std::isfinite(speckle_continuity),
                   "at least 0");
  TAPA_CHECK_FIELD(fill_radius, fill_radius >= 0 && fill_radius <= 100,
                   "from 0 to 100");
  TAPA_CHECK_FIELD(fill_rounds, fill_rounds >= 0 && fill_rounds <= 1000,
                   "from 0 to 1000");
  TAPA_CHECK_FIELD(completion_agreement, is_share(completion_agreement),
                   "from 0 to 1");
  TAPA_CHECK_FIELD(completion_radius, is_share(completion_radius),
                   "from 0 to 1");
  TAPA_CHECK_FIELD(completion_textureness,
                   completion_textureness >= 0 && completion_textureness <= 2,
                   "from 0 to 2");
  TAPA_CHECK_FIELD(completion_fill_share, is_share(completion_fill_share),
                   "from 0 to 1");
}

#undef TAPA_CHECK_FIELD

#define TAPA_CHECK_OPTION(name, condition, range) \
  CheckRange(#name, name, condition, range)

void Options::Check() const {
  TAPA_CHECK_OPTION(window_radius, window_radius >= 1 && window_radius <= 32,
                    "from 1 to 32");
  TAPA_CHECK_OPTION(window_step, window_step == 1 || window_step == 2,
                    "1 or 2");
  TAPA_CHECK_OPTION(sigma_color, sigma_color > 0, "positive");
  TAPA_CHECK_OPTION(num_samples, num_samples >= 1 && num_samples <= 10000,
                    "from 1 to 10000");
  TAPA_CHECK_OPTION(ncc_sigma, ncc_sigma > 0, "positive");
  TAPA_CHECK_OPTION(
      min_triangulation_angle,
      min_triangulation_angle >= 0 && min_triangulation_angle < 180,
      "from 0 to below 180 degrees");
  TAPA_CHECK_OPTION(incident_angle_sigma, incident_angle_sigma > 0, "positive");
  TAPA_CHECK_OPTION(num_iterations,
                    num_iterations >= 1 && num_iterations <= 1000,
                    "from 1 to 1000");
  TAPA_CHECK_OPTION(geom_consistency_regularizer,
                    geom_consistency_regularizer >= 0, "at least 0");
  TAPA_CHECK_OPTION(geom_consistency_max_cost, geom_consistency_max_cost >= 0,
                    "at least 0");
  TAPA_CHECK_OPTION(filter_min_ncc, filter_min_ncc >= -1 && filter_min_ncc <= 1,
                    "from -1 to 1");
  TAPA_CHECK_OPTION(filter_min_triangulation_angle,
                    filter_min_triangulation_angle >= 0 &&
                        filter_min_triangulation_angle <= 180,
                    "from 0 to 180 degrees");
  TAPA_CHECK_OPTION(filter_geom_consistency_max_cost,
                    filter_geom_consistency_max_cost >= 0, "at least 0");
  TAPA_CHECK_OPTION(filter_min_num_consistent, filter_min_num_consistent >= 0,
                    "at least 0");
  TAPA_CHECK_OPTION(device, device >= -1, "-1 (the CPU) or at least 0");
  TAPA_CHECK_OPTION(
      num_threads,
      num_threads == -1 || (num_threads >= 1 && num_threads <= 1024),
      "-1 (one per core) or from 1 to 1024");
  tapa.Check();
}

#undef TAPA_CHECK_OPTION

}  // namespace tapa
