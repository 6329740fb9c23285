#ifndef TAPA_SRC_COLMAP_OPTIONS_RECORD_H_
#define TAPA_SRC_COLMAP_OPTIONS_RECORD_H_

#include <map>
#include <optional>
#include <string>

#include "mvs/patch_match.h"

namespace tapa {

// Maps do not say which options made them. A small text file beside them does,
// one for each pass, so that maps of different options do not get mixed.

// Values as text, by name.
using OptionValues = std::map<std::string, std::string>;

// The options that the maps of a pass depend on. options: those of the pass,
// its geom_consistency says which one it is. An option that nothing reads, as
// its part is off, is left out.
OptionValues OptionsOfMaps(const colmap::mvs::PatchMatchOptions& options);

// Names what differs, for the user, as in "seed was 0, is 1"; empty: nothing.
std::string DescribeDifferences(const OptionValues& recorded,
                                const OptionValues& current);

// Reads a record. Returns nothing if there is none; throws Failure if it is
// damaged.
std::optional<OptionValues> ReadOptionsRecord(const std::string& path);

// Writes a record such that it is there only when it is complete. Throws
// Failure if that is impossible.
void WriteOptionsRecord(const std::string& path, const OptionValues& values);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_OPTIONS_RECORD_H_
