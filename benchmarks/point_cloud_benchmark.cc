// Speed of the point-cloud score next to naive references, in one run. The
// naive ones compare every point with every other one, so they score few.
//
// The case that counts is that of a million reconstructed points against two
// million scanned ones. Labels say how much memory the process had at most
// until then.

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "src/eval/point_cloud.h"
#include "src/eval/point_cloud_score.h"
#include "src/eval/voxel_average.h"
#include "tests/eval/point_cloud_reference.h"

namespace tapa {
namespace {

constexpr double kVoxelSize = 0.01;
const std::vector<double> kTolerances = {0.01, 0.02, 0.05, 0.1, 0.2, 0.5};

// Two scanners in a hall of 10 x 10 x 5 m, which turn like the instruments do,
// and a reconstruction of what they measured: most points within a centimetre
// or two, some anywhere, in no order.
struct Hall {
  Hall(int num_reconstructed, int num_scanned) {
    for (const double x : {-2, 2}) {
      LaserScan scan;
      scan.pose.translation = {x, 1, 0};
      AddRays(num_scanned / 2, &scan);
      scans.push_back(std::move(scan));
    }
    std::mt19937 random(1);
    std::normal_distribution<float> error(0, 0.01f);
    std::uniform_real_distribution<float> uniform(-5, 5);
    for (int i = 0; i < num_reconstructed; ++i) {
      if (i % 20 == 0) {
        reconstruction.push_back(
            {uniform(random), uniform(random), uniform(random) / 2});
        continue;
      }
      const LaserScan& scan = scans[i % 2];
      const Vec3 point =
          scan.pose.ToWorld(scan.points[random() % scan.points.size()]);
      reconstruction.push_back({point.x + error(random),
                                point.y + error(random),
                                point.z + error(random)});
    }
  }

  static void AddRays(int count, LaserScan* scan) {
    const int rows = static_cast<int>(std::sqrt(count / 2.0));
    for (int column = 0; column < 2 * rows; ++column) {
      for (int row = 0; row < rows; ++row) {
        const double azimuth = M_PI * column / rows;
        const double inclination = M_PI * (row + 0.5) / rows;
        const Eigen::Vector3d ray(std::sin(inclination) * std::cos(azimuth),
                                  std::sin(inclination) * std::sin(azimuth),
                                  std::cos(inclination));
        const Eigen::Vector3d half_size(5, 5, 2.5);
        double length = 100;
        for (int axis = 0; axis < 3; ++axis) {
          const double wall = std::copysign(half_size[axis], ray[axis]);
          if (ray[axis] == 0) continue;
          length = std::min(length,
                            (wall - scan->pose.translation[axis]) / ray[axis]);
        }
        const Eigen::Vector3d point = length * ray;
        scan->points.push_back({static_cast<float>(point.x()),
                                static_cast<float>(point.y()),
                                static_cast<float>(point.z())});
      }
    }
  }

  std::vector<Vec3> reconstruction;
  std::vector<LaserScan> scans;
};

void SetLabel(benchmark::State& state) {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  state.SetLabel(std::to_string(usage.ru_maxrss / 1024) + " MiB at most");
}

void BM_ScoreNaive(benchmark::State& state) {
  const Hall hall(static_cast<int>(state.range(0)),
                  static_cast<int>(state.range(1)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(reference::ScorePointCloud(
        hall.reconstruction, hall.scans, kTolerances, kVoxelSize, {}));
  }
}
BENCHMARK(BM_ScoreNaive)
    ->ArgNames({"points", "scanned"})
    ->Args({1000, 2000})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

// All of what the program does between reading and printing.
void Score(const Hall& hall, ThreadTeam* team) {
  {
    const std::vector<Vec3> points = MergeScans(hall.scans, team);
    const auto verdicts =
        JudgeCompleteness(points, hall.reconstruction, kTolerances, team);
    benchmark::DoNotOptimize(AverageOverVoxels(
        points, verdicts, kTolerances.size(), kVoxelSize, team));
  }
  const auto verdicts =
      JudgeAccuracy(hall.reconstruction, hall.scans, kTolerances, {}, team);
  benchmark::DoNotOptimize(AverageOverVoxels(
      hall.reconstruction, verdicts, kTolerances.size(), kVoxelSize, team));
}

void RunScore(benchmark::State& state) {
  const Hall hall(static_cast<int>(state.range(0)),
                  static_cast<int>(state.range(1)));
  ThreadTeam team(static_cast<int>(state.range(2)));
  for (auto _ : state) {
    Score(hall, &team);
  }
  SetLabel(state);
}

void BM_Score(benchmark::State& state) { RunScore(state); }
BENCHMARK(BM_Score)
    ->ArgNames({"points", "scanned", "threads"})
    ->Args({1000, 2000, 1})
    ->Args({1000000, 2000000, 1})
    ->Args({1000000, 2000000, 2})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

// The parts of it.
void BM_Completeness(benchmark::State& state) {
  const Hall hall(1000000, 2000000);
  ThreadTeam team(2);
  const std::vector<Vec3> points = MergeScans(hall.scans, &team);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        JudgeCompleteness(points, hall.reconstruction, kTolerances, &team));
  }
}
BENCHMARK(BM_Completeness)->Unit(benchmark::kMillisecond)->UseRealTime();

void BM_Accuracy(benchmark::State& state) {
  const Hall hall(1000000, 2000000);
  ThreadTeam team(2);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        JudgeAccuracy(hall.reconstruction, hall.scans, kTolerances, {}, &team));
  }
}
BENCHMARK(BM_Accuracy)->Unit(benchmark::kMillisecond)->UseRealTime();

void BM_AverageOverVoxels(benchmark::State& state) {
  const Hall hall(1000000, 1000);
  ThreadTeam team(2);
  const std::vector<Verdict> verdicts(hall.reconstruction.size(),
                                      Verdict{3, true});
  for (auto _ : state) {
    benchmark::DoNotOptimize(AverageOverVoxels(
        hall.reconstruction, verdicts, kTolerances.size(), kVoxelSize, &team));
  }
}
BENCHMARK(BM_AverageOverVoxels)->Unit(benchmark::kMillisecond)->UseRealTime();

void BM_ReadPointCloud(benchmark::State& state) {
  const Hall hall(1000000, 1000);
  const std::string path =
      (std::filesystem::temp_directory_path() / "point_cloud_benchmark.ply")
          .string();
  WriteColoredPoints(path, hall.reconstruction, [](size_t) { return Rgb(); });
  for (auto _ : state) {
    benchmark::DoNotOptimize(ReadPointCloud(path));
  }
  std::remove(path.c_str());
}
BENCHMARK(BM_ReadPointCloud)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tapa

BENCHMARK_MAIN();
