#include "src/colmap/prior_fit.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "src/base/depth.h"

namespace tapa {
namespace {

constexpr double kMaxError = 0.1;
// Pairs that a line is laid through: if four fifths of the samples fit, two in
// three pairs do.
constexpr int kNumPairs = 300;
constexpr int kNumRefinements = 3;

// What a line is fitted to: y is the depth or its inverse. Errors are relative
// to y, so that they mean the same in both.
struct Point {
  double x;
  double y;
};

struct Line {
  double scale = 0;
  double shift = 0;

  double Error(const Point& p) const {
    return std::abs((scale * p.x + shift) / p.y - 1);
  }
};

double Median(std::vector<double> values) {
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// How far off a sample may be.
double Tolerance(const std::vector<PriorSample>& samples) {
  std::vector<double> depths;
  for (const PriorSample& sample : samples) {
    depths.push_back(sample.depth);
  }
  const double median = Median(depths);
  for (double& depth : depths) {
    depth = std::abs(median / depth - 1);
  }
  return std::min(kMaxError, 0.5 * Median(depths));
}

class LineFit {
 public:
  LineFit(std::vector<Point> points, double tolerance)
      : points_(std::move(points)), tolerance_(tolerance) {}

  int Count(const Line& line) const {
    return static_cast<int>(std::count_if(
        points_.begin(), points_.end(),
        [&](const Point& p) { return line.Error(p) <= tolerance_; }));
  }

  // Lines that fall say nothing of depth.
  Line Best() const {
    std::mt19937 random;
    Line best;
    int best_count = -1;
    const auto consider = [&](const Line& line) {
      const int count = line.scale > 0 ? Count(line) : -1;
      if (count > best_count) {
        best = line;
        best_count = count;
      }
    };
    for (int i = 0; i < kNumPairs; ++i) {
      const Point& a = points_[random() % points_.size()];
      const Point& b = points_[random() % points_.size()];
      const double scale = (b.y - a.y) / (b.x - a.x);
      if (std::isfinite(scale)) {
        consider({scale, a.y - scale * a.x});
      }
    }
    for (int i = 0; i < kNumRefinements; ++i) {
      const Line refined = Refined(best);
      best = refined.scale > 0 ? refined : best;
    }
    return best;
  }

 private:
  // Least squares of the relative errors of those that fit.
  Line Refined(const Line& line) const {
    double xx = 0, x1 = 0, one = 0, xy = 0, y1 = 0;
    for (const Point& p : points_) {
      if (line.Error(p) <= tolerance_) {
        const double weight = 1 / (p.y * p.y);
        xx += weight * p.x * p.x;
        x1 += weight * p.x;
        one += weight;
        xy += weight * p.x * p.y;
        y1 += weight * p.y;
      }
    }
    const double determinant = xx * one - x1 * x1;
    const double scale = (xy * one - x1 * y1) / determinant;
    const double shift = (xx * y1 - x1 * xy) / determinant;
    return std::isfinite(scale + shift) ? Line{scale, shift} : line;
  }

  const std::vector<Point> points_;
  const double tolerance_;
};

// Means of how far off the samples nearby are, of those that are not far off.
// Where there are few of them, next to nothing is changed.
Map<float> Correction(const PriorFit& fit,
                      const std::vector<PriorSample>& samples) {
  constexpr int kSize = 41;
  // What is nearby: standard deviation of the weights, in shares of the image.
  constexpr double kSigma = 0.05;
  constexpr double kWeightOfNothing = 0.5;
  Map<float> correction(kSize, kSize);
  Map<double> weights(kSize, kSize, kWeightOfNothing);
  Map<double> sums(kSize, kSize);
  for (const PriorSample& sample : samples) {
    const double error =
        std::log(sample.depth / fit.UncorrectedDepth(sample.prior));
    if (!(std::abs(error) <= kMaxError)) {
      continue;
    }
    for (int row = 0; row < kSize; ++row) {
      for (int col = 0; col < kSize; ++col) {
        const double x = (col / (kSize - 1.0) - sample.x) / kSigma;
        const double y = (row / (kSize - 1.0) - sample.y) / kSigma;
        const double weight = std::exp(-0.5 * (x * x + y * y));
        weights.At(row, col) += weight;
        sums.At(row, col) += weight * error;
      }
    }
  }
  for (size_t i = 0; i < correction.size(); ++i) {
    correction.data()[i] =
        static_cast<float>(sums.data()[i] / weights.data()[i]);
  }
  return correction;
}

}  // namespace

float PriorFit::UncorrectedDepth(double prior) const {
  if (!std::isfinite(prior) || prior <= 0) {
    return 0;
  }
  const double value = scale * prior + shift;
  const float depth = static_cast<float>(is_inverse ? 1 / value : value);
  return IsDepth(depth) ? depth : 0;
}

float PriorFit::Depth(double prior, double x, double y) const {
  const float depth = UncorrectedDepth(prior);
  if (depth == 0 || correction.empty()) {
    return depth;
  }
  // Between the four numbers around the place.
  const auto split = [](double at, int count, int* index) {
    const double scaled = std::clamp(at, 0.0, 1.0) * (count - 1);
    *index = std::min(static_cast<int>(scaled), count - 2);
    return scaled - *index;
  };
  int col, row;
  const double right = split(x, correction.width(), &col);
  const double down = split(y, correction.height(), &row);
  const auto across = [&](int r) {
    return (1 - right) * correction.At(r, col) +
           right * correction.At(r, col + 1);
  };
  return static_cast<float>(
      depth * std::exp((1 - down) * across(row) + down * across(row + 1)));
}

PriorFit FitPrior(const std::vector<PriorSample>& samples) {
  PriorFit best;
  if (samples.size() < kMinPriorSamples) {
    return best;
  }
  const double tolerance = Tolerance(samples);
  int best_count = 0;
  for (const bool is_inverse : {false, true}) {
    std::vector<Point> points;
    for (const PriorSample& sample : samples) {
      points.push_back(
          {sample.prior, is_inverse ? 1 / sample.depth : sample.depth});
    }
    const LineFit fit(std::move(points), tolerance);
    const Line line = fit.Best();
    const int count = fit.Count(line);
    if (count > best_count) {
      best = {is_inverse,
              line.scale,
              line.shift,
              static_cast<double>(count) / samples.size(),
              {}};
      best_count = count;
    }
  }
  best.correction = Correction(best, samples);
  return best;
}

}  // namespace tapa
