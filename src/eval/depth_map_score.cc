#include "src/eval/depth_map_score.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace tapa {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool IsDepth(float value) { return std::isfinite(value) && value > 0; }

double Share(int64_t part, int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / whole : kNaN;
}

// Reorders the values.
double Median(std::vector<float>* values) {
  if (values->empty()) return kNaN;
  const auto middle = values->begin() + values->size() / 2;
  std::nth_element(values->begin(), middle, values->end());
  if (values->size() % 2 == 1) return *middle;
  return 0.5 * (static_cast<double>(*middle) +
                *std::max_element(values->begin(), middle));
}

void AddCounts(const DepthMapScore& score, DepthMapScore* sum) {
  sum->num_maps += score.num_maps;
  sum->num_pixels += score.num_pixels;
  sum->num_estimates += score.num_estimates;
  sum->num_invalid += score.num_invalid;
  sum->num_measurements += score.num_measurements;
  sum->num_measurements_covered += score.num_measurements_covered;
  sum->num_estimates_measured += score.num_estimates_measured;
  for (size_t i = 0; i < score.num_complete.size(); ++i) {
    sum->num_complete[i] += score.num_complete[i];
    sum->num_accurate[i] += score.num_accurate[i];
  }
}

bool IsWithin(float estimate, float measurement, const Tolerance& tolerance) {
  const double truth = measurement;
  const double limit = tolerance.unit == Tolerance::Unit::kPercent
                           ? truth * tolerance.value / 100
                           : tolerance.value;
  return std::abs(estimate - truth) <= limit;
}

template <typename T>
std::string SizeOf(const Map<T>& map) {
  return std::to_string(map.width()) + "x" + std::to_string(map.height());
}

// Whether one size is the other one scaled, within one pixel each way.
bool SameShape(const Map<float>& a, const Map<float>& b) {
  const auto scale = [](int a, int b, int by) {
    return static_cast<double>(a + by) / b;
  };
  return scale(a.width(), b.width(), -1) <= scale(a.height(), b.height(), 1) &&
         scale(a.height(), b.height(), -1) <= scale(a.width(), b.width(), 1);
}

void CheckMaps(const Map<float>& depth, const Map<float>& ground_truth,
               const Map<uint8_t>* mask) {
  if (depth.empty()) throw std::invalid_argument("the depth map is empty");
  if (ground_truth.empty()) {
    throw std::invalid_argument("the ground truth is empty");
  }
  // Judged at the smaller of the two, where rounding matters.
  if (!(depth.width() < ground_truth.width()
            ? SameShape(depth, ground_truth)
            : SameShape(ground_truth, depth))) {
    throw std::invalid_argument("a depth map of " + SizeOf(depth) +
                                " pixels has another shape than its ground "
                                "truth of " +
                                SizeOf(ground_truth));
  }
  if (mask != nullptr && (mask->width() != ground_truth.width() ||
                          mask->height() != ground_truth.height())) {
    throw std::invalid_argument("a mask of " + SizeOf(*mask) +
                                " pixels has another size than the ground "
                                "truth of " +
                                SizeOf(ground_truth));
  }
}

}  // namespace

double DepthMapScore::Coverage() const {
  return Share(num_estimates, num_pixels);
}

double DepthMapScore::MeasurementCoverage() const {
  return Share(num_measurements_covered, num_measurements);
}

double DepthMapScore::Completeness(int i) const {
  return Share(num_complete.at(i), num_measurements);
}

double DepthMapScore::Accuracy(int i) const {
  return Share(num_accurate.at(i), num_estimates_measured);
}

double DepthMapScore::F1(int i) const {
  const double completeness = Completeness(i);
  if (completeness == 0) return 0;
  const double accuracy = Accuracy(i);
  return 2 * completeness * accuracy / (completeness + accuracy);
}

DepthMapScorer::DepthMapScorer(std::vector<Tolerance> tolerances)
    : tolerances_(std::move(tolerances)) {
  overall_.num_complete.resize(tolerances_.size());
  overall_.num_accurate.resize(tolerances_.size());
}

DepthMapScore DepthMapScorer::Add(const Map<float>& depth,
                                  const Map<float>& ground_truth,
                                  const Map<uint8_t>* mask) {
  CheckMaps(depth, ground_truth, mask);
  const auto masked = [mask](int row, int col) {
    return mask != nullptr && mask->At(row, col) == 0;
  };
  std::vector<float> absolute_errors;
  std::vector<float> relative_errors;
  DepthMapScore score;
  score.num_maps = 1;
  score.num_complete.resize(tolerances_.size());
  score.num_accurate.resize(tolerances_.size());

  // Completeness: over the measurements.
  const std::vector<int> depth_rows =
      CorrespondingPixels(ground_truth.height(), depth.height());
  const std::vector<int> depth_cols =
      CorrespondingPixels(ground_truth.width(), depth.width());
  for (int row = 0; row < ground_truth.height(); ++row) {
    for (int col = 0; col < ground_truth.width(); ++col) {
      const float measurement = ground_truth.At(row, col);
      if (masked(row, col) || !IsDepth(measurement)) continue;
      ++score.num_measurements;
      const float estimate = depth.At(depth_rows[row], depth_cols[col]);
      if (!IsDepth(estimate)) continue;
      ++score.num_measurements_covered;
      for (size_t i = 0; i < tolerances_.size(); ++i) {
        score.num_complete[i] += IsWithin(estimate, measurement, tolerances_[i]);
      }
    }
  }

  // Accuracy: over the estimates.
  const std::vector<int> truth_rows =
      CorrespondingPixels(depth.height(), ground_truth.height());
  const std::vector<int> truth_cols =
      CorrespondingPixels(depth.width(), ground_truth.width());
  for (int row = 0; row < depth.height(); ++row) {
    for (int col = 0; col < depth.width(); ++col) {
      if (masked(truth_rows[row], truth_cols[col])) continue;
      ++score.num_pixels;
      const float estimate = depth.At(row, col);
      if (!IsDepth(estimate)) {
        score.num_invalid += estimate != 0;
        continue;
      }
      ++score.num_estimates;
      const float measurement =
          ground_truth.At(truth_rows[row], truth_cols[col]);
      if (!IsDepth(measurement)) continue;
      ++score.num_estimates_measured;
      for (size_t i = 0; i < tolerances_.size(); ++i) {
        score.num_accurate[i] += IsWithin(estimate, measurement, tolerances_[i]);
      }
      const double error =
          std::abs(static_cast<double>(estimate) - measurement);
      absolute_errors.push_back(static_cast<float>(error));
      relative_errors.push_back(static_cast<float>(error / measurement));
    }
  }

  score.median_absolute_error = Median(&absolute_errors);
  score.median_relative_error = Median(&relative_errors);
  for (const float error : absolute_errors) absolute_errors_.Add(error);
  for (const float error : relative_errors) relative_errors_.Add(error);
  AddCounts(score, &overall_);
  return score;
}

DepthMapScore DepthMapScorer::Overall() const {
  DepthMapScore score = overall_;
  score.median_absolute_error = absolute_errors_.Median();
  score.median_relative_error = relative_errors_.Median();
  return score;
}

std::vector<int> CorrespondingPixels(int size, int other_size) {
  std::vector<int> pixels(size);
  for (int i = 0; i < size; ++i) {
    pixels[i] = static_cast<int>((2 * static_cast<int64_t>(i) + 1) *
                                 other_size / (2 * static_cast<int64_t>(size)));
  }
  return pixels;
}

}  // namespace tapa
