#include "src/colmap/options_record.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <set>
#include <vector>

#include "src/base/atomic_file.h"
#include "src/base/failure.h"
#include "src/colmap/option_list.h"
#include "util/misc.h"

namespace tapa {
namespace {

using colmap::mvs::PatchMatchOptions;

constexpr char kComment[] =
    "# Options of PatchMatchStereo that made the maps of this pass.\n";
// What stands for the value of an option that is not listed.
constexpr char kNoValue[] = "not set";

std::string ToText(const std::string& value) { return value; }
std::string ToText(bool value) { return value ? "1" : "0"; }
std::string ToText(int value) { return std::to_string(value); }

template <typename Float>
std::string ShortestText(Float value) {
  char text[64];
  const auto result = std::to_chars(text, text + sizeof(text), value);
  return std::string(text, result.ptr);
}

// The shortest text that reads as the same value. Some defaults of COLMAP are
// in single precision, such as 0.2f: they have the text of what they stand for,
// which is also what the command line and the options widget make of them.
std::string ToText(double value) {
  const float single = static_cast<float>(value);
  return single == value ? ShortestText(single) : ShortestText(value);
}

}  // namespace

OptionValues OptionsOfMaps(const PatchMatchOptions& options) {
  OptionValues values;
  VisitOptions(&options, [&](const OptionEntry& entry, const auto* value) {
    if (entry.changes_maps) {
      values[entry.name] = ToText(*value);
    }
  });
  // Until they did, maps were made with rays that are half a pixel off.
  values["rays"] = "through the centres of pixels";
  return values;
}

std::string DescribeDifferences(const OptionValues& recorded,
                                const OptionValues& current) {
  std::set<std::string> names;
  for (const OptionValues* values : {&recorded, &current}) {
    for (const auto& option : *values) {
      names.insert(option.first);
    }
  }
  const auto value_of = [](const OptionValues& values,
                           const std::string& name) -> std::string {
    const auto found = values.find(name);
    return found == values.end() ? kNoValue : found->second;
  };
  // Options that are listed on one side only follow, as a rule, from a switch
  // that differs; then that one says enough.
  std::vector<std::string> differences;
  std::vector<std::string> one_sided;
  for (const std::string& name : names) {
    const std::string was = value_of(recorded, name);
    const std::string is = value_of(current, name);
    if (was != is) {
      const bool both = recorded.count(name) > 0 && current.count(name) > 0;
      (both ? differences : one_sided)
          .push_back(name + " was " + was + ", is " + is);
    }
  }
  if (differences.empty()) {
    differences = one_sided;
  }

  constexpr size_t kMaxNamed = 6;
  std::string text;
  for (size_t i = 0; i < differences.size() && i < kMaxNamed; ++i) {
    text += (i > 0 ? "; " : "") + differences[i];
  }
  if (differences.size() > kMaxNamed) {
    text += "; and " + std::to_string(differences.size() - kMaxNamed) + " more";
  }
  return text;
}

std::optional<OptionValues> ReadOptionsRecord(const std::string& path) {
  if (!colmap::ExistsPath(path)) {
    return std::nullopt;
  }
  const auto fail = [&path](const std::string& error) {
    throw Failure(
        path + ", which says which options made the maps beside it, " + error +
        "; remove it to go on with these maps whatever made them, or "
        "remove the maps too to have them computed again");
  };
  std::ifstream file(path);
  OptionValues values;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (line.empty() || line[0] == '#') {
      continue;
    }
    const size_t equals = line.find(" = ");
    // A whole line ends with a line break.
    if (equals == std::string::npos || equals == 0 || file.eof() ||
        !values.emplace(line.substr(0, equals), line.substr(equals + 3))
             .second) {
      fail("is damaged in line " + std::to_string(number));
    }
  }
  if (!file.eof() || values.empty()) {
    fail("is empty or cannot be read");
  }
  return values;
}

void WriteOptionsRecord(const std::string& path, const OptionValues& values) {
  std::string text = kComment;
  for (const auto& [name, value] : values) {
    text += name + " = " + value + "\n";
  }
  AtomicFile file(path);
  file.Write(text.data(), text.size());
  file.Commit();
}

}  // namespace tapa
