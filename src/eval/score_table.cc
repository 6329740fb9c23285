#include "src/eval/score_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iomanip>
#include <sstream>

namespace tapa {
namespace {

using Row = std::vector<std::string>;

// Writes rows of the same length: the first column to the left, the others to
// the right of as much space as they need. The first row is the heading.
void PrintTable(const std::vector<Row>& rows, std::ostream& stream) {
  std::vector<size_t> widths(rows.front().size());
  for (const Row& row : rows) {
    for (size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], row[i].size());
    }
  }
  size_t total = 0;
  for (const size_t width : widths) total += width + 2;
  for (size_t i = 0; i < rows.size(); ++i) {
    for (size_t j = 0; j < widths.size(); ++j) {
      if (j > 0) stream << "  ";
      stream << (j == 0 ? std::left : std::right)
             << std::setw(static_cast<int>(widths[j])) << rows[i][j];
    }
    stream << "\n";
    if (i == 0) stream << std::string(total - 2, '-') << "\n";
  }
}

std::string Fixed(double value, int digits) {
  if (std::isnan(value)) return "-";
  std::ostringstream stream;
  stream << std::fixed << std::setprecision(digits) << value;
  return stream.str();
}

Row ViewRow(const std::string& name, const DepthMapScore& score) {
  Row row = {name,
             std::to_string(score.num_pixels),
             PercentText(score.Coverage(), 1),
             PercentText(score.MeasurementCoverage(), 1),
             Fixed(1000 * score.median_absolute_error, 2),
             PercentText(score.median_relative_error, 3)};
  for (size_t i = 0; i < score.num_complete.size(); ++i) {
    row.push_back(PercentText(score.F1(static_cast<int>(i)), 1));
  }
  return row;
}

nlohmann::json ToJson(const DepthMapScore& score,
                      const std::vector<Tolerance>& tolerances) {
  nlohmann::json json = {
      {"num_pixels", score.num_pixels},
      {"num_estimates", score.num_estimates},
      {"num_invalid", score.num_invalid},
      {"num_measurements", score.num_measurements},
      {"num_measurements_covered", score.num_measurements_covered},
      {"num_estimates_measured", score.num_estimates_measured},
      {"coverage", score.Coverage()},
      {"measurement_coverage", score.MeasurementCoverage()},
      {"median_absolute_error", score.median_absolute_error},
      {"median_relative_error", score.median_relative_error},
      {"tolerances", nlohmann::json::array()}};
  for (size_t i = 0; i < tolerances.size(); ++i) {
    const int index = static_cast<int>(i);
    const bool metres = tolerances[i].unit == Tolerance::Unit::kMetres;
    json["tolerances"].push_back({{"tolerance", tolerances[i].value},
                                  {"unit", metres ? "m" : "%"},
                                  {"completeness", score.Completeness(index)},
                                  {"accuracy", score.Accuracy(index)},
                                  {"f1", score.F1(index)}});
  }
  return json;
}

nlohmann::json OverallToJson(const DepthMapScore& score,
                             const std::vector<Tolerance>& tolerances) {
  nlohmann::json json = ToJson(score, tolerances);
  json["num_maps"] = score.num_maps;
  return json;
}

// The score at every tolerance.
void PrintTotals(const DepthMapScore& score,
                 const std::vector<Tolerance>& tolerances,
                 std::ostream& stream) {
  std::vector<Row> rows = {
      {"Tolerance", "Completeness %", "Accuracy %", "F1 %"}};
  for (size_t i = 0; i < tolerances.size(); ++i) {
    const int index = static_cast<int>(i);
    rows.push_back({ToString(tolerances[i]),
                    PercentText(score.Completeness(index), 2),
                    PercentText(score.Accuracy(index), 2),
                    PercentText(score.F1(index), 2)});
  }
  PrintTable(rows, stream);
}

}  // namespace

void PrintScores(const ScoreReport& report, std::ostream& stream) {
  Row heading = {"View",       "Pixels",    "Coverage %",
                 "of truth %", "Median mm", "Median %"};
  for (const Tolerance& tolerance : report.tolerances) {
    heading.push_back("F1 " + ToString(tolerance));
  }
  std::vector<Row> views = {heading};
  for (size_t i = 0; i < report.names.size(); ++i) {
    views.push_back(ViewRow(report.names[i], report.scores[i]));
  }
  views.push_back(ViewRow("all", report.overall));
  PrintTable(views, stream);
  stream << "\n";
  PrintTotals(report.overall, report.tolerances, stream);
  for (const TexturenessScore& entry : report.by_textureness) {
    stream << "\nTextureness below " << entry.max_textureness << ": coverage "
           << PercentText(entry.score.Coverage(), 1) << " % of "
           << entry.score.num_pixels << " pixels, "
           << PercentText(entry.score.MeasurementCoverage(), 1)
           << " % of those with a measurement\n";
    PrintTotals(entry.score, report.tolerances, stream);
  }
}

nlohmann::json ScoresToJson(const ScoreReport& report) {
  nlohmann::json json;
  json["overall"] = OverallToJson(report.overall, report.tolerances);
  json["images"] = nlohmann::json::array();
  for (size_t i = 0; i < report.names.size(); ++i) {
    nlohmann::json image = ToJson(report.scores[i], report.tolerances);
    image["name"] = report.names[i];
    json["images"].push_back(image);
  }
  json["by_textureness"] = nlohmann::json::array();
  for (const TexturenessScore& entry : report.by_textureness) {
    json["by_textureness"].push_back(
        {{"max_textureness", entry.max_textureness},
         {"score", OverallToJson(entry.score, report.tolerances)}});
  }
  return json;
}

std::string PercentText(double share, int digits) {
  return Fixed(100 * share, digits);
}

}  // namespace tapa
