#include "src/colmap/engine_options.h"

#include <algorithm>
#include <stdexcept>

#include "src/base/failure.h"
#include "src/colmap/option_list.h"
#include "src/colmap/workers.h"

namespace tapa {

using colmap::mvs::PatchMatchOptions;

void CheckOptions(const PatchMatchOptions& options) {
  try {
    VisitOptions(options, [](const OptionEntry& entry, const auto* value) {
      CheckOption(entry, *value);
    });
    CheckOption("tapa_debug", options.tapa_debug,
                options.tapa_debug.empty() || options.tapa.enabled,
                "empty unless tapa is on: there would be nothing to draw");
    if (options.depth_min >= 0 || options.depth_max >= 0) {
      CheckOption("depth_min", options.depth_min, options.depth_min > 0,
                  "positive where depth_max is given (-1 for both: from the "
                  "sparse model)");
      CheckOption("depth_max", options.depth_max,
                  options.depth_max >= options.depth_min, "at least depth_min");
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
  result.num_threads = options.num_threads;
  result.tapa = options.tapa;
  return result;
}

Pass FinalPass(const PatchMatchOptions& options) {
  return options.geom_consistency ? Pass::kGeometric : Pass::kPhotometric;
}

PatchMatchOptions PassOptions(PatchMatchOptions options, Pass pass) {
  if (options.colmap_defaults) {
    options.num_samples = 15;
    options.num_iterations = options.num_geom_iterations = 5;
    options.window_step = options.first_window_step = 1;
    options.colmap_defaults = false;
  }
  if (pass == Pass::kGeometric) {
    options.num_iterations =
        std::min(options.num_iterations, options.num_geom_iterations);
  }
  if (pass != FinalPass(options)) {
    options.window_step =
        std::max(options.window_step, options.first_window_step);
    options.geom_consistency = false;
    options.filter = false;
    options.tapa.refinement = false;
  }
  return options;
}

uint64_t ViewSeed(uint64_t seed, const std::string& image_name, Pass pass) {
  // FNV-1a.
  uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&hash](uint8_t byte) {
    hash = (hash ^ byte) * 0x100000001b3u;
  };
  for (int shift = 0; shift < 64; shift += 8) {
    add(static_cast<uint8_t>(seed >> shift));
  }
  add(static_cast<uint8_t>(pass));
  for (const char c : image_name) {
    add(static_cast<uint8_t>(c));
  }
  return hash;
}

}  // namespace tapa
