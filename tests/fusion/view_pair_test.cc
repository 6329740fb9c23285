#include "src/fusion/view_pair.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <random>

#include "src/base/angle.h"
#include "tests/fusion/scene.h"

namespace tapa {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d RotationOf(const Camera& camera) {
  Matrix3d R;
  for (int i = 0; i < 9; ++i) {
    R(i / 3, i % 3) = camera.R[i];
  }
  return R;
}

Vector3d RayOf(const Camera& camera, double x, double y) {
  return {(x + 0.5 - camera.cx) / camera.fx, (y + 0.5 - camera.cy) / camera.fy,
          1};
}

Vector3d ToWorld(const Camera& camera, const Vector3d& p) {
  return RotationOf(camera).transpose() *
         (p - Vector3d(camera.t[0], camera.t[1], camera.t[2]));
}

Vector3d ToCamera(const Camera& camera, const Vector3d& p) {
  return RotationOf(camera) * p +
         Vector3d(camera.t[0], camera.t[1], camera.t[2]);
}

Vector3d ToVector(const Vec3& v) { return {v.x, v.y, v.z}; }

struct NaiveOpinion {
  double agreement = 0;
  bool doubts = false;
  bool is_same = false;
};

// In the world, in double precision, step by step.
NaiveOpinion AskNaively(const FusionOptions& options, const Camera& a,
                        const Camera& b, int row, int col,
                        const SurfaceMap& map_a, const SurfaceMap& map_b) {
  NaiveOpinion opinion;
  const SurfacePixel& pixel = map_a.At(row, col);
  const Vector3d ray_a = RayOf(a, col, row);
  const Vector3d X = ToWorld(a, pixel.depth * ray_a);
  const Vector3d in_b = ToCamera(b, X);
  const double x = b.fx * in_b.x() / in_b.z() + b.cx - 0.5;
  const double y = b.fy * in_b.y() / in_b.z() + b.cy - 0.5;
  const int col_b = static_cast<int>(std::lround(x));
  const int row_b = static_cast<int>(std::lround(y));
  if (in_b.z() <= 0 || col_b < 0 || row_b < 0 || col_b >= map_b.width() ||
      row_b >= map_b.height() || map_b.At(row_b, col_b).depth <= 0) {
    return opinion;
  }
  const SurfacePixel& other = map_b.At(row_b, col_b);
  const Vector3d n = ToVector(UnpackNormal(other.normal));
  const Vector3d Q = other.depth * RayOf(b, col_b, row_b);
  const Vector3d ray = RayOf(b, x, y);
  double met = n.dot(Q) / n.dot(ray);
  if (n.dot(Q) / other.depth > -0.05 || n.dot(ray) > -0.05 ||
      std::abs(met / other.depth - 1) > 0.1) {
    met = other.depth;
  }
  const Vector3d back = ToCamera(a, ToWorld(b, met * ray));
  const double reproj =
      std::hypot(a.fx * back.x() / back.z() + a.cx - 0.5 - col,
                 a.fy * back.y() / back.z() + a.cy - 0.5 - row);
  opinion.doubts = met / in_b.z() - 1 > 3 * options.depth_error &&
                   reproj >= 1.5 * options.reproj_error;
  const Vector3d n_world = RotationOf(b).transpose() * n;
  const Vector3d direction = RotationOf(a).transpose() * ray_a;
  if (n_world.dot(direction) > -0.05) {
    return opinion;
  }
  const Vector3d Q_world = ToWorld(b, Q);
  const double offset =
      n_world.dot(Q_world - X) / n_world.dot(direction) / pixel.depth;
  opinion.is_same = std::abs(offset) < 6 * options.depth_error &&
                    reproj < 4 * options.reproj_error;
  if (opinion.is_same && std::abs(offset) < 3 * options.depth_error) {
    const Vector3d n_a =
        RotationOf(a).transpose() * ToVector(UnpackNormal(pixel.normal));
    const double angle = (n_a - n_world).norm();
    opinion.agreement =
        std::exp(-0.5 * (std::pow(offset / options.depth_error, 2) +
                         std::pow(reproj / options.reproj_error, 2) +
                         std::pow(angle / DegToRad(options.normal_error), 2)));
  }
  return opinion;
}

TEST(ViewPairTest, AgreesWithNaiveReference) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const FusionOptions options;
  int num_agree = 0, num_doubt = 0, num_same = 0, num_different = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const Camera a = SceneCamera(0, 0.1 * uniform(random), 64, 48);
    const Camera b = SceneCamera(3, 0.6 + 0.1 * uniform(random), 80, 60);
    ScenePlane plane;
    plane.normal = {static_cast<float>(0.3 * uniform(random)), 0.1f, -1};
    const SurfaceMap map_a = SeePlane(plane, a, 64, 48);
    const SurfaceMap map_b =
        SeePlane(plane, b, 80, 60, 1 + 0.05 * uniform(random));
    const ViewPair pair(a, b, AgreementLimits(options));
    for (int row = 0; row < 48; row += 5) {
      for (int col = 0; col < 64; col += 3) {
        const SurfacePixel& pixel = map_a.At(row, col);
        const Opinion opinion =
            pair.Ask(row, col, pixel.depth, UnpackNormal(pixel.normal), map_b);
        const NaiveOpinion naive =
            AskNaively(options, a, b, row, col, map_a, map_b);
        // At the very border of a limit rounding decides.
        const bool is_equal =
            std::abs(opinion.agreement - naive.agreement) < 0.01 &&
            opinion.doubts == naive.doubts && opinion.is_same == naive.is_same;
        num_different += !is_equal;
        num_agree += naive.agreement > 0.1;
        num_doubt += naive.doubts;
        num_same += naive.is_same;
      }
    }
  }
  EXPECT_GT(num_agree, 200);
  EXPECT_GT(num_doubt, 500);
  EXPECT_GT(num_same, num_agree);
  EXPECT_LT(num_different, 20);
}

TEST(ViewPairTest, AViewBehindAnotherSurfaceHasNoOpinion) {
  const Camera a = SceneCamera(0, 0, 64, 48);
  const Camera b = SceneCamera(0.5, 0, 64, 48);
  const SurfaceMap map_a = SeePlane({}, a, 64, 48);
  const SurfaceMap before = SeePlane({}, b, 64, 48, 0.5);
  const ViewPair pair(a, b, AgreementLimits(FusionOptions()));
  const Opinion opinion =
      pair.Ask(24, 40, map_a.At(24, 40).depth, {0, 0, -1}, before);
  EXPECT_EQ(opinion.agreement, 0);
  EXPECT_FALSE(opinion.doubts);
  EXPECT_FALSE(opinion.is_same);
}

}  // namespace
}  // namespace tapa
