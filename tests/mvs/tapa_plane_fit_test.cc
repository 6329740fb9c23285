#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "src/mvs/tapa/plane_fit.h"
#include "tests/mvs/tapa_reference.h"

namespace tapa {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Points of z = 4 + 0.3 x - 0.2 y, moved by up to `noise` along z.
std::vector<Vec3> PointsOnPlane(int count, float noise, std::mt19937* random) {
  std::uniform_real_distribution<float> uniform(-1, 1);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const float x = uniform(*random);
    const float y = uniform(*random);
    points.push_back(
        {x, y, 4 + 0.3f * x - 0.2f * y + noise * uniform(*random)});
  }
  return points;
}

// Points anywhere before and behind that plane but not near it.
void AddOutliers(int count, std::mt19937* random, std::vector<Vec3>* points) {
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (int i = 0; i < count; ++i) {
    const float side = (*random)() % 2 ? 1 : -1;
    points->push_back({2 * uniform(*random), 2 * uniform(*random),
                       4 + side * (1.5f + uniform(*random) * 0.3f)});
  }
}

reference::DoublePlane ToDouble(const Plane& plane) {
  return {{plane.normal.x, plane.normal.y, plane.normal.z}, plane.distance};
}

void ExpectPlane(const Plane& plane, const reference::DoublePlane& other,
                 double tolerance) {
  EXPECT_NEAR(plane.normal.x, other.normal[0], tolerance);
  EXPECT_NEAR(plane.normal.y, other.normal[1], tolerance);
  EXPECT_NEAR(plane.normal.z, other.normal[2], tolerance);
  EXPECT_NEAR(plane.distance, other.distance, tolerance * other.distance);
}

int NumInliers(const FittedPlane& fit, const std::vector<Vec3>& points) {
  return static_cast<int>(
      std::lround(static_cast<double>(fit.inlier_ratio) * points.size()));
}

// What every result has to satisfy.
void ExpectSound(const FittedPlane& fit, const std::vector<Vec3>& points,
                 float max_distance, int min_num_inliers) {
  ASSERT_GE(fit.inlier_ratio, 0);
  ASSERT_LE(fit.inlier_ratio, 1);
  if (fit.inlier_ratio == 0) {
    return;
  }
  const int num_inliers = NumInliers(fit, points);
  EXPECT_GE(num_inliers, std::max(min_num_inliers, 3));
  EXPECT_FLOAT_EQ(fit.inlier_ratio,
                  static_cast<float>(num_inliers) / points.size());
  EXPECT_NEAR(Dot(fit.plane.normal, fit.plane.normal), 1, 1e-5);
  EXPECT_GT(fit.plane.distance, 0);
  // Single precision moves points at the threshold to either side of it.
  const double slack = 1e-5 * (max_distance + fit.plane.distance);
  int at_least = 0;
  int at_most = 0;
  for (const Vec3& point : points) {
    const double distance = reference::DistanceTo(ToDouble(fit.plane), point);
    at_least += distance <= max_distance - slack;
    at_most += distance <= max_distance + slack;
  }
  EXPECT_GE(num_inliers, at_least);
  EXPECT_LE(num_inliers, at_most);
}

TEST(FitPlane, FindsAnExactPlane) {
  std::mt19937 random(1);
  for (const int count : {3, 4, 12, 100, 5000}) {
    const std::vector<Vec3> points = PointsOnPlane(count, 0, &random);
    const FittedPlane fit = FitPlane(points, 0.01f, 3, 1);
    ExpectSound(fit, points, 0.01f, 3);
    EXPECT_EQ(NumInliers(fit, points), count);
    EXPECT_EQ(fit.inlier_ratio, 1);
    // z - 0.3 x + 0.2 y = 4, normalized and turned to the camera. Three points
    // may lie almost on a line.
    const double norm = std::sqrt(1 + 0.09 + 0.04);
    ExpectPlane(fit.plane, {{0.3 / norm, -0.2 / norm, -1 / norm}, 4 / norm},
                count < 12 ? 1e-4 : 1e-5);
  }
}

TEST(FitPlane, IsTheLeastSquaresPlaneOfTheInliers) {
  std::mt19937 random(2);
  for (const int num_outliers : {0, 10, 100, 300}) {
    SCOPED_TRACE(num_outliers);
    std::vector<Vec3> points = PointsOnPlane(200, 0.03f, &random);
    const reference::DoublePlane expected = reference::FitLeastSquares(points);
    AddOutliers(num_outliers, &random, &points);
    std::shuffle(points.begin(), points.end(), random);
    // Wide enough for all of the plane's points, and none of the others.
    const FittedPlane fit = FitPlane(points, 0.1f, 12, 3);
    ExpectSound(fit, points, 0.1f, 12);
    EXPECT_EQ(NumInliers(fit, points), 200);
    ExpectPlane(fit.plane, expected, 1e-6);
  }
}

TEST(FitPlane, KeepsItsDigitsFarFromTheOrigin) {
  std::mt19937 random(3);
  for (const float scale : {1e-4f, 1.0f, 1e4f}) {
    std::vector<Vec3> points;
    for (const Vec3& p : PointsOnPlane(300, 0.001f, &random)) {
      // A patch of 2 % of its distance, off the axis.
      points.push_back(scale * Vec3{3 + 0.01f * p.x, -2 + 0.01f * p.y,
                                    4 + 0.01f * (p.z - 4)});
    }
    const FittedPlane fit = FitPlane(points, 0.001f * scale, 12, 3);
    ExpectSound(fit, points, 0.001f * scale, 12);
    EXPECT_EQ(NumInliers(fit, points), 300);
    ExpectPlane(fit.plane, reference::FitLeastSquares(points), 1e-4);
  }
}

// All planes through three points, against a sample of them.
TEST(FitPlane, AgreesWithExhaustiveSearch) {
  for (int seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const int num_on_plane = 12 + random() % 20;
    std::vector<Vec3> points = PointsOnPlane(num_on_plane, 0.02f, &random);
    AddOutliers(40 - num_on_plane, &random, &points);
    const FittedPlane fit = FitPlane(points, 0.05f, 5, seed);
    ExpectSound(fit, points, 0.05f, 5);
    EXPECT_GE(NumInliers(fit, points), num_on_plane);
    EXPECT_LE(NumInliers(fit, points),
              reference::MaxNumInliers(points, 0.05 * 1.5));
  }
}

TEST(FitPlane, FindsAtLeastMostOfWhatExhaustiveSearchFindsInNoise) {
  int found = 0;
  int best = 0;
  for (int seed = 0; seed < 40; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<Vec3> points;
    for (int i = 0; i < 40; ++i) {
      points.push_back({uniform(random), uniform(random), 4 + uniform(random)});
    }
    const FittedPlane fit = FitPlane(points, 0.15f, 3, seed);
    ExpectSound(fit, points, 0.15f, 3);
    found += NumInliers(fit, points);
    best += reference::MaxNumInliers(points, 0.15);
  }
  EXPECT_GT(found, 0.85 * best);
}

TEST(FitPlane, TakesTheLargerOfTwoPlanes) {
  for (const int seed : {1, 2, 3, 4, 5}) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<Vec3> points;
    for (int i = 0; i < 1000; ++i) {
      const float x = uniform(random);
      const float y = uniform(random);
      const float noise = 0.005f * uniform(random);
      // A wall at depth 3, in a third of the points a floor.
      points.push_back(i % 10 < 6 ? Vec3{x, y, 3 + noise}
                                  : Vec3{x, 1.2f + noise, 3 + y});
    }
    const FittedPlane fit = FitPlane(points, 0.02f, 12, seed);
    ExpectSound(fit, points, 0.02f, 12);
    EXPECT_LT(fit.plane.normal.z, -0.999f);
    EXPECT_NEAR(fit.plane.distance, 3, 0.005);
    // The wall and what of the floor happens to be near it.
    EXPECT_GE(fit.inlier_ratio, 0.6f);
    EXPECT_LT(fit.inlier_ratio, 0.63f);
  }
}

TEST(FitPlane, FindsAPlaneOfFewPointsAmongMany) {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> uniform(0, 1);
  // As the first iteration leaves a wall: a third right, the rest anywhere.
  std::vector<Vec3> points = PointsOnPlane(4000, 0.01f, &random);
  for (int i = 0; i < 8000; ++i) {
    points.push_back({2 * uniform(random) - 1, 2 * uniform(random) - 1,
                      2 + 6 * uniform(random)});
  }
  std::shuffle(points.begin(), points.end(), random);
  const FittedPlane fit = FitPlane(points, 0.04f, 12, 9);
  ExpectSound(fit, points, 0.04f, 12);
  EXPECT_GE(NumInliers(fit, points), 4000);
  EXPECT_NEAR(fit.plane.distance, 4 / std::sqrt(1.13), 0.01);
}

TEST(FitPlane, NeedsTheMinimumOfPoints) {
  std::mt19937 random(7);
  const std::vector<Vec3> points = PointsOnPlane(20, 0, &random);
  EXPECT_GT(FitPlane(points, 0.01f, 20, 1).inlier_ratio, 0);
  EXPECT_EQ(FitPlane(points, 0.01f, 21, 1).inlier_ratio, 0);
  std::vector<Vec3> mixed = points;
  AddOutliers(20, &random, &mixed);
  EXPECT_EQ(NumInliers(FitPlane(mixed, 0.01f, 20, 1), mixed), 20);
  EXPECT_EQ(FitPlane(mixed, 0.01f, 24, 1).inlier_ratio, 0);
  // Three at least, whatever is asked.
  for (const int min_num_inliers : {-5, 0, 1, 2, 3}) {
    for (int count = 0; count <= 3; ++count) {
      const std::vector<Vec3> few(points.begin(), points.begin() + count);
      EXPECT_EQ(FitPlane(few, 0.01f, min_num_inliers, 1).inlier_ratio > 0,
                count == 3);
    }
  }
}

TEST(FitPlane, FindsNoneForPointsOnALine) {
  std::mt19937 random(8);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (const float extent : {0.01f, 1.0f, 3.0f}) {
    std::vector<Vec3> line;
    for (int i = 0; i < 100; ++i) {
      const float t = extent * uniform(random);
      line.push_back({1 + 0.3f * t, 0.5f - 0.8f * t, 4 + t});
    }
    EXPECT_EQ(FitPlane(line, 0.01f, 3, 1).inlier_ratio, 0) << extent;
  }
  // On an axis, without any rounding.
  std::vector<Vec3> axis;
  for (int i = 0; i < 100; ++i) {
    axis.push_back({0, 0, 1.0f + i});
  }
  EXPECT_EQ(FitPlane(axis, 0.01f, 3, 1).inlier_ratio, 0);
}

TEST(FitPlane, FindsNoneForCoincidentPoints) {
  const std::vector<Vec3> same(50, {1, 2, 3});
  EXPECT_EQ(FitPlane(same, 0.01f, 3, 1).inlier_ratio, 0);
  std::vector<Vec3> two = same;
  two.insert(two.end(), 50, {1, 2, 4});
  EXPECT_EQ(FitPlane(two, 0.01f, 3, 1).inlier_ratio, 0);
  // Three places are a plane, though most draws see fewer.
  std::vector<Vec3> three = two;
  three.push_back({2, 2, 3});
  const FittedPlane fit = FitPlane(three, 0.01f, 3, 1);
  if (fit.inlier_ratio > 0) {
    EXPECT_EQ(NumInliers(fit, three), 101);
  }
}

// Points in the plane x = distance.
std::vector<Vec3> PointsBeside(float distance) {
  std::mt19937 random(9);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<Vec3> points;
  for (int i = 0; i < 200; ++i) {
    points.push_back(
        {distance, 4 * uniform(random) - 2, 2 + 4 * uniform(random)});
  }
  return points;
}

TEST(FitPlane, FindsNoneSeenEdgeOn) {
  EXPECT_EQ(FitPlane(PointsBeside(0), 0.001f, 3, 1).inlier_ratio, 0);
  for (const float sign : {-1.0f, 1.0f}) {
    const auto beside = [&](float distance) {
      return FitPlane(PointsBeside(sign * distance), 0.0001f, 3, 1);
    };
    EXPECT_EQ(beside(0.001f).inlier_ratio, 0);
    EXPECT_EQ(beside(0.02f).inlier_ratio, 0);
    // A few degrees off it there is one, which faces the camera.
    const FittedPlane fit = beside(0.5f);
    EXPECT_EQ(fit.inlier_ratio, 1);
    EXPECT_NEAR(fit.plane.distance, 0.5, 1e-5);
    EXPECT_NEAR(fit.plane.normal.x, -sign, 1e-5);
  }
}

TEST(FitPlane, FacesTheCamera) {
  std::mt19937 random(10);
  std::normal_distribution<float> gauss;
  for (int i = 0; i < 200; ++i) {
    Vec3 normal = {gauss(random), gauss(random), gauss(random)};
    normal = (1 / std::sqrt(Dot(normal, normal))) * normal;
    const Vec3 center = {gauss(random), gauss(random), 6};
    if (std::abs(Dot(normal, center)) < 1) {
      continue;
    }
    std::vector<Vec3> points;
    for (int k = 0; k < 50; ++k) {
      const Vec3 offset = {gauss(random), gauss(random), gauss(random)};
      const Vec3 on_plane = offset - Dot(normal, offset) * normal;
      points.push_back(center - 0.3f * on_plane);
    }
    const FittedPlane fit = FitPlane(points, 0.001f, 12, i);
    ExpectSound(fit, points, 0.001f, 12);
    ASSERT_EQ(fit.inlier_ratio, 1);
    for (const Vec3& point : points) {
      ASSERT_LT(Dot(fit.plane.normal, point), 0);
      // The ray of a point meets the plane at the point.
      const Vec3 ray = (1 / point.z) * point;
      ASSERT_NEAR(PlaneAt(fit.plane, ray).depth, point.z, 1e-3 * point.z);
    }
  }
}

TEST(FitPlane, IgnoresPointsThatAreNoPoints) {
  std::mt19937 random(11);
  std::vector<Vec3> points = PointsOnPlane(100, 0.001f, &random);
  for (int i = 0; i < 10; ++i) {
    points.push_back({kNan, 0, 1});
    points.push_back({kNan, kNan, kNan});
  }
  const FittedPlane fit = FitPlane(points, 0.01f, 12, 1);
  // Without a plane at worst; never one that is not a number.
  ExpectSound(fit, points, 0.01f, 12);
  for (const float value : {kNan, kInf, -kInf}) {
    const std::vector<Vec3> nonsense(30, {value, value, value});
    EXPECT_EQ(FitPlane(nonsense, 0.01f, 3, 1).inlier_ratio, 0);
  }
}

TEST(FitPlane, SurvivesAnyDistance) {
  std::mt19937 random(12);
  const std::vector<Vec3> points = PointsOnPlane(100, 0.1f, &random);
  for (const float distance : {-1.0f, 0.0f, 1e-30f, 1e30f, kInf, kNan}) {
    const FittedPlane fit = FitPlane(points, distance, 3, 1);
    if (fit.inlier_ratio > 0) {
      EXPECT_GE(NumInliers(fit, points), 3);
      EXPECT_TRUE(std::isfinite(fit.plane.distance));
    }
    if (distance > 1) {
      EXPECT_EQ(fit.inlier_ratio, 1);
    }
  }
}

TEST(FitPlane, KeyDecidesTheResult) {
  std::mt19937 random(13);
  std::vector<Vec3> points = PointsOnPlane(60, 0.05f, &random);
  AddOutliers(140, &random, &points);
  int num_different = 0;
  const FittedPlane first = FitPlane(points, 0.02f, 5, 0);
  for (uint64_t key = 0; key < 20; ++key) {
    const FittedPlane a = FitPlane(points, 0.02f, 5, key);
    const FittedPlane b = FitPlane(points, 0.02f, 5, key);
    EXPECT_EQ(std::memcmp(&a, &b, sizeof(a)), 0);
    num_different += std::memcmp(&a, &first, sizeof(a)) != 0;
  }
  EXPECT_GT(num_different, 0);
}

// Each a group of its own.
std::vector<PointGroup> Alone(const std::vector<Vec3>& points) {
  std::vector<PointGroup> groups;
  for (const Vec3& point : points) {
    groups.push_back({point});
  }
  return groups;
}

TEST(FitPlaneToDepths, IsExactAndLeavesOutliersOut) {
  std::mt19937 random(8);
  std::vector<Vec3> points = PointsOnPlane(60, 0, &random);
  AddOutliers(40, &random, &points);
  const FittedPlane fit = FitPlaneToDepths(Alone(points), 0.01f, 8, 1);
  EXPECT_EQ(NumInliers(fit, points), 60);
  const double norm = std::sqrt(0.3 * 0.3 + 0.2 * 0.2 + 1);
  ExpectPlane(fit.plane, {{0.3 / norm, -0.2 / norm, -1 / norm}, 4 / norm},
              1e-4);
  const FittedPlane again = FitPlaneToDepths(Alone(points), 0.01f, 8, 1);
  EXPECT_EQ(std::memcmp(&fit.plane, &again.plane, sizeof(Plane)), 0);
}

TEST(FitPlaneToDepths, HasTheLeastErrorsOfDepth) {
  std::mt19937 random(9);
  const std::vector<Vec3> points = PointsOnPlane(200, 0.02f, &random);
  const FittedPlane fit = FitPlaneToDepths(Alone(points), 0.05f, 8, 1);
  ASSERT_EQ(NumInliers(fit, points), 200);
  const auto sum_of_squares = [&points](const Plane& plane) {
    double sum = 0;
    for (const Vec3& point : points) {
      const double error =
          (Dot(plane.normal, point) + plane.distance) / plane.distance;
      sum += error * error;
    }
    return sum;
  };
  const double least = sum_of_squares(fit.plane);
  for (const float change : {-1e-3f, 1e-3f}) {
    Plane other = fit.plane;
    other.distance += change;
    EXPECT_GT(sum_of_squares(other), least);
    other = fit.plane;
    other.normal.x += change;
    EXPECT_GT(sum_of_squares(other), least);
    other = fit.plane;
    other.normal.y += change;
    EXPECT_GT(sum_of_squares(other), least);
  }
}

// A crowd in few groups says no more than its groups do.
TEST(FitPlaneToDepths, GroupsCountOnce) {
  std::mt19937 random(12);
  const std::vector<Vec3> points = PointsOnPlane(20, 0, &random);
  std::vector<PointGroup> groups = Alone(points);
  for (int i = 0; i < 10; ++i) {
    PointGroup crowd = PointsOnPlane(50, 0, &random);
    for (Vec3& point : crowd) {
      point.z += 1;
    }
    groups.push_back(crowd);
  }
  const FittedPlane fit = FitPlaneToDepths(groups, 0.01f, 8, 1);
  EXPECT_NEAR(fit.inlier_ratio, 20.0 / 30, 1e-6);
  for (const Vec3& point : points) {
    EXPECT_NEAR(Dot(fit.plane.normal, point), -fit.plane.distance, 1e-4);
  }
  EXPECT_EQ(FitPlaneToDepths(groups, 0.01f, 21, 1).inlier_ratio, 0);
  // A group counts for every plane that one of its points is on.
  for (size_t i = 20; i < groups.size(); ++i) {
    groups[i].push_back(points[i - 20]);
  }
  EXPECT_EQ(FitPlaneToDepths(groups, 0.01f, 21, 1).inlier_ratio, 1);
}

// The points of a group have the weight of one together.
TEST(FitPlaneToDepths, AveragesWithinGroups) {
  std::mt19937 random(14);
  std::vector<PointGroup> groups;
  for (const Vec3& point : PointsOnPlane(60, 0, &random)) {
    PointGroup group(99, point);
    group[0].z *= 1.01f;
    groups.push_back({point});
    groups.push_back(group);
    for (Vec3& other : groups.back()) {
      other.z += 0.02f;
    }
  }
  const FittedPlane fit = FitPlaneToDepths(groups, 0.02f, 8, 1);
  ASSERT_EQ(fit.inlier_ratio, 1);
  // Half way between the single ones and the crowds.
  const float depth = -fit.plane.distance / fit.plane.normal.z;
  EXPECT_NEAR(depth, 4.01, 0.002);
}

// Of two surfaces that are as large the one that its points are nearer to.
TEST(FitPlaneToDepths, PrefersSmallErrors) {
  std::mt19937 random(15);
  const std::vector<Vec3> exact = PointsOnPlane(50, 0, &random);
  std::vector<Vec3> points = PointsOnPlane(50, 0.02f, &random);
  for (Vec3& point : points) {
    point.z += 1;
  }
  points.insert(points.end(), exact.begin(), exact.end());
  for (uint64_t key = 0; key < 20; ++key) {
    const FittedPlane fit = FitPlaneToDepths(Alone(points), 0.01f, 8, key);
    EXPECT_NEAR(Dot(fit.plane.normal, exact[0]), -fit.plane.distance, 1e-3);
  }
}

TEST(FitPlaneToDepths, LeavesOutWhatIsNoNumber) {
  std::mt19937 random(16);
  std::vector<PointGroup> groups = Alone(PointsOnPlane(40, 0, &random));
  const FittedPlane expected = FitPlaneToDepths(groups, 0.01f, 40, 1);
  ASSERT_EQ(expected.inlier_ratio, 1);
  for (size_t i = 0; i < groups.size(); ++i) {
    groups[i].insert(i % 2 ? groups[i].begin() : groups[i].end(),
                     {kNan, 0, kInf});
  }
  const FittedPlane fit = FitPlaneToDepths(groups, 0.01f, 40, 1);
  EXPECT_EQ(fit.inlier_ratio, 1);
  EXPECT_NEAR(fit.plane.distance, expected.plane.distance, 1e-4);
}

TEST(FitPlaneToDepths, ThereIsNoneWithoutThreeDirections) {
  std::mt19937 random(10);
  std::vector<Vec3> line;
  std::vector<Vec3> edge_on;
  for (int i = 0; i < 50; ++i) {
    line.push_back({0.1f * i, 1, 3});
    edge_on.push_back({0.1f * i, 0, 3.0f + i % 7});
  }
  EXPECT_EQ(FitPlaneToDepths(Alone(line), 0.01f, 8, 1).inlier_ratio, 0);
  EXPECT_EQ(FitPlaneToDepths(Alone(edge_on), 0.01f, 8, 1).inlier_ratio, 0);
  EXPECT_EQ(FitPlaneToDepths({}, 0.01f, 8, 1).inlier_ratio, 0);
  EXPECT_EQ(FitPlaneToDepths(Alone(PointsOnPlane(7, 0, &random)), 0.01f, 8, 1)
                .inlier_ratio,
            0);
  EXPECT_EQ(FitPlaneToDepths(Alone(std::vector<Vec3>(20, {kNan, kInf, kNan})),
                             0.01f, 8, 1)
                .inlier_ratio,
            0);
}

}  // namespace
}  // namespace tapa
