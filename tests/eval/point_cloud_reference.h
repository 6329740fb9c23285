#ifndef TAPA_TESTS_EVAL_POINT_CLOUD_REFERENCE_H_
#define TAPA_TESTS_EVAL_POINT_CLOUD_REFERENCE_H_

#include <vector>

#include "src/base/vec3.h"
#include "src/eval/point_cloud_score.h"

namespace tapa {
namespace reference {

// The point-cloud score once more, as simple as it can be said: every point is
// compared with every other one, with angles where the program avoids them. It
// shares the types of the program and the order of its steps, nothing else.

struct CloudScore {
  std::vector<double> completeness;
  std::vector<double> accuracy;
  // Of points and tolerances.
  int num_accurate = 0;
  int num_inaccurate = 0;
  int num_unobserved = 0;
};

CloudScore ScorePointCloud(const std::vector<Vec3>& reconstruction,
                           const std::vector<LaserScan>& scans,
                           const std::vector<double>& tolerances,
                           double voxel_size, const BeamShape& beam);

// Distance from a point to the closest of many, infinite if there is none.
double DistanceToClosest(const Vec3& point, const std::vector<Vec3>& points);

enum class Observation { kAccurate, kInaccurate, kUnobserved };

Observation Observe(const Vec3& point, const std::vector<LaserScan>& scans,
                    double tolerance, const BeamShape& beam);

}  // namespace reference
}  // namespace tapa

#endif  // TAPA_TESTS_EVAL_POINT_CLOUD_REFERENCE_H_
