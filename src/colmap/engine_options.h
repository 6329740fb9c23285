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

// Whether its maps are made from drafts.
bool HasDrafts(const colmap::mvs::PatchMatchOptions& options);

// Whether a pass at a level filters or, which takes the filter's place,
// refines: the final one does, or the drafts that it takes. Before that all
// pixels keep their estimates.
bool Filters(const colmap::mvs::PatchMatchOptions& options, Pass pass,
             int level);

// Throws Failure that names the option if one is out of range.
void CheckOptions(const colmap::mvs::PatchMatchOptions& options);

// The options, but the seed, as the engine takes them.
Options EngineOptions(const colmap::mvs::PatchMatchOptions& options);

// How many levels (levels.h) a run has whose largest image has this longest
// side, in pixels.
int NumLevels(const colmap::mvs::PatchMatchOptions& options, int longest_side);

// What is in force in a pass at a level: it has its own number of iterations
// and size of random changes, and filters and refines only where Filters says.
colmap::mvs::PatchMatchOptions PassOptions(
    colmap::mvs::PatchMatchOptions options, Pass pass, int level = 0,
    int num_levels = 1);

// Key of the random draws for a view in a pass at a level. It does not depend
// on other views, nor on their order, so that a resumed run gives the same
// maps.
uint64_t ViewSeed(uint64_t seed, const std::string& image_name, Pass pass,
                  int level = 0);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_ENGINE_OPTIONS_H_
