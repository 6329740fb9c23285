#ifndef TAPA_SRC_EVAL_SCORE_TABLE_H_
#define TAPA_SRC_EVAL_SCORE_TABLE_H_

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "src/eval/depth_map_score.h"
#include "src/eval/tolerance.h"

namespace tapa {

// The score of all pixels whose textureness is below a bound, in all views.
struct TexturenessScore {
  double max_textureness = 0;
  DepthMapScore score;
};

// Scores of all views of a workspace.
struct ScoreReport {
  std::vector<Tolerance> tolerances;
  // Names of the views, in the order of their scores.
  std::vector<std::string> names;
  std::vector<DepthMapScore> scores;
  // The score of all views together.
  DepthMapScore overall;
  std::vector<TexturenessScore> by_textureness;
};

// Writes what a person wants to see: one line per view, then the overall score
// at every tolerance, and the same for every bound of textureness. Shares are
// in per cent, "-" where there is none.
void PrintScores(const ScoreReport& report, std::ostream& stream);

// All figures: {"overall": SCORE, "images": [SCORE with "name", ...],
// "by_textureness": [{"max_textureness", "score": SCORE}, ...]}. Shares are 0
// to 1, errors in metres or relative to the true depth, null where there is
// nothing to measure.
nlohmann::json ScoresToJson(const ScoreReport& report);

// Writes a file that appears under its name when it is complete, as AtomicFile.
// Throws Failure if it cannot be written.
void WriteJson(const std::string& path, const nlohmann::json& json);

// A share of 0 to 1 in per cent with `digits` decimals, "-" if there is none.
std::string PercentText(double share, int digits);

}  // namespace tapa

#endif  // TAPA_SRC_EVAL_SCORE_TABLE_H_
