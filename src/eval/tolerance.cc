#include "src/eval/tolerance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <locale>
#include <sstream>
#include <stdexcept>

namespace tapa {
namespace {

double ParsePositive(const std::string& text, const std::string& list) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double value = 0;
  stream >> value;
  const bool whole = !stream.fail() && (stream >> std::ws).eof();
  if (!whole || !std::isfinite(value) || value <= 0) {
    throw std::invalid_argument(
        "'" + list + "' is not a comma-separated list of positive numbers");
  }
  return value;
}

}  // namespace

std::vector<Tolerance> ParseTolerances(const std::string& list,
                                       Tolerance::Unit unit) {
  std::vector<Tolerance> tolerances;
  for (size_t begin = 0; begin <= list.size();) {
    const size_t end = std::min(list.find(',', begin), list.size());
    tolerances.push_back(
        {ParsePositive(list.substr(begin, end - begin), list), unit});
    begin = end + 1;
  }
  return tolerances;
}

std::string ToString(const Tolerance& tolerance) {
  std::ostringstream stream;
  if (tolerance.unit == Tolerance::Unit::kPercent) {
    stream << tolerance.value << " %";
  } else if (tolerance.value < 1) {
    stream << tolerance.value * 100 << " cm";
  } else {
    stream << tolerance.value << " m";
  }
  return stream.str();
}

}  // namespace tapa
