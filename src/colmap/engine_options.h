#ifndef TAPA_SRC_COLMAP_ENGINE_OPTIONS_H_
#define TAPA_SRC_COLMAP_ENGINE_OPTIONS_H_

#include <cstdint>
#include <string>

#include "mvs/patch_match.h"
#include "src/colmap/pass.h"
#include "src/mvs/options.h"

namespace tapa {

// The pass whose maps are the result.
Pass FinalPass(const colmap::mvs::PatchMatchOptions& options);

// Throws Failure that names the option if one is out of range.
void CheckOptions(const colmap::mvs::PatchMatchOptions& options);

// The options, but the seed, as the engine takes them.
Options EngineOptions(const colmap::mvs::PatchMatchOptions& options);

// What is in force in a pass: it has its own number of iterations, and in the
// photometric pass before a geometric one all pixels keep their estimates, so
// it neither filters nor, which takes the filter's place, refines.
colmap::mvs::PatchMatchOptions PassOptions(
    colmap::mvs::PatchMatchOptions options, Pass pass);

// Key of the random draws for a view in a pass. It does not depend on other
// views, nor on their order, so that a resumed run gives the same maps.
uint64_t ViewSeed(uint64_t seed, const std::string& image_name, Pass pass);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_ENGINE_OPTIONS_H_
