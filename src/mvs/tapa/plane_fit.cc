#include "src/mvs/tapa/plane_fit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "src/mvs/sweep/random.h"

namespace tapa {
namespace {

using Eigen::Vector3d;

// Hypotheses are compared on at most this many of the points.
constexpr int kMaxNumScored = 1000;
constexpr int kMaxNumTrials = 300;
// FitPlane's trials end when a better plane is missed with this probability.
constexpr double kMissProbability = 1e-3;
constexpr int kNumRefits = 3;

// A plane must be further from the camera than this share of the distance of
// its points, or its depths explode.
constexpr double kMinSlope = 0.02;

// Points X with normal.dot(X) = offset.
struct Fit {
  Vector3d normal = Vector3d::Zero();
  double offset = 0;
  bool valid = false;
};

Vector3d ToEigen(const Vec3& v) { return Vector3d(v.x, v.y, v.z); }

bool IsInlier(const Fit& fit, const Vec3& point, double max_distance) {
  return std::abs(fit.normal.dot(ToEigen(point)) - fit.offset) <= max_distance;
}

int CountInliers(const Fit& fit, const std::vector<Vec3>& points, size_t step,
                 double max_distance) {
  int count = 0;
  for (size_t i = 0; i < points.size(); i += step) {
    count += IsInlier(fit, points[i], max_distance);
  }
  return count;
}

Fit ThroughPoints(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vector3d u = ToEigen(b) - ToEigen(a);
  const Vector3d v = ToEigen(c) - ToEigen(a);
  Fit fit;
  fit.normal = u.cross(v);
  const double norm = fit.normal.norm();
  fit.valid = norm > 1e-6 * u.norm() * v.norm();
  if (fit.valid) {
    fit.normal /= norm;
    fit.offset = fit.normal.dot(ToEigen(a));
  }
  return fit;
}

// Least squares of the orthogonal distances of the inliers of another plane.
Fit Refit(const Fit& other, const std::vector<Vec3>& points,
          double max_distance) {
  // About a point on the plane, so that the squares keep their digits.
  const Vector3d origin = other.offset * other.normal;
  Vector3d sum = Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  int count = 0;
  for (const Vec3& point : points) {
    if (IsInlier(other, point, max_distance)) {
      const Vector3d x = ToEigen(point) - origin;
      sum += x;
      squares += x * x.transpose();
      ++count;
    }
  }
  Fit fit;
  if (count < 3) {
    return fit;
  }
  const Vector3d mean = sum / count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
      squares / count - mean * mean.transpose());
  fit.normal = solver.eigenvectors().col(0);
  fit.offset = fit.normal.dot(mean + origin);
  // Points on a line have two directions without extent.
  fit.valid = solver.eigenvalues()(1) > 1e-6 * solver.eigenvalues()(2);
  return fit;
}

int NumTrials(double inlier_ratio) {
  const double good = std::pow(inlier_ratio, 3);
  if (good > 0.999) {
    return 1;
  }
  return static_cast<int>(std::min<double>(
      kMaxNumTrials, std::ceil(std::log(kMissProbability) /
                               std::log(1 - std::max(good, 1e-9)))));
}

// One of `size`, by the i-th number of a trial.
size_t DrawIndex(const Random& random, int i, size_t size) {
  // Rounding may reach the size where that is large.
  return std::min(static_cast<size_t>(random.Uniform(i) * size), size - 1);
}

// The fit through three drawn points that scores most. draw(random, i): the
// i-th of them; through(a, b, c): the fit; score(fit): how much speaks for it.
// most: the score of a fit to all points, of which a share ends the trials
// early; infinity: none does.
template <typename Drawer, typename Through, typename Score>
auto RunRansac(double most, uint64_t key, const Drawer& draw,
               const Through& through, const Score& score) {
  decltype(through(Vec3(), Vec3(), Vec3())) best;
  double best_score = 0;
  int num_trials = kMaxNumTrials;
  for (int trial = 0; trial < num_trials; ++trial) {
    const Random random(key, trial, 0);
    const auto fit = through(draw(random, 0), draw(random, 1), draw(random, 2));
    if (!fit.valid) {
      continue;
    }
    const double fit_score = score(fit);
    if (fit_score > best_score) {
      best = fit;
      best_score = fit_score;
      num_trials = NumTrials(fit_score / most);
    }
  }
  return best;
}

// Points X with m.dot(X) = 1, of which m.dot(X) - 1 is the relative error of
// the depth.
struct DepthFit {
  Vector3d m = Vector3d::Zero();
  bool valid = false;
};

double DepthError(const DepthFit& fit, const Vec3& point) {
  return std::abs(fit.m.dot(ToEigen(point)) - 1);
}

double SmallestError(const DepthFit& fit, const PointGroup& group) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Vec3& point : group) {
    smallest = std::min(smallest, DepthError(fit, point));
  }
  return smallest;
}

int CountGroups(const DepthFit& fit, const std::vector<PointGroup>& groups,
                double max_error) {
  return static_cast<int>(
      std::count_if(groups.begin(), groups.end(), [&](const PointGroup& group) {
        return SmallestError(fit, group) <= max_error;
      }));
}

double ScoreGroups(const DepthFit& fit, const std::vector<PointGroup>& groups,
                   double max_error) {
  double score = 0;
  for (const PointGroup& group : groups) {
    const double error = SmallestError(fit, group) / max_error;
    score += error <= 1 ? 1 - error * error : 0;
  }
  return score;
}

// Least squares over the points that `take` says.
template <typename Take>
DepthFit FitDepths(const std::vector<PointGroup>& groups, const Take& take) {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Vector3d sum = Vector3d::Zero();
  for (const PointGroup& group : groups) {
    Eigen::Matrix3d group_squares = Eigen::Matrix3d::Zero();
    Vector3d group_sum = Vector3d::Zero();
    int count = 0;
    for (const Vec3& point : group) {
      if (take(point)) {
        const Vector3d x = ToEigen(point);
        group_squares += x * x.transpose();
        group_sum += x;
        ++count;
      }
    }
    squares += group_squares / std::max(count, 1);
    sum += group_sum / std::max(count, 1);
  }
  // Points on a line, or in a plane with the camera's centre, have two
  // directions at most.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(squares);
  const Vector3d values = solver.eigenvalues();
  DepthFit fit;
  fit.valid = values(0) > 1e-7 * values(2);
  if (fit.valid) {
    fit.m = solver.eigenvectors() *
            (solver.eigenvectors().transpose() * sum).cwiseQuotient(values);
    fit.valid = fit.m.norm() > 0;
  }
  return fit;
}

}  // namespace

FittedPlane FitPlaneToDepths(const std::vector<PointGroup>& groups,
                             float max_error, int min_num_groups,
                             uint64_t key) {
  FittedPlane result;
  const size_t size = groups.size();
  if (groups.empty() || static_cast<int>(size) < min_num_groups) {
    return result;
  }
  DepthFit best = RunRansac(
      std::numeric_limits<double>::infinity(), key,
      [&](const Random& random, int i) {
        const PointGroup& group = groups[DrawIndex(random, i, size)];
        return group[DrawIndex(random, 3 + i, group.size())];
      },
      [](const Vec3& a, const Vec3& b, const Vec3& c) {
        return FitDepths({{a}, {b}, {c}}, [](const Vec3&) { return true; });
      },
      [&](const DepthFit& fit) { return ScoreGroups(fit, groups, max_error); });
  for (int i = 0; i < kNumRefits && best.valid; ++i) {
    best = FitDepths(groups, [&, other = best](const Vec3& point) {
      return DepthError(other, point) <= max_error;
    });
  }
  const int count = best.valid ? CountGroups(best, groups, max_error) : 0;
  if (count < std::max(min_num_groups, 1)) {
    return result;
  }
  const double norm = best.m.norm();
  const Eigen::Vector3f normal = (-best.m / norm).cast<float>();
  result.plane.normal = {normal(0), normal(1), normal(2)};
  result.plane.distance = static_cast<float>(1 / norm);
  result.inlier_ratio = static_cast<float>(count) / size;
  return result;
}

FittedPlane FitPlane(const std::vector<Vec3>& points, float max_distance,
                     int min_num_inliers, uint64_t key) {
  FittedPlane result;
  min_num_inliers = std::max(min_num_inliers, 3);
  if (points.size() < static_cast<size_t>(min_num_inliers)) {
    return result;
  }
  const size_t step = (points.size() + kMaxNumScored - 1) / kMaxNumScored;
  Fit best = RunRansac(
      std::ceil(static_cast<double>(points.size()) / step), key,
      [&](const Random& random, int i) {
        return points[DrawIndex(random, i, points.size())];
      },
      ThroughPoints,
      [&](const Fit& fit) {
        return CountInliers(fit, points, step, max_distance);
      });
  if (!best.valid) {
    return result;
  }
  for (int i = 0; i < kNumRefits; ++i) {
    const Fit fit = Refit(best, points, max_distance);
    if (!fit.valid) {
      return result;
    }
    best = fit;
  }
  const int best_count = CountInliers(best, points, 1, max_distance);

  Vector3d mean = Vector3d::Zero();
  for (const Vec3& point : points) {
    mean += ToEigen(point) / points.size();
  }
  if (best_count < min_num_inliers ||
      !(std::abs(best.offset) > kMinSlope * mean.norm())) {
    return result;
  }
  // Facing the camera: normal.dot(X) < 0 for points X on the plane.
  const double sign = best.offset > 0 ? -1 : 1;
  const Eigen::Vector3f normal = (sign * best.normal).cast<float>();
  result.plane.normal = {normal(0), normal(1), normal(2)};
  result.plane.distance = static_cast<float>(std::abs(best.offset));
  result.inlier_ratio = static_cast<float>(best_count) / points.size();
  result.max_distance = max_distance;
  return result;
}

}  // namespace tapa
