#include "src/mvs/tapa/plane_fit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "src/mvs/sweep/random.h"

namespace tapa {
namespace {

using Eigen::Vector3d;

// Hypotheses are compared on at most this many of the points.
constexpr int kMaxNumScored = 1000;
constexpr int kMaxNumTrials = 300;
// Trials end when a better plane is missed with this probability.
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

// The fit through three drawn points that counts most, of num_scored.
// through(a, b, c): the fit; count(fit): how many points lie on it.
template <typename Through, typename Count>
auto RunRansac(const std::vector<Vec3>& points, double num_scored, uint64_t key,
               const Through& through, const Count& count_inliers) {
  const size_t size = points.size();
  decltype(through(points[0], points[0], points[0])) best;
  int best_count = 0;
  int num_trials = kMaxNumTrials;
  for (int trial = 0; trial < num_trials; ++trial) {
    const Random random(key, trial, 0);
    const auto draw = [&](int i) {
      // Rounding may reach the size where that is large.
      return points[std::min(static_cast<size_t>(random.Uniform(i) * size),
                             size - 1)];
    };
    const auto fit = through(draw(0), draw(1), draw(2));
    if (!fit.valid) {
      continue;
    }
    const int count = count_inliers(fit);
    if (count > best_count) {
      best = fit;
      best_count = count;
      num_trials = NumTrials(count / num_scored);
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

bool IsInlier(const DepthFit& fit, const Vec3& point, double max_error) {
  return std::abs(fit.m.dot(ToEigen(point)) - 1) <= max_error;
}

int CountInliers(const DepthFit& fit, const std::vector<Vec3>& points,
                 double max_error) {
  return static_cast<int>(std::count_if(
      points.begin(), points.end(),
      [&](const Vec3& point) { return IsInlier(fit, point, max_error); }));
}

// Least squares over the points that `take` says.
template <typename Take>
DepthFit FitDepths(const std::vector<Vec3>& points, const Take& take) {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Vector3d sum = Vector3d::Zero();
  for (const Vec3& point : points) {
    if (take(point)) {
      const Vector3d x = ToEigen(point);
      squares += x * x.transpose();
      sum += x;
    }
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

FittedPlane FitPlaneToDepths(const std::vector<Vec3>& points, float max_error,
                             int min_num_inliers, uint64_t key) {
  FittedPlane result;
  min_num_inliers = std::max(min_num_inliers, 3);
  const size_t size = points.size();
  if (size < static_cast<size_t>(min_num_inliers)) {
    return result;
  }
  DepthFit best = RunRansac(
      points, static_cast<double>(size), key,
      [](const Vec3& a, const Vec3& b, const Vec3& c) {
        return FitDepths({a, b, c}, [](const Vec3&) { return true; });
      },
      [&](const DepthFit& fit) {
        return CountInliers(fit, points, max_error);
      });
  for (int i = 0; i < kNumRefits && best.valid; ++i) {
    best = FitDepths(points, [&, other = best](const Vec3& point) {
      return IsInlier(other, point, max_error);
    });
  }
  const int best_count = best.valid ? CountInliers(best, points, max_error) : 0;
  if (best_count < min_num_inliers) {
    return result;
  }
  const double norm = best.m.norm();
  const Eigen::Vector3f normal = (-best.m / norm).cast<float>();
  result.plane.normal = {normal(0), normal(1), normal(2)};
  result.plane.distance = static_cast<float>(1 / norm);
  result.inlier_ratio = static_cast<float>(best_count) / size;
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
  Fit best =
      RunRansac(points, std::ceil(static_cast<double>(points.size()) / step),
                key, ThroughPoints, [&](const Fit& fit) {
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
