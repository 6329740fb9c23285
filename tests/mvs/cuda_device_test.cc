// Tests of the backend on a GPU; without one they say that they are skipped,
// but they also run on the emulated one (emulated_cuda/emulator.h). This
// program is part of the bundle for machines on which nothing can be installed
// (scripts/gpu_bundle.sh), so it does without TAPA's stages and their OpenCV.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "src/mvs/backends.h"
#include "src/mvs/cuda/memory_plan.h"
#include "src/mvs/device_error.h"
#include "src/mvs/devices.h"
#include "src/mvs/estimate_depth.h"
#include "src/mvs/schedule.h"
#include "src/mvs/testing.h"
#include "tests/mvs/sweep_start.h"
#include "tests/mvs/synthetic.h"

namespace tapa {
namespace {

// The first GPU that can be used, or -1.
int FirstDevice() {
  const DeviceList list = FindDevices();
  for (size_t i = 0; i < list.devices.size(); ++i) {
    if (list.devices[i].unusable.empty()) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

class CudaDeviceTest : public testing::Test {
 protected:
  void SetUp() override {
    if (FirstDevice() < 0) {
      GTEST_SKIP() << "NO GPU TEST RAN: " << FindDevices().why_none;
    }
  }
};

SyntheticPlane MakeScene(int num_sources, int width = 96, int height = 72) {
  SyntheticOptions options;
  options.width = static_cast<int>(width * SceneScale());
  options.height = static_cast<int>(height * SceneScale());
  options.num_sources = num_sources;
  options.focal_length = 1.2 * options.width;
  options.wall = 0.4;
  options.noise = 2;
  return SyntheticPlane(options);
}

Options SweepOptions(bool geometric) {
  Options options;
  options.geom_consistency = geometric;
  options.filter = true;
  options.seed = 11;
  return options;
}

bool KeepGoing(double) { return true; }

// The first sweeps; the last of several checks consistency.
Estimate RunSweeps(Backend* backend, const Options& options,
                   const Problem& problem, const Start& start, int num_sweeps) {
  const Schedule schedule(options, static_cast<int>(problem.sources.size()),
                          /* has_start */ true);
  backend->SetEstimate(start.depth, start.normal, KeepGoing);
  for (int i = 0; i < num_sweeps; ++i) {
    SweepParams params = schedule.At(i);
    params.check_consistency = i + 1 == num_sweeps && num_sweeps > 1;
    backend->Sweep(params, KeepGoing);
  }
  return backend->TakeResult();
}

// Costs after one sweep.
std::vector<uint16_t> CostsAfterSweep(BackendForTesting* backend,
                                      const Options& options,
                                      const Problem& problem,
                                      const Start& start) {
  const Schedule schedule(options, static_cast<int>(problem.sources.size()),
                          /* has_start */ true);
  backend->SetEstimate(start.depth, start.normal, KeepGoing);
  backend->Sweep(schedule.At(0), KeepGoing);
  return backend->Costs();
}

// Sampled as precisely as on the CPU, costs are the same to 1e-3.
TEST_F(CudaDeviceTest, HasTheCostsOfTheCpu) {
  const SyntheticPlane scene = MakeScene(9);
  const Problem problem = scene.GeometricProblem();
  Options options = SweepOptions(true);
  const Start start = StartNearTruth(scene);
  const std::vector<uint16_t> expected =
      CostsAfterSweep(MakeCpuBackendForTesting(options, problem).get(), options,
                      problem, start);
  options.device = FirstDevice();
  CudaSwitches switches;
  switches.precise_textures = true;
  const std::vector<uint16_t> actual = CostsAfterSweep(
      MakeCudaBackendForTesting(options, problem, switches).get(), options,
      problem, start);
  ASSERT_EQ(actual.size(), expected.size());
  const int tolerance = EncodeCost(1e-3f) - EncodeCost(0);
  size_t num_same = 0;
  for (size_t i = 0; i < actual.size(); ++i) {
    num_same += std::abs(actual[i] - expected[i]) <= tolerance;
  }
  const double same = static_cast<double>(num_same) / actual.size();
  std::printf("the same costs: %.3f %%\n", 100 * same);
  // Where another draw decides, the costs are those of another plane.
  EXPECT_GE(same, 0.99);
}

// Share of the pixels where two estimates agree to the share `tolerance`.
double ShareOfSameDepths(const Map<float>& a, const Map<float>& b,
                         float tolerance) {
  size_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    count += std::abs(a.data()[i] - b.data()[i]) <= tolerance * b.data()[i];
  }
  return static_cast<double>(count) / a.size();
}

// The same choices after one sweep, with the sampling of the CPU and with that
// of the texture units.
TEST_F(CudaDeviceTest, MakesTheChoicesOfTheCpu) {
  for (const bool geometric : {false, true}) {
    const SyntheticPlane scene = MakeScene(geometric ? 9 : 20);
    const Problem problem =
        geometric ? scene.GeometricProblem() : scene.problem();
    Options options = SweepOptions(geometric);
    const Start start = StartNearTruth(scene);
    const Estimate expected = RunSweeps(MakeCpuBackend(options, problem).get(),
                                        options, problem, start, 1);
    options.device = FirstDevice();
    for (const bool precise : {true, false}) {
      CudaSwitches switches;
      switches.precise_textures = precise;
      const Estimate actual =
          RunSweeps(MakeCudaBackendForTesting(options, problem, switches).get(),
                    options, problem, start, 1);
      const double same =
          ShareOfSameDepths(actual.depth, expected.depth, 1e-4f);
      RecordProperty("same_choices", std::to_string(same));
      std::printf("geometric %d, precise %d: the same choice at %.3f %%\n",
                  geometric, precise, 100 * same);
      EXPECT_GE(same, precise ? 0.99 : 0.95);
    }
  }
}

// All kernels do the same: the naive one, that of any sizes, and all windows.
TEST_F(CudaDeviceTest, KernelsAgree) {
  struct Case {
    int num_sources;
    int window_radius;
    int window_step;
  };
  for (const Case c : {Case{6, 5, 2}, Case{40, 5, 2}, Case{6, 5, 1},
                       Case{5, 3, 1}, Case{5, 10, 2}, Case{3, 32, 1}}) {
    const SyntheticPlane scene = MakeScene(c.num_sources, 60, 45);
    Options options = SweepOptions(false);
    options.window_radius = c.window_radius;
    options.window_step = c.window_step;
    const Start start = StartNearTruth(scene);
    const Problem& problem = scene.problem();
    const Estimate expected = RunSweeps(MakeCpuBackend(options, problem).get(),
                                        options, problem, start, 1);
    options.device = FirstDevice();
    const Estimate actual = RunSweeps(MakeCudaBackend(options, problem).get(),
                                      options, problem, start, 1);
    EXPECT_GE(ShareOfSameDepths(actual.depth, expected.depth, 1e-4f), 0.95)
        << c.num_sources << " " << c.window_radius << " " << c.window_step;
    if (c.num_sources <= 32 && c.window_radius == 5 && c.window_step == 2) {
      CudaSwitches switches;
      switches.naive_kernel = true;
      const Estimate naive =
          RunSweeps(MakeCudaBackendForTesting(options, problem, switches).get(),
                    options, problem, start, 1);
      EXPECT_GE(ShareOfSameDepths(naive.depth, actual.depth, 1e-4f), 0.99);
    }
  }
}

// Masks, choices and probabilities after the last sweep.
TEST_F(CudaDeviceTest, ReportsConsistentViews) {
  const SyntheticPlane scene = MakeScene(9);
  Options options = SweepOptions(true);
  CudaSwitches switches;
  switches.precise_textures = true;
  options.tapa.enabled = true;
  const Start start = StartNearTruth(scene);
  const Problem problem = scene.GeometricProblem();
  const Estimate expected = RunSweeps(MakeCpuBackend(options, problem).get(),
                                      options, problem, start, 2);
  options.device = FirstDevice();
  const Estimate actual =
      RunSweeps(MakeCudaBackendForTesting(options, problem, switches).get(),
                options, problem, start, 2);
  ASSERT_EQ(actual.consistent.size(), expected.consistent.size());
  ASSERT_EQ(actual.selection_prob.size(), expected.selection_prob.size());
  ASSERT_EQ(actual.chosen.size(), expected.chosen.size());
  size_t same = 0;
  for (size_t i = 0; i < actual.chosen.size(); ++i) {
    same += actual.chosen.data()[i] == expected.chosen.data()[i] &&
            actual.consistent[2 * i] == expected.consistent[2 * i] &&
            actual.consistent[2 * i + 1] == expected.consistent[2 * i + 1];
  }
  EXPECT_GE(same, 0.95 * actual.chosen.size());
}

// The same seed gives the same maps.
TEST_F(CudaDeviceTest, IsDeterministic) {
  const SyntheticPlane scene = MakeScene(6);
  const Options options = [] {
    Options o = SweepOptions(false);
    o.device = FirstDevice();
    return o;
  }();
  const Start start = StartNearTruth(scene);
  const auto run = [&] {
    return RunSweeps(MakeCudaBackend(options, scene.problem()).get(), options,
                     scene.problem(), start, 4);
  };
  const Estimate a = run();
  const Estimate b = run();
  EXPECT_EQ(ShareOfSameDepths(a.depth, b.depth, 0), 1);
  EXPECT_TRUE(a.selection_prob == b.selection_prob);
  EXPECT_TRUE(a.consistent == b.consistent);
}

TEST_F(CudaDeviceTest, StopsSoon) {
  const SyntheticPlane scene = MakeScene(6);
  Options options = SweepOptions(false);
  options.device = FirstDevice();
  const auto backend = MakeCudaBackend(options, scene.problem());
  const Start start = StartNearTruth(scene);
  backend->SetEstimate(start.depth, start.normal, KeepGoing);
  int num_calls = 0;
  EXPECT_FALSE(backend->Sweep(Schedule(options, 6, true).At(0), [&](double) {
    ++num_calls;
    return false;
  }));
  EXPECT_EQ(num_calls, 1);
}

// These need no GPU.

TEST(CudaWithoutDevice, IsAnErrorThatCanBeCaught) {
  const SyntheticPlane scene = MakeScene(2);
  Options options = SweepOptions(false);
  options.device = 1000;
  EXPECT_THROW(MakeCudaBackend(options, scene.problem()), DeviceError);
}

// The figures of docs/design.md.
TEST(CudaMemory, IsAtMost200BytesPerPixelAt20Views) {
  const Map<uint8_t> image(3200, 2130);
  Problem problem;
  problem.reference.image = &image;
  problem.sources.resize(20);
  for (View& view : problem.sources) {
    view.image = &image;
  }
  const auto bytes_per_pixel = [&](bool geometric, bool tapa) {
    Options options;
    options.geom_consistency = geometric;
    options.tapa.enabled = tapa;
    return static_cast<double>(EstimateDepthDeviceMemory(options, problem)) /
           image.size();
  };
  EXPECT_NEAR(bytes_per_pixel(false, false), 113, 0.5);
  EXPECT_NEAR(bytes_per_pixel(true, false), 193, 0.5);
  EXPECT_NEAR(bytes_per_pixel(true, true), 199, 0.5);
  EXPECT_LE(bytes_per_pixel(true, true), 200);
}

}  // namespace
}  // namespace tapa
