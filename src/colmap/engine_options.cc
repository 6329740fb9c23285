#include "src/colmap/engine_options.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "src/base/failure.h"
#include "src/base/hash.h"
#include "src/colmap/option_list.h"
#include "src/colmap/workers.h"
#include "src/mvs/levels.h"

namespace tapa {

using colmap::mvs::PatchMatchOptions;

void CheckOptions(const PatchMatchOptions& options) {
  try {
    VisitOptions(&options, [](const OptionEntry& entry, const auto* value) {
      CheckOption(entry, *value);
    });
    CheckOption("tapa_debug", options.tapa_debug,
                options.tapa_debug.empty() || options.tapa.enabled,
                "empty unless tapa is on: there would be nothing to draw");
    if (options.depth_min >= 0 || options.depth_max >= 0) {
      CheckOption("depth_min", options.depth_min, options.depth_min >= 0,
                  "at least 0 where depth_max is given (-1 for both: from the "
                  "sparse model)");
      CheckOption("depth_max", options.depth_max,
                  options.depth_max > 0 &&
                      options.depth_max >= options.depth_min &&
                      std::isfinite(options.depth_max),
                  "positive and at least depth_min where that is given (-1 for "
                  "both: from the sparse model)");
    }
  } catch (const std::invalid_argument& error) {
    throw Failure(std::string("PatchMatchStereo.") + error.what());
  }
  ParseGpuIndices(options.gpu_index);
}

Options EngineOptions(const PatchMatchOptions& options) {
  Options result;
  VisitSharedOptions(
      [](const OptionEntry&, auto* to, const auto* from) { *to = *from; },
      &result, &options);
  result.first_perturbation = options.first_perturbation;
  result.search = options.search;
  result.num_threads = options.num_threads;
  result.tapa = options.tapa;
  return result;
}

Pass FinalPass(const PatchMatchOptions& options) {
  return options.geom_consistency ? Pass::kGeometric : Pass::kPhotometric;
}

bool HasDrafts(const PatchMatchOptions& options) {
  return options.geom_consistency && options.tapa.enabled &&
         options.tapa.refinement && options.tapa.completion &&
         options.tapa.completion_consensus;
}

bool Filters(const PatchMatchOptions& options, Pass pass, int level) {
  return level == 0 && (pass == FinalPass(options) || pass == Pass::kDraft);
}

namespace {

void TakeColmapDefaults(PatchMatchOptions* options) {
  options->num_levels = 1;
  options->num_samples = 15;
  options->num_iterations = options->num_geom_iterations = 5;
  options->window_step = 1;
  options->sigma_color = 0.2;
  options->first_perturbation = options->geom_perturbation = 1;
  options->search.try_all = true;
  options->search.measure_all = true;
  options->search.hysteresis = 0;
  options->search.sigma_textured = -1;
}

}  // namespace

int NumLevels(const PatchMatchOptions& options, int longest_side) {
  if (options.colmap_defaults) {
    return 1;
  }
  return options.num_levels > 0 ? options.num_levels
                                : AutomaticNumLevels(longest_side);
}

PatchMatchOptions PassOptions(PatchMatchOptions options, Pass pass, int level,
                              int num_levels) {
  if (options.colmap_defaults) {
    TakeColmapDefaults(&options);
    options.colmap_defaults = false;
  }
  options.num_levels = num_levels;
  const bool is_coarsest = level + 1 == num_levels;
  const bool is_geometric = pass != Pass::kPhotometric;
  if (is_geometric) {
    options.num_iterations =
        std::min(options.num_iterations, options.num_geom_iterations);
  } else if (!is_coarsest) {
    options.num_iterations =
        std::min(options.num_iterations, options.num_fine_iterations);
  }
  if (!is_coarsest) {
    options.first_perturbation =
        std::min(options.first_perturbation, options.fine_perturbation);
  } else if (is_geometric) {
    options.first_perturbation =
        std::min(options.first_perturbation, options.geom_perturbation);
  }
  if (!Filters(options, pass, level)) {
    options.filter = false;
    options.tapa.refinement = false;
  }
  options.geom_consistency = is_geometric;
  return options;
}

uint64_t ViewSeed(uint64_t seed, const std::string& image_name, Pass pass,
                  int level) {
  Hash hash;
  const auto add = [&hash](uint8_t byte) { hash.Add(&byte, 1); };
  for (int shift = 0; shift < 64; shift += 8) {
    add(static_cast<uint8_t>(seed >> shift));
  }
  // Drafts are what the geometric pass makes without consensus.
  add(static_cast<uint8_t>(2 * level + (pass == Pass::kPhotometric ? 0 : 1)));
  hash.Add(image_name.data(), image_name.size());
  return hash.value();
}

}  // namespace tapa
