#ifndef TAPA_SRC_EVAL_TOLERANCE_H_
#define TAPA_SRC_EVAL_TOLERANCE_H_

#include <string>
#include <vector>

namespace tapa {

// How far an estimate may be from the truth and still count as right.
struct Tolerance {
  enum class Unit {
    // Absolute error in metres.
    kMetres,
    // Error in per cent of the true depth.
    kPercent,
  };
  double value = 0;
  Unit unit = Unit::kMetres;
};

// Reads a comma-separated list of positive numbers, such as "0.01,0.02". Throws
// std::invalid_argument for anything else, an empty list included.
std::vector<Tolerance> ParseTolerances(const std::string& list,
                                       Tolerance::Unit unit);

// "2 cm", "1.5 m" or "0.5 %".
std::string ToString(const Tolerance& tolerance);

}  // namespace tapa

#endif  // TAPA_SRC_EVAL_TOLERANCE_H_
