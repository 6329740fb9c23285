// Speed of the engine's hot paths next to naive references, in one run:
//
//   engine_benchmark                    everything
//   engine_benchmark --benchmark_filter=Correlation

#include <benchmark/benchmark.h>
#include <hwy/targets.h>

#include <cmath>
#include <random>
#include <thread>
#include <vector>

#include "benchmarks/naive_correlation.h"
#include "src/mvs/cpu/sweep.h"
#include "src/mvs/estimate_depth.h"
#include "src/mvs/levels.h"
#include "tests/mvs/synthetic.h"

namespace tapa {
namespace {

SyntheticPlane MakeScene(int width, int height, int num_sources) {
  SyntheticOptions options;
  options.width = width;
  options.height = height;
  options.num_sources = num_sources;
  options.focal_length = width;
  options.baseline = 0.3;
  return SyntheticPlane(options);
}

// Warps of random pixels to random views with planes near the truth, as a sweep
// meets them.
struct CorrelationWork {
  struct Item {
    int row;
    int col;
    int m;
    Warp warp;
  };

  CorrelationWork(const Options& options, const SyntheticPlane& scene)
      : data(options, scene.problem()), patch(data.window) {
    const RefCamera camera = data.cameras.reference();
    const SourceCameras views = data.cameras.sources();
    std::mt19937 random(1);
    std::uniform_real_distribution<float> factor(0.95f, 1.05f);
    for (int i = 0; i < 256; ++i) {
      Item item;
      item.row = 40 + random() % (data.height - 80);
      item.col = 40 + random() % (data.width - 80);
      item.m = random() % data.num_sources;
      const DepthNormal plane = {
          factor(random) * scene.depth().At(item.row, item.col),
          scene.normal()};
      item.warp = ComputeWarp(
          views, item.m, item.row, item.col,
          HomographyVector(camera, plane, camera.Ray(item.row, item.col)));
      items.push_back(item);
    }
    PreparePatch(data, items[0].row, items[0].col, &patch);
  }

  ProblemData data;
  Patch patch;
  std::vector<Item> items;
};

Options WindowOptions(const benchmark::State& state) {
  Options options;
  options.window_radius = static_cast<int>(state.range(0));
  // All samples count, whatever the texture.
  options.search.sigma_textured = -1;
  return options;
}

void BM_CorrelationNaive(benchmark::State& state) {
  const SyntheticPlane scene = MakeScene(640, 480, 4);
  const CorrelationWork work(WindowOptions(state), scene);
  size_t i = 0;
  for (auto _ : state) {
    const auto& item = work.items[i++ % work.items.size()];
    benchmark::DoNotOptimize(NaiveCorrelationCost(
        work.data.window, work.patch, *scene.problem().sources[item.m].image,
        item.warp));
  }
}
BENCHMARK(BM_CorrelationNaive)->ArgName("radius")->Arg(3)->Arg(5)->Arg(10);

// Restricts the engine to one instruction set; 0 allows all.
void UseInstructionSet(int64_t target) {
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

// range(1): Highway's number of the instruction set.
void BM_Correlation(benchmark::State& state) {
  UseInstructionSet(state.range(1));
  const SyntheticPlane scene = MakeScene(640, 480, 4);
  const CorrelationWork work(WindowOptions(state), scene);
  size_t i = 0;
  for (auto _ : state) {
    const auto& item = work.items[i++ % work.items.size()];
    benchmark::DoNotOptimize(
        PhotometricCost(work.data, work.patch, item.warp, item.m));
  }
  state.SetLabel(InstructionSet());
  UseInstructionSet(0);
}
BENCHMARK(BM_Correlation)->Apply([](auto* b) {
  b->ArgNames({"radius", "target"});
  for (const int radius : {3, 5, 10}) {
    for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
      b->Args({radius, target});
    }
  }
});

void BM_PreparePatch(benchmark::State& state) {
  const SyntheticPlane scene = MakeScene(640, 480, 1);
  CorrelationWork work(WindowOptions(state), scene);
  size_t i = 0;
  for (auto _ : state) {
    const auto& item = work.items[i++ % work.items.size()];
    PreparePatch(work.data, item.row, item.col, &work.patch);
    benchmark::DoNotOptimize(work.patch.variance);
  }
}
BENCHMARK(BM_PreparePatch)->ArgName("radius")->Arg(5);

Options PassOptions(int num_threads) {
  Options options;
  options.num_iterations = 1;
  options.num_threads = num_threads;
  options.geom_consistency = false;
  options.filter = false;
  return options;
}

// CPU time and wall time per megapixel and sweep of a photometric pass.
void SetSweepCounters(benchmark::State& state, const Problem& problem,
                      int num_estimates) {
  const double sweeps = 1e-6 * problem.reference.image->size() * 4 *
                        num_estimates * state.iterations();
  state.counters["s_per_megapixel_sweep"] = benchmark::Counter(
      sweeps, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void BM_Pass(benchmark::State& state) {
  const SyntheticPlane scene = MakeScene(320, 240, 10);
  for (auto _ : state) {
    benchmark::DoNotOptimize(EstimateDepth(
        PassOptions(static_cast<int>(state.range(0))), scene.problem()));
  }
  SetSweepCounters(state, scene.problem(), 1);
}
BENCHMARK(BM_Pass)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Repetitions(5)
    ->ReportAggregatesOnly()
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

// Two estimations of one thread each at the same time: what two threads can
// reach on these cores at best.
void BM_TwoPassesSideBySide(benchmark::State& state) {
  const SyntheticPlane scene = MakeScene(320, 240, 10);
  const auto run = [&] {
    benchmark::DoNotOptimize(EstimateDepth(PassOptions(1), scene.problem()));
  };
  for (auto _ : state) {
    std::thread other(run);
    run();
    other.join();
  }
  SetSweepCounters(state, scene.problem(), 2);
}
BENCHMARK(BM_TwoPassesSideBySide)
    ->Repetitions(5)
    ->ReportAggregatesOnly()
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

// What a level costs per megapixel: the hand-up from half the size, and a
// photometric and a geometric pass with the numbers of a level that is not the
// coarsest. Next to it, with `colmap` 1, what COLMAP does on its only level:
// five iterations in both passes, 15 views, full windows, all hypotheses.
void BM_Level(benchmark::State& state) {
  const bool colmap = state.range(0) != 0;
  const SyntheticPlane scene = MakeScene(160, 120, 10);
  Options options;
  options.num_threads = 1;
  options.filter = false;
  options.first_perturbation = colmap ? 1 : 1.0 / 128;
  if (colmap) {
    options.num_samples = 15;
    options.window_step = 1;
    options.search.try_all = true;
    options.search.measure_all = true;
    options.search.hysteresis = 0;
    options.search.sigma_textured = -1;
    options.sigma_color = 0.2;
  }
  const View& reference = scene.problem().reference;
  const Problem truth = scene.GeometricProblem();
  const Map<float> coarse_depth = ReduceDepth(truth.depth, 80, 60);
  const Map<Vec3> coarse_normal(80, 60, scene.normal());
  Camera coarse_camera = reference.camera;
  for (double* value : {&coarse_camera.fx, &coarse_camera.fy, &coarse_camera.cx,
                        &coarse_camera.cy}) {
    *value /= 2;
  }
  for (auto _ : state) {
    Problem photometric = scene.problem();
    if (!colmap) {
      DepthNormalMaps start =
          HandUp({coarse_depth, coarse_normal}, coarse_camera, reference);
      photometric.depth = std::move(start.depth);
      photometric.normal = std::move(start.normal);
    }
    options.geom_consistency = false;
    options.num_iterations = colmap ? 5 : 1;
    std::optional<Estimate> estimate = EstimateDepth(options, photometric);
    Problem geometric = truth;
    geometric.depth = std::move(estimate->depth);
    geometric.normal = std::move(estimate->normal);
    options.geom_consistency = true;
    options.num_iterations = colmap ? 5 : 2;
    benchmark::DoNotOptimize(EstimateDepth(options, geometric));
  }
  state.counters["s_per_megapixel"] = benchmark::Counter(
      1e-6 * reference.image->size() * state.iterations(),
      benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(BM_Level)->ArgName("colmap")->Arg(1)->Arg(0)->Unit(
    benchmark::kMillisecond);

}  // namespace
}  // namespace tapa

BENCHMARK_MAIN();
