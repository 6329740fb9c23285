#ifndef TAPA_SRC_MVS_OPTION_ENTRY_H_
#define TAPA_SRC_MVS_OPTION_ENTRY_H_

#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>

// COLMAP's own sources include this header, through those with the options.

namespace tapa {

// The valid values of an option that is a number: all, or those within limits.
struct OptionRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  // Whether min and max are valid themselves. Infinity never is.
  bool with_min = true;
  bool with_max = true;
  // What -1 stands for, where it is valid in addition; empty: nothing.
  std::string minus_one;

  static OptionRange AtLeast(double min);
  static OptionRange Positive();
  static OptionRange From(double min, double max);
  OptionRange WithoutMin() const;
  OptionRange WithoutMax() const;
  OptionRange OrMinusOne(const std::string& meaning) const;

  bool Contains(double value) const;
  // As in "from 1 to 32" or "-1 (no limit) or positive".
  std::string Text() const;
};

// What is known of an option besides its value.
struct OptionEntry {
  // As on the command line, in project files and in records.
  std::string name;
  // What it is for, with its unit; empty for COLMAP's own.
  std::string help;
  // Of a number.
  OptionRange range = {};
  // Whether maps depend on it, given the values of all other options.
  bool changes_maps = true;

  // help, with the range where it has limits.
  std::string HelpWithRange() const;
};

// Throws std::invalid_argument that names the option, its value and what is
// valid in its place, if the value is not.
template <typename T>
void CheckOption(const std::string& name, const T& value, bool is_valid,
                 const std::string& valid) {
  if (!is_valid) {
    std::ostringstream message;
    message << name << " is " << value << ", but must be " << valid;
    throw std::invalid_argument(message.str());
  }
}

// The same for a number out of its range.
template <typename T>
void CheckOption(const OptionEntry& entry, const T& value) {
  if constexpr (std::is_arithmetic_v<T>) {
    CheckOption(entry.name, value, entry.range.Contains(value),
                entry.range.Text());
  }
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_OPTION_ENTRY_H_
