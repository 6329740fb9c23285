#include "tests/eval/point_cloud_reference.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace tapa {
namespace reference {
namespace {

Eigen::Vector3d ToEigen(const Vec3& point) {
  return {point.x, point.y, point.z};
}

// Good and judged points of a cube of one of the two grids.
struct Cube {
  int num_good = 0;
  int num_judged = 0;
};

class CubeAverage {
 public:
  explicit CubeAverage(double voxel_size)
      : inverse_size_(static_cast<float>(1 / voxel_size)) {}

  void Add(const Vec3& point, bool good) {
    for (int grid = 0; grid < 2; ++grid) {
      const auto cell = [&](float coordinate) {
        const float shift = grid == 0 ? 0.0f : 0.5f;
        return static_cast<int>(std::floor(coordinate * inverse_size_ + shift));
      };
      Cube& cube = cubes_[{grid, cell(point.x), cell(point.y), cell(point.z)}];
      cube.num_good += good;
      ++cube.num_judged;
    }
  }

  double Mean() const {
    double sum = 0;
    for (const auto& [cell, cube] : cubes_) {
      sum += static_cast<double>(cube.num_good) / cube.num_judged;
    }
    return cubes_.empty() ? 0 : sum / static_cast<double>(cubes_.size());
  }

 private:
  float inverse_size_;
  std::map<std::tuple<int, int, int, int>, Cube> cubes_;
};

}  // namespace

double DistanceToClosest(const Vec3& point, const std::vector<Vec3>& points) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& other : points) {
    least = std::min(least, (ToEigen(point) - ToEigen(other)).norm());
  }
  return least;
}

Observation Observe(const Vec3& point, const std::vector<LaserScan>& scans,
                    double tolerance, const BeamShape& beam) {
  Observation result = Observation::kUnobserved;
  for (const LaserScan& scan : scans) {
    const Eigen::Vector3d place =
        scan.pose.rotation.inverse() * (ToEigen(point) - scan.pose.translation);
    const double radius =
        beam.start_radius + place.norm() * std::tan(beam.divergence_halfangle *
                                                    std::acos(-1.0) / 180);
    for (const Vec3& measured : scan.points) {
      const Eigen::Vector3d end = ToEigen(measured);
      if (end.norm() == 0) continue;
      const Eigen::Vector3d direction = end.normalized();
      const double along = direction.dot(place);
      const double aside = (place - along * direction).norm();
      if (along < 0 || aside > radius) continue;
      if ((place - end).norm() <= tolerance) return Observation::kAccurate;
      if (along < end.norm()) result = Observation::kInaccurate;
    }
  }
  return result;
}

CloudScore ScorePointCloud(const std::vector<Vec3>& reconstruction,
                           const std::vector<LaserScan>& scans,
                           const std::vector<double>& tolerances,
                           double voxel_size, const BeamShape& beam) {
  CloudScore score;
  for (const double value : tolerances) {
    const double tolerance = static_cast<float>(value);
    CubeAverage completeness(voxel_size);
    for (const LaserScan& scan : scans) {
      for (const Vec3& measured : scan.points) {
        const Vec3 point = scan.pose.ToWorld(measured);
        completeness.Add(point,
                         DistanceToClosest(point, reconstruction) <= tolerance);
      }
    }
    score.completeness.push_back(completeness.Mean());

    CubeAverage accuracy(voxel_size);
    for (const Vec3& point : reconstruction) {
      const Observation seen = Observe(point, scans, tolerance, beam);
      score.num_accurate += seen == Observation::kAccurate;
      score.num_inaccurate += seen == Observation::kInaccurate;
      score.num_unobserved += seen == Observation::kUnobserved;
      if (seen == Observation::kUnobserved) continue;
      accuracy.Add(point, seen == Observation::kAccurate);
    }
    score.accuracy.push_back(accuracy.Mean());
  }
  return score;
}

}  // namespace reference
}  // namespace tapa
