// Speed of TAPA's stages at one megapixel next to naive references, in one run.
// Superpixels, means over similar pixels, the drawing of planes, sightings,
// silhouettes, regions and the consensus have none: the first two are OpenCV's,
// as is most of the last, the third is one table look-up for every pixel, and
// the others ask all that a reference would.

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <vector>

#include "src/mvs/camera_table.h"
#include "src/mvs/sweep/random.h"
#include "src/mvs/tapa/consensus.h"
#include "src/mvs/tapa/fill.h"
#include "src/mvs/tapa/region_planes.h"
#include "src/mvs/tapa/sightings.h"
#include "src/mvs/tapa/silhouettes.h"
#include "src/mvs/tapa/similar_mean.h"
#include "src/mvs/tapa/speckles.h"
#include "src/mvs/tapa/superpixel_planes.h"
#include "src/mvs/tapa/superpixels.h"
#include "src/mvs/tapa/textureness.h"
#include "tests/mvs/synthetic.h"
#include "tests/mvs/tapa_reference.h"

namespace tapa {
namespace {

constexpr int kWidth = 1200;
constexpr int kHeight = 840;
constexpr int kFine = kWidth / 20;
constexpr int kCoarse = kWidth / 30;

// A view as an iteration leaves it: a fifth of the depths is anywhere, another
// fifth is missing.
struct Work {
  Work() : scene(MakeOptions()) {
    camera = CameraTable(scene.problem()).reference();
    image = *scene.problem().reference.image;
    color = Map<Rgb>(kWidth, kHeight);
    depth = scene.depth();
    normal = Map<Vec3>(kWidth, kHeight, scene.normal());
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (size_t i = 0; i < depth.size(); ++i) {
      const uint8_t value = image.data()[i];
      color.data()[i] = {value, static_cast<uint8_t>(255 - value), value};
      const float draw = uniform(random);
      if (draw < 0.2f) {
        depth.data()[i] = 2 + 6 * uniform(random);
      } else if (draw < 0.4f) {
        depth.data()[i] = 0;
      } else {
        depth.data()[i] *= 1 + 0.01f * (uniform(random) - 0.5f);
      }
    }
    superpixels = ComputeSuperpixels(color, kFine);
  }

  static SyntheticOptions MakeOptions() {
    SyntheticOptions options;
    options.width = kWidth;
    options.height = kHeight;
    options.focal_length = kWidth;
    options.num_sources = 1;
    options.wall = 0.5;
    options.noise = 2;
    return options;
  }

  static const Work& Get() {
    static const Work work;
    return work;
  }

  SyntheticPlane scene;
  RefCamera camera;
  Map<uint8_t> image;
  Map<Rgb> color;
  Map<float> depth;
  Map<Vec3> normal;
  Superpixels superpixels;
};

void BM_TexturenessNaive(benchmark::State& state) {
  const Work& work = Work::Get();
  Map<float> textureness(kWidth, kHeight);
  for (auto _ : state) {
    for (int row = 0; row < kHeight; ++row) {
      for (int col = 0; col < kWidth; ++col) {
        textureness.At(row, col) = static_cast<float>(
            reference::Textureness(work.image, row, col, TexturenessOptions()));
      }
    }
    benchmark::DoNotOptimize(textureness.data());
  }
}
BENCHMARK(BM_TexturenessNaive)->Unit(benchmark::kMillisecond);

void BM_Textureness(benchmark::State& state) {
  const Work& work = Work::Get();
  for (auto _ : state) {
    benchmark::DoNotOptimize(ComputeTextureness(work.image));
  }
}
BENCHMARK(BM_Textureness)->Unit(benchmark::kMillisecond);

void BM_Superpixels(benchmark::State& state) {
  const Work& work = Work::Get();
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        ComputeSuperpixels(work.color, static_cast<int>(state.range(0))));
  }
}
BENCHMARK(BM_Superpixels)
    ->ArgName("count")
    ->Arg(kFine)
    ->Arg(kCoarse)
    ->Unit(benchmark::kMillisecond);

void BM_FindNeighbors(benchmark::State& state) {
  const Work& work = Work::Get();
  for (auto _ : state) {
    benchmark::DoNotOptimize(FindNeighbors(work.color, work.superpixels.labels,
                                           work.superpixels.count()));
  }
}
BENCHMARK(BM_FindNeighbors)->Unit(benchmark::kMillisecond);

SyntheticOptions WithTenSources() {
  SyntheticOptions options = Work::MakeOptions();
  options.num_sources = 10;
  return options;
}

// Where nothing is known, with ten source views: the most that it can take.
void BM_Sightings(benchmark::State& state) {
  const SyntheticPlane scene(WithTenSources());
  const Problem problem = scene.GeometricProblem();
  const Map<float> nothing(kWidth, kHeight);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        FindSightings(Options(), problem, Control(), nothing, nothing));
  }
}
BENCHMARK(BM_Sightings)->Unit(benchmark::kMillisecond);

constexpr Continuity kContinuity = {0.5f, 0};
constexpr int kMaxSpeckle = kWidth * kHeight / 5000;

void BM_SpecklesNaive(benchmark::State& state) {
  for (auto _ : state) {
    Map<float> depth = Work::Get().depth;
    reference::RemoveSpeckles(kContinuity, kMaxSpeckle, &depth);
    benchmark::DoNotOptimize(depth.data());
  }
}
BENCHMARK(BM_SpecklesNaive)->Unit(benchmark::kMillisecond);

void BM_Speckles(benchmark::State& state) {
  for (auto _ : state) {
    Map<float> depth = Work::Get().depth;
    RemoveSpeckles(kContinuity, kMaxSpeckle, &depth);
    benchmark::DoNotOptimize(depth.data());
  }
}
BENCHMARK(BM_Speckles)->Unit(benchmark::kMillisecond);

// RANSAC as in the book: as many trials whatever is found, all points counted
// each time, and a decomposition of all inliers at the end.
reference::DoublePlane FitPlaneNaive(const std::vector<Vec3>& points,
                                     double max_distance) {
  constexpr int kNumTrials = 300;
  const auto is_inlier = [&](const reference::DoublePlane& plane,
                             const Vec3& point) {
    return reference::DistanceTo(plane, point) <= max_distance;
  };
  reference::DoublePlane best;
  int best_count = 0;
  for (int trial = 0; trial < kNumTrials; ++trial) {
    const Random random(1, trial, 0);
    std::vector<Vec3> three;
    for (int i = 0; i < 3; ++i) {
      three.push_back(
          points[static_cast<size_t>(random.Uniform(i) * points.size())]);
    }
    const reference::DoublePlane plane = reference::FitLeastSquares(three);
    int count = 0;
    for (const Vec3& point : points) {
      count += is_inlier(plane, point);
    }
    if (count > best_count) {
      best = plane;
      best_count = count;
    }
  }
  std::vector<Vec3> inliers;
  for (const Vec3& point : points) {
    if (is_inlier(best, point)) {
      inliers.push_back(point);
    }
  }
  return reference::FitLeastSquares(inliers);
}

constexpr double kPlaneDistance = 0.04;

void BM_FitPlanesNaive(benchmark::State& state) {
  const Work& work = Work::Get();
  for (auto _ : state) {
    for (int k = 0; k < work.superpixels.count(); ++k) {
      std::vector<Vec3> points;
      for (int row = 0; row < kHeight; ++row) {
        for (int col = 0; col < kWidth; ++col) {
          if (work.superpixels.labels.At(row, col) == k &&
              work.depth.At(row, col) > 0) {
            points.push_back(work.depth.At(row, col) *
                             work.camera.Ray(row, col));
          }
        }
      }
      benchmark::DoNotOptimize(FitPlaneNaive(points, kPlaneDistance));
    }
  }
}
BENCHMARK(BM_FitPlanesNaive)->Unit(benchmark::kMillisecond);

std::vector<FittedPlane> FitPlanesOfWork() {
  const Work& work = Work::Get();
  TapaOptions options;
  options.plane_distance = kPlaneDistance;
  return FitPlanes(options, work.camera, work.depth, work.superpixels, 1);
}

void BM_FitPlanes(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(FitPlanesOfWork());
  }
}
BENCHMARK(BM_FitPlanes)->Unit(benchmark::kMillisecond);

void BM_DrawPlanes(benchmark::State& state) {
  const Work& work = Work::Get();
  const std::vector<FittedPlane> planes = FitPlanesOfWork();
  for (auto _ : state) {
    benchmark::DoNotOptimize(DrawPlanes(work.superpixels, planes, 1, 0));
  }
}
BENCHMARK(BM_DrawPlanes)->Unit(benchmark::kMillisecond);

template <typename Fill>
void RunFill(benchmark::State& state, const Fill& fill) {
  const Work& work = Work::Get();
  for (auto _ : state) {
    Map<float> depth = work.depth;
    Map<Vec3> normal = work.normal;
    fill(FillOptions(), work.camera, work.image, &depth, &normal);
    benchmark::DoNotOptimize(depth.data());
  }
}

void BM_FillNaive(benchmark::State& state) {
  RunFill(state, reference::FillMissing);
}
BENCHMARK(BM_FillNaive)->Unit(benchmark::kMillisecond);

void BM_Fill(benchmark::State& state) { RunFill(state, FillMissing); }
BENCHMARK(BM_Fill)->Unit(benchmark::kMillisecond);

void BM_SimilarMean(benchmark::State& state) {
  const Work& work = Work::Get();
  const Map<float> weights(kWidth, kHeight, 1);
  for (auto _ : state) {
    benchmark::DoNotOptimize(MeanOverSimilarPixels(
        work.image, work.depth, weights, kWidth / 10, 0.00005));
  }
}
BENCHMARK(BM_SimilarMean)->Unit(benchmark::kMillisecond);

// A step of completion, on maps of its own each time.
template <typename Step>
void RunStep(benchmark::State& state, const Step& step) {
  const Work& work = Work::Get();
  for (auto _ : state) {
    state.PauseTiming();
    Map<float> depth = work.depth;
    Map<Vec3> normal = work.normal;
    Map<uint8_t> origin(kWidth, kHeight);
    state.ResumeTiming();
    step(&depth, &normal, &origin);
  }
}

// Texture in every 24th column, so that half of the pixels ask.
void BM_Silhouettes(benchmark::State& state) {
  const Work& work = Work::Get();
  Map<float> textureness(kWidth, kHeight, 0.2f);
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; col += 24) {
      textureness.At(row, col) = 0.9f;
    }
  }
  RunStep(
      state, [&](Map<float>* depth, Map<Vec3>* normal, Map<uint8_t>* origin) {
        MendSilhouettes(Options(), work.scene.problem(), Control(), work.camera,
                        work.color, textureness, depth, normal, origin);
      });
}
BENCHMARK(BM_Silhouettes)->Unit(benchmark::kMillisecond);

// Tiles of one colour in frames with texture, and ten source views with texture
// on three quarters.
void BM_Regions(benchmark::State& state) {
  const Work& work = Work::Get();
  const SyntheticPlane scene(WithTenSources());
  const Problem problem = scene.GeometricProblem();
  const Map<Rgb> color(kWidth, kHeight, {120, 120, 120});
  Map<float> textureness(kWidth, kHeight, 0.2f);
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; ++col) {
      if (row % 120 < 6 || col % 120 < 6) {
        textureness.At(row, col) = 0.9f;
      }
    }
  }
  RunStep(state,
          [&](Map<float>* depth, Map<Vec3>* normal, Map<uint8_t>* origin) {
            CompleteRegions(Options(), problem, Control(), work.camera, color,
                            textureness, depth, normal, origin);
          });
}
BENCHMARK(BM_Regions)->Unit(benchmark::kMillisecond);

// Two fifths of the pixels are outvoted or have nothing, and ten source views
// say what they become.
void BM_Consensus(benchmark::State& state) {
  const SyntheticPlane scene(WithTenSources());
  const Problem problem = scene.GeometricProblem();
  Options options;
  options.num_threads = 1;
  RunStep(state, [&](Map<float>* depth, Map<Vec3>* normal, Map<uint8_t>*) {
    ReachConsensus(options, problem, Control(), depth, normal);
  });
}
BENCHMARK(BM_Consensus)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tapa

BENCHMARK_MAIN();
