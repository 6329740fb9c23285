#include "src/eval/point_cloud_score.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "tests/eval/point_cloud_reference.h"

namespace tapa {
namespace {

struct Score {
  std::vector<double> completeness;
  std::vector<double> accuracy;
};

Score ScoreOf(const std::vector<Vec3>& reconstruction,
              const std::vector<LaserScan>& scans,
              const std::vector<double>& tolerances, double voxel_size,
              const BeamShape& beam, int num_threads = 2) {
  ThreadTeam team(num_threads);
  const std::vector<Vec3> points = MergeScans(scans, &team);
  const auto average = [&](const std::vector<Vec3>& of,
                           const std::vector<Verdict>& verdicts) {
    return AverageOverVoxels(of, verdicts, tolerances.size(), voxel_size,
                             &team);
  };
  return {average(points,
                  JudgeCompleteness(points, reconstruction, tolerances, &team)),
          average(reconstruction, JudgeAccuracy(reconstruction, scans,
                                                tolerances, beam, &team))};
}

std::vector<Verdict> AccuracyOf(const std::vector<Vec3>& reconstruction,
                                const std::vector<LaserScan>& scans,
                                const std::vector<double>& tolerances,
                                const BeamShape& beam) {
  ThreadTeam team(1);
  return JudgeAccuracy(reconstruction, scans, tolerances, beam, &team);
}

// Beams of constant width, which make sums exact.
constexpr BeamShape kStraightBeam = {0.0625, 0};

ScanPose At(double x, double y, double z) {
  ScanPose pose;
  pose.translation = {x, y, z};
  return pose;
}

// A wall at x = `distance`: a grid of points 1/8 apart, y and z within (-1, 1).
std::vector<Vec3> Wall(float distance) {
  std::vector<Vec3> points;
  for (int row = -7; row <= 7; ++row) {
    for (int col = -7; col <= 7; ++col) {
      points.push_back({distance, 0.125f * static_cast<float>(col),
                        0.125f * static_cast<float>(row)});
    }
  }
  return points;
}

TEST(PointCloudScoreTest, OneWall) {
  const std::vector<LaserScan> scans = {{Wall(4), {}}};
  const std::vector<double> tolerances = {0.125, 0.25, 0.5};
  // Wide enough that a quarter of a metre before or behind a measured point
  // along x is in its beam.
  const BeamShape beam = {0.125, 0};

  const Score exact = ScoreOf(Wall(4), scans, tolerances, 0.25, beam);
  EXPECT_EQ(exact.completeness, (std::vector<double>{1, 1, 1}));
  EXPECT_EQ(exact.accuracy, (std::vector<double>{1, 1, 1}));

  // In front of the wall, in space that the scanner found empty.
  const Score front = ScoreOf(Wall(3.75f), scans, tolerances, 0.25, beam);
  EXPECT_EQ(front.completeness, (std::vector<double>{0, 1, 1}));
  EXPECT_EQ(front.accuracy, (std::vector<double>{0, 1, 1}));

  // Behind it nothing is known but how far away the wall is.
  const Score behind = ScoreOf(Wall(4.25f), scans, {0.125, 0.25}, 0.25, beam);
  EXPECT_EQ(behind.completeness, (std::vector<double>{0, 1}));
  EXPECT_EQ(behind.accuracy, (std::vector<double>{0, 1}));
  for (const Verdict& verdict :
       AccuracyOf(Wall(4.25f), scans, {0.125, 0.25}, beam)) {
    EXPECT_FALSE(verdict.judged);
    EXPECT_EQ(verdict.first_good, 1);
  }
}

TEST(PointCloudScoreTest, DensityHasNoWeight) {
  // In one cube three points of which one is complete, in another one that is.
  // The shifted grid has the same groups.
  const std::vector<Vec3> measured = {{4.125f, 0.125f, 0},
                                      {4.125f, 0.25f, 0},
                                      {4.125f, 0.375f, 0},
                                      {4.125f, 5.125f, 0}};
  const std::vector<Vec3> reconstruction = {{4.125f, 0.125f, 0},
                                            {4.125f, 5.125f, 0}};
  const Score score =
      ScoreOf(reconstruction, {{measured, {}}}, {0.0625}, 1, kStraightBeam);
  EXPECT_DOUBLE_EQ(score.completeness[0], (1.0 / 3 + 1) / 2);
  EXPECT_EQ(score.accuracy[0], 1);
  EXPECT_DOUBLE_EQ(F1Score(score.completeness[0], score.accuracy[0]), 0.8);

  // The other way round: two of the three are in empty space.
  const std::vector<Vec3> cloud = {{4.125f, 0.125f, 0},
                                   {4.0f, 0.125f, 0},
                                   {4.0f, 0.25f, 0},
                                   {4.125f, 5.125f, 0}};
  EXPECT_DOUBLE_EQ(
      ScoreOf(cloud, {{measured, {}}}, {0.0625}, 1, kStraightBeam).accuracy[0],
      (1.0 / 3 + 1) / 2);
}

TEST(PointCloudScoreTest, ShiftedGrid) {
  // Two points in one cube of the first grid, in two of the second one.
  const std::vector<Vec3> measured = {{4, 0.25f, 0}, {4, 0.75f, 0}};
  const Score score =
      ScoreOf({{4, 0.25f, 0}}, {{measured, {}}}, {0.125}, 1, kStraightBeam);
  EXPECT_DOUBLE_EQ(score.completeness[0], (0.5 + 1 + 0) / 3);
}

TEST(PointCloudScoreTest, CubesBelowZero) {
  // -0.25 and 0.25 are in two cubes of the first grid, in one of the second.
  const std::vector<Vec3> measured = {{4, -0.25f, 0}, {4, 0.25f, 0}};
  const Score score =
      ScoreOf({{4, 0.25f, 0}}, {{measured, {}}}, {0.125}, 1, kStraightBeam);
  EXPECT_DOUBLE_EQ(score.completeness[0], (0 + 1 + 0.5) / 3);
}

TEST(PointCloudScoreTest, FreeSpace) {
  const std::vector<LaserScan> scans = {{{{4, 0, 0}}, {}}};
  const std::vector<double> tolerances = {0.25, 1, 2};
  const std::vector<Verdict> verdicts =
      AccuracyOf({{2, 0, 0},        // in the beam, in empty space
                  {2, 0.125f, 0},   // beside the beam
                  {-2, 0, 0},       // on the other side of the scanner
                  {4.5f, 0, 0},     // behind the point
                  {4, 0.0625f, 0},  // at the rim of the beam, beside the point
                  {4, 0.09375f, 0}},  // beyond the rim
                 scans, tolerances, kStraightBeam);
  const auto expect = [&](int i, int first_good, bool judged) {
    EXPECT_EQ(verdicts[i].first_good, first_good) << i;
    EXPECT_EQ(verdicts[i].judged, judged) << i;
  };
  expect(0, 2, true);
  expect(1, 3, false);
  expect(2, 3, false);
  expect(3, 1, false);
  expect(4, 0, false);
  expect(5, 3, false);
}

TEST(PointCloudScoreTest, TwoWallsAndAnOccluder) {
  // The far wall is at 4; a near one at 2 hides the part of it with y > 0.
  std::vector<Vec3> seen;
  for (const Vec3& point : Wall(4)) {
    const Vec3 near = {2, point.y / 2, point.z / 2};
    seen.push_back(point.y > 0 ? near : point);
  }
  const std::vector<double> tolerances = {0.125, 0.25};
  const BeamShape thin = {1.0 / 1024, 0};
  // Between the walls, once before the open part and once behind the occluder.
  const std::vector<Vec3> between = {{3, -0.375f, 0}, {3, 0.375f, 0}};
  const LaserScan first = {seen, {}};
  std::vector<Verdict> verdicts =
      AccuracyOf(between, {first}, tolerances, thin);
  EXPECT_TRUE(verdicts[0].judged);
  EXPECT_FALSE(verdicts[1].judged);
  EXPECT_EQ(verdicts[1].first_good, 2);

  // A second scanner, between the walls, sees that there is nothing.
  LaserScan second = {{{1, 0, 0}}, At(3, 0.375, 0)};
  second.pose.translation.x() = 2.5;
  verdicts = AccuracyOf(between, {first, second}, tolerances, thin);
  EXPECT_TRUE(verdicts[1].judged);
  EXPECT_EQ(verdicts[1].first_good, 2);

  // If it measures something there, that counts for more than all emptiness
  // that others see.
  second.points = {{0.625f, 0, 0}};
  verdicts = AccuracyOf(between, {first, second}, tolerances, thin);
  EXPECT_TRUE(verdicts[1].judged);
  EXPECT_EQ(verdicts[1].first_good, 0);
}

TEST(PointCloudScoreTest, PosesTurnScans) {
  // Two scanners that look at one place along x and along y of the world.
  LaserScan turned = {{{2, 0, 0}}, At(1, 1, 0)};
  turned.pose.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const std::vector<LaserScan> scans = {{{{2, 0, 0}}, At(-1, 3, 0)}, turned};
  ThreadTeam team(1);
  for (const Vec3& point : MergeScans(scans, &team)) {
    EXPECT_EQ(point.x, 1);
    EXPECT_EQ(point.y, 3);
    EXPECT_EQ(point.z, 0);
  }
  // Places that only the second and only the first one sees.
  const std::vector<Verdict> verdicts = AccuracyOf(
      {{1, 2, 0}, {0, 3, 0}, {2, 2, 0}}, scans, {0.5}, kStraightBeam);
  EXPECT_TRUE(verdicts[0].judged);
  EXPECT_TRUE(verdicts[1].judged);
  EXPECT_FALSE(verdicts[2].judged);
}

TEST(PointCloudScoreTest, BeamsWidenWithDistance) {
  // 45 degrees: at 2 m from the scanner the radius is 2 m.
  const std::vector<LaserScan> scans = {{{{10, 0, 0}}, {}}};
  const BeamShape wide = {0, 45};
  EXPECT_NEAR(wide.RadiusAt(2), 2, 1e-12);
  const std::vector<Verdict> verdicts =
      AccuracyOf({{1, 1, 0}, {0.5f, 1, 0}, {-0.5f, 1, 0}}, scans, {0.5}, wide);
  EXPECT_TRUE(verdicts[0].judged);
  EXPECT_TRUE(verdicts[1].judged);
  EXPECT_FALSE(verdicts[2].judged);  // Behind the scanner.
}

TEST(PointCloudScoreTest, DistancesEqualToATolerance) {
  const std::vector<Vec3> reconstruction = {{0, 0, 0.1f}};
  ThreadTeam team(1);
  for (const std::vector<double>& tolerances :
       {std::vector<double>{0.1}, std::vector<double>{0.1, 0.2}}) {
    EXPECT_EQ(JudgeCompleteness({{0, 0, 0}}, reconstruction, tolerances, &team)
                  .front()
                  .first_good,
              0);
  }
}

TEST(PointCloudScoreTest, NothingToJudge) {
  const std::vector<LaserScan> scans = {{Wall(4), {}}};
  const Score empty = ScoreOf({}, scans, {0.1, 0.5}, 0.25, kStraightBeam);
  EXPECT_EQ(empty.completeness, (std::vector<double>{0, 0}));
  EXPECT_EQ(empty.accuracy, (std::vector<double>{0, 0}));
  const Score elsewhere =
      ScoreOf({{-4, 0, 0}}, scans, {0.1, 0.5}, 0.25, kStraightBeam);
  EXPECT_EQ(elsewhere.accuracy, (std::vector<double>{0, 0}));
  EXPECT_EQ(F1Score(0, 0), 0);
  EXPECT_EQ(F1Score(0, 1), 0);
}

TEST(PointCloudScoreTest, PlacesAtTheScanner) {
  // Scanned points at the scanner have no beam; a reconstructed one there is in
  // all beams.
  const std::vector<LaserScan> scans = {{{{0, 0, 0}, {0, 0, 3}}, {}}};
  const std::vector<Verdict> verdicts =
      AccuracyOf(std::vector<Vec3>(3), scans, {0.5}, kStraightBeam);
  for (const Verdict& verdict : verdicts) {
    EXPECT_EQ(verdict.first_good, 1);
    EXPECT_TRUE(verdict.judged);
  }
  EXPECT_FALSE(
      AccuracyOf({{0, 0, 0}}, {{{{0, 0, 0}}, {}}}, {0.5}, kStraightBeam)[0]
          .judged);
}

// A room of 4 m with scanners in it, and a cloud of points on and near what
// they measured, in the air, behind the walls, and where directions are
// special: at the scanners, and above, below and behind them.
class RandomScene {
 public:
  explicit RandomScene(int seed) : random_(seed) {
    for (int i = 0; i < 3; ++i) AddScan();
    for (const LaserScan& scan : scans) AddReconstruction(scan);
  }

  std::vector<LaserScan> scans;
  std::vector<Vec3> reconstruction;

 private:
  static constexpr int kNumRays = 400;

  double Uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Eigen::Vector3d Place(double size) {
    return {Uniform(-size, size), Uniform(-size, size), Uniform(-size, size)};
  }
  static Vec3 ToVec3(const Eigen::Vector3d& point) {
    return {static_cast<float>(point.x()), static_cast<float>(point.y()),
            static_cast<float>(point.z())};
  }

  void AddScan() {
    LaserScan scan;
    scan.pose.rotation =
        (Eigen::AngleAxisd(Uniform(-3, 3), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(Uniform(-3, 3), Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    scan.pose.translation = Place(1);
    for (int i = 0; i < kNumRays; ++i) {
      const Eigen::Vector3d ray = Place(1).normalized();
      double length = 10;
      for (int axis = 0; axis < 3; ++axis) {
        const double wall = ray[axis] > 0 ? 2 : -2;
        length =
            std::min(length, (wall - scan.pose.translation[axis]) / ray[axis]);
      }
      scan.points.push_back(
          ToVec3(scan.pose.rotation.transpose() * (length * ray)));
    }
    scan.points.push_back({0, 0, 0});
    scan.points.push_back({0, 0, 1});
    scan.points.push_back({0, 0, -1});
    scan.points.push_back({-1, 0, 0});
    scan.points.push_back({-1, -0.0f, 0});
    scans.push_back(scan);
  }

  void AddReconstruction(const LaserScan& scan) {
    for (const Vec3& measured : scan.points) {
      const Vec3 world = scan.pose.ToWorld(measured);
      const Eigen::Vector3d point(world.x, world.y, world.z);
      const double draw = Uniform(0, 1);
      if (draw < 0.6) {
        reconstruction.push_back(ToVec3(point + Place(0.2)));
      } else if (draw < 0.8) {
        reconstruction.push_back(ToVec3(point * Uniform(0, 1.3)));
      } else {
        reconstruction.push_back(ToVec3(Place(2.5)));
      }
    }
    for (const Eigen::Vector3d& place :
         {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0, 0.5),
          Eigen::Vector3d(0, 0, -0.5), Eigen::Vector3d(-0.5, 0, 0),
          Eigen::Vector3d(-0.5, 1e-7, 0), Eigen::Vector3d(-0.5, -1e-7, 0),
          Eigen::Vector3d(1e-3, 1e-3, 1), Eigen::Vector3d(1e-3, 0, 0)}) {
      reconstruction.push_back(
          ToVec3(scan.pose.rotation * place + scan.pose.translation));
    }
  }

  std::mt19937 random_;
};

TEST(PointCloudScoreTest, AgreesWithTheReference) {
  const std::vector<double> tolerances = {0.02, 0.05, 0.1, 0.2, 0.5};
  const BeamShape beams[] = {{},       {0.01, 0.5}, {0.05, 0}, {0, 2},
                             {0.3, 5}, {0, 40},     {0, 80}};
  for (int seed = 0; seed < 7; ++seed) {
    SCOPED_TRACE(seed);
    const RandomScene scene(seed);
    const double voxel_size = seed % 2 == 0 ? 0.25 : 0.01;
    const reference::CloudScore expected = reference::ScorePointCloud(
        scene.reconstruction, scene.scans, tolerances, voxel_size, beams[seed]);
    const Score score = ScoreOf(scene.reconstruction, scene.scans, tolerances,
                                voxel_size, beams[seed]);
    for (size_t t = 0; t < tolerances.size(); ++t) {
      EXPECT_NEAR(score.completeness[t], expected.completeness[t], 1e-9);
      EXPECT_NEAR(score.accuracy[t], expected.accuracy[t], 1e-9);
    }
    // Every rule is at work, unless beams are so thin that they meet hardly any
    // point or so wide that they meet all.
    if (seed < 5) {
      EXPECT_GT(expected.num_unobserved, 20);
    }
    if (seed > 0) {
      EXPECT_GT(expected.num_accurate, 100);
      EXPECT_GT(expected.num_inaccurate, 100);
    }
  }
}

TEST(PointCloudScoreTest, ThreadsChangeNothing) {
  const RandomScene scene(1);
  const auto score = [&](int num_threads) {
    return ScoreOf(scene.reconstruction, scene.scans, {0.05, 0.2}, 0.1,
                   {0.01, 0.5}, num_threads);
  };
  const Score one = score(1);
  for (const int num_threads : {2, 3, 8}) {
    EXPECT_EQ(score(num_threads).completeness, one.completeness);
    EXPECT_EQ(score(num_threads).accuracy, one.accuracy);
  }
}

TEST(PointCloudScoreTest, FarAndManyEqualPoints) {
  // Neither the cubes nor the tree stumble.
  std::vector<Vec3> points(5000, Vec3{1, 2, 3});
  points.push_back({3e38f, -3e38f, 3e38f});
  points.push_back({-3e38f, 3e38f, 1e30f});
  const Score score = ScoreOf(points, {{points, {}}}, {0.01}, 0.01, {});
  EXPECT_EQ(score.completeness, (std::vector<double>{1}));
}

}  // namespace
}  // namespace tapa
