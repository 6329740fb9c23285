#include "src/colmap/engine_options.h"

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "src/base/failure.h"

namespace tapa {
namespace {

using colmap::mvs::PatchMatchOptions;

template <typename T>
void CheckOption(const std::string& name, T value, bool valid,
                 const std::string& range) {
  if (!valid) {
    std::ostringstream message;
    message << name << " is " << value << ", but must be " << range;
    throw std::invalid_argument(message.str());
  }
}

// "-1", or numbers from 0 separated by commas.
bool IsGpuIndexList(const std::string& text) {
  if (text == "-1") {
    return true;
  }
  std::istringstream list(text);
  bool valid = !text.empty() && text.back() != ',';
  for (std::string item; valid && std::getline(list, item, ',');) {
    const size_t begin = item.find_first_not_of(' ');
    const size_t end = item.find_last_not_of(' ');
    valid = begin != std::string::npos && end - begin < 9;
    for (size_t i = begin; valid && i <= end; ++i) {
      valid = item[i] >= '0' && item[i] <= '9';
    }
  }
  return valid;
}

}  // namespace

void CheckOptions(const PatchMatchOptions& options) {
  try {
    EngineOptions(options).Check();
    CheckOption(
        "num_geom_iterations", options.num_geom_iterations,
        options.num_geom_iterations == -1 || options.num_geom_iterations > 0,
        "-1 (as num_iterations) or positive");
    CheckOption("seed", options.seed, options.seed >= 0, "at least 0");
    CheckOption("max_image_size", options.max_image_size,
                options.max_image_size == -1 || options.max_image_size > 0,
                "-1 (no limit) or positive");
    CheckOption("gpu_index", options.gpu_index,
                IsGpuIndexList(options.gpu_index),
                "-1 (all) or a list as in 0,1,2");
    CheckOption("cache_size", options.cache_size,
                options.cache_size > 0 && std::isfinite(options.cache_size),
                "positive");
    CheckOption("tapa_debug", options.tapa_debug,
                options.tapa_debug.empty() || options.tapa,
                "empty unless tapa is on: there would be nothing to draw");
    if (options.depth_min >= 0 || options.depth_max >= 0) {
      CheckOption("depth_min", options.depth_min,
                  options.depth_min > 0 && std::isfinite(options.depth_min),
                  "positive where depth_max is given (-1 for both: from the "
                  "sparse model)");
      CheckOption("depth_max", options.depth_max,
                  options.depth_max >= options.depth_min &&
                      std::isfinite(options.depth_max),
                  "at least depth_min");
    }
  } catch (const std::invalid_argument& error) {
    throw Failure(std::string("PatchMatchStereo.") + error.what());
  }
}

Options EngineOptions(const PatchMatchOptions& options) {
  Options result;
  result.window_radius = options.window_radius;
  result.window_step = options.window_step;
  result.sigma_spatial = options.sigma_spatial;
  result.sigma_color = options.sigma_color;
  result.num_samples = options.num_samples;
  result.ncc_sigma = options.ncc_sigma;
  result.min_triangulation_angle = options.min_triangulation_angle;
  result.incident_angle_sigma = options.incident_angle_sigma;
  result.num_iterations = options.num_iterations;
  result.geom_consistency = options.geom_consistency;
  result.geom_consistency_regularizer = options.geom_consistency_regularizer;
  result.geom_consistency_max_cost = options.geom_consistency_max_cost;
  result.filter = options.filter;
  result.filter_min_ncc = options.filter_min_ncc;
  result.filter_min_triangulation_angle =
      options.filter_min_triangulation_angle;
  result.filter_geom_consistency_max_cost =
      options.filter_geom_consistency_max_cost;
  result.filter_min_num_consistent = options.filter_min_num_consistent;
  result.num_threads = options.num_threads;

  result.tapa.enabled = options.tapa;
#define TAPA_PASS_ON(field) result.tapa.field = options.tapa_##field
  TAPA_PASS_ON(texture_weighting);
  TAPA_PASS_ON(fine_superpixels);
  TAPA_PASS_ON(coarse_superpixels);
  TAPA_PASS_ON(refinement);
  TAPA_PASS_ON(textureness_variance);
  TAPA_PASS_ON(min_textureness);
  TAPA_PASS_ON(weight_range);
  TAPA_PASS_ON(fine_divisor);
  TAPA_PASS_ON(coarse_divisor);
  TAPA_PASS_ON(plane_distance);
  TAPA_PASS_ON(relative_plane_distance);
  TAPA_PASS_ON(speckle_size);
  TAPA_PASS_ON(speckle_continuity);
  TAPA_PASS_ON(fill_radius);
  TAPA_PASS_ON(fill_rounds);
  TAPA_PASS_ON(completion);
  TAPA_PASS_ON(completion_agreement);
  TAPA_PASS_ON(completion_radius);
  TAPA_PASS_ON(completion_textureness);
  TAPA_PASS_ON(completion_fill_share);
#undef TAPA_PASS_ON
  return result;
}

Pass FinalPass(const PatchMatchOptions& options) {
  return options.geom_consistency ? Pass::kGeometric : Pass::kPhotometric;
}

PatchMatchOptions PassOptions(PatchMatchOptions options, Pass pass) {
  if (options.colmap_defaults) {
    options.num_samples = 15;
    options.num_iterations = 5;
    options.num_geom_iterations = -1;
    options.colmap_defaults = false;
  }
  if (pass == Pass::kGeometric && options.num_geom_iterations != -1) {
    options.num_iterations = options.num_geom_iterations;
  }
  if (pass != FinalPass(options)) {
    options.geom_consistency = false;
    options.filter = false;
    options.tapa_refinement = false;
  }
  return options;
}

uint64_t ViewSeed(uint64_t seed, const std::string& image_name,
                  bool geometric) {
  // FNV-1a.
  uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&hash](uint8_t byte) {
    hash = (hash ^ byte) * 0x100000001b3u;
  };
  for (int shift = 0; shift < 64; shift += 8) {
    add(static_cast<uint8_t>(seed >> shift));
  }
  add(geometric);
  for (const char c : image_name) {
    add(static_cast<uint8_t>(c));
  }
  return hash;
}

}  // namespace tapa
