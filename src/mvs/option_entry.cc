#include "src/mvs/option_entry.h"

#include <cmath>

namespace tapa {
namespace {

std::string NumberText(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

}  // namespace

OptionRange OptionRange::AtLeast(double min) {
  OptionRange range;
  range.min = min;
  return range;
}

OptionRange OptionRange::Positive() { return AtLeast(0).WithoutMin(); }

OptionRange OptionRange::From(double min, double max) {
  OptionRange range;
  range.min = min;
  range.max = max;
  return range;
}

OptionRange OptionRange::WithoutMin() const {
  OptionRange range = *this;
  range.with_min = false;
  return range;
}

OptionRange OptionRange::WithoutMax() const {
  OptionRange range = *this;
  range.with_max = false;
  return range;
}

OptionRange OptionRange::OrMinusOne(const std::string& meaning) const {
  OptionRange range = *this;
  range.minus_one = meaning;
  return range;
}

bool OptionRange::Contains(double value) const {
  if (value == -1 && !minus_one.empty()) {
    return true;
  }
  return std::isfinite(value) && (with_min ? value >= min : value > min) &&
         (with_max ? value <= max : value < max);
}

std::string OptionRange::Text() const {
  const std::string start =
      minus_one.empty() ? "" : "-1 (" + minus_one + ") or ";
  if (!std::isfinite(min)) {
    return start + "a number";
  }
  if (!std::isfinite(max)) {
    return start + (with_min   ? "at least " + NumberText(min)
                    : min == 0 ? "positive"
                               : "above " + NumberText(min));
  }
  if (with_min && with_max) {
    return start + "from " + NumberText(min) + " to " + NumberText(max);
  }
  return start + (with_min ? "at least " : "above ") + NumberText(min) +
         " and " + (with_max ? "at most " : "below ") + NumberText(max);
}

std::string OptionEntry::HelpWithRange() const {
  return std::isfinite(range.min) ? help + " (" + range.Text() + ")" : help;
}

}  // namespace tapa
