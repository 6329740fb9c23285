// Sweeps of the CUDA backend on an emulated GPU, compared with the CPU backend.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "src/mvs/cuda/layout.h"
#include "src/mvs/cuda/sweep_task.h"
#include "src/mvs/schedule.h"
#include "src/mvs/sweep/packed_depth_normal.h"
#include "src/mvs/testing.h"
#include "tests/mvs/emulated_cuda/emulator.h"
#include "tests/mvs/sweep_start.h"
#include "tests/mvs/synthetic.h"

namespace tapa {
namespace {

// Normals as they come back from the device's memory, so that both backends
// start with the same.
Start RoundNormals(Start start) {
  for (size_t i = 0; i < start.normal.size(); ++i) {
    Vec3& n = start.normal.data()[i];
    n = UnpackNormal(PackNormal(n));
  }
  return start;
}

struct CudaCase {
  const char* name;
  bool geometric = false;
  bool guided = false;
  int index = 0;
  int num_sources = 5;
  int window_radius = 5;
  int window_step = 2;
  bool filter = false;
  bool masked = false;

  friend void PrintTo(const CudaCase& c, std::ostream* out) { *out << c.name; }
};

// A problem with a start, and what the CPU backend makes of it.
struct CudaScene {
  explicit CudaScene(const CudaCase& c)
      : scene(SceneOptions(c)),
        problem(c.geometric ? scene.GeometricProblem() : scene.problem()),
        start(MakeStart(c, scene)) {
    options.geom_consistency = c.geometric;
    options.filter = c.filter;
    options.window_radius = c.window_radius;
    options.window_step = c.window_step;
    options.num_iterations = 5;
    options.seed = 11;
    options.tapa.enabled = c.guided || c.filter;
    params = Schedule(options, c.num_sources, true).At(c.index);
    params.check_consistency = c.filter;
    params.filter_min_prob = params.selection.Emission(0.9f);
    params.filter_cos_min_triangulation = std::cos(0.05f);
    params.filter_min_num_consistent = std::min(2, c.num_sources);
    std::mt19937 random(6);
    if (c.guided) {
      guide = MakeGuide(scene, &random);
      problem.prior = scene.depth();
      options.tapa.weight_range = guide.weight_range;
      for (size_t i = 0; i < guide.textureness.size(); ++i) {
        float& t = guide.textureness.data()[i];
        t = DecodeTextureness(EncodeTextureness(t));
      }
    }
  }

  static SyntheticOptions SceneOptions(const CudaCase& c) {
    SyntheticOptions options;
    options.width = 37;
    options.height = 29;
    options.focal_length = 45;
    options.num_sources = c.num_sources;
    return options;
  }

  // With a mask: blocks that lines run into and out of, within pieces and at
  // their ends.
  static Start MakeStart(const CudaCase& c, const SyntheticPlane& scene) {
    Start start = RoundNormals(StartNearTruth(scene));
    for (int row = 0; row < start.depth.height() && c.masked; ++row) {
      for (int col = 0; col < start.depth.width(); ++col) {
        if (row / 6 % 3 == 1 && col / 5 % 2 == 0) {
          start.depth.At(row, col) = 0;
          start.normal.At(row, col) = Vec3();
        }
      }
    }
    return start;
  }

  const SyntheticPlane scene;
  Problem problem;
  const Start start;
  Options options;
  SweepParams params;
  GuideMaps guide;
};

bool KeepGoing(double) { return true; }

// What a backend makes of a scene.
struct Outcome {
  std::vector<uint16_t> first_costs;
  std::vector<uint16_t> costs;
  Estimate estimate;
};

Outcome Run(const CudaScene& s, std::unique_ptr<BackendForTesting> backend) {
  Outcome outcome;
  if (s.options.tapa.enabled) {
    backend->SetTextureness(s.guide.textureness);
    backend->SetPlanes(s.guide.fine, s.guide.coarse);
    if (!s.problem.prior.empty()) {
      backend->SetDepthPrior(s.guide.depth_prior);
    }
  }
  EXPECT_TRUE(backend->SetEstimate(s.start.depth, s.start.normal, KeepGoing));
  outcome.first_costs = backend->Costs();
  EXPECT_TRUE(backend->Sweep(s.params, KeepGoing));
  outcome.costs = backend->Costs();
  outcome.estimate = backend->TakeResult();
  return outcome;
}

Outcome RunOnCpu(const CudaScene& s) {
  return Run(s, MakeCpuBackendForTesting(s.options, s.problem));
}

// The kernels that a problem can be swept by.
enum class Kernel { kUsual, kPrecise, kNaive };

Outcome RunOnGpu(const CudaScene& s, Kernel kernel,
                 const emulated_cuda::Settings& settings) {
  Options options = s.options;
  options.device = 0;
  CudaSwitches switches;
  switches.precise_textures = kernel == Kernel::kPrecise;
  switches.naive_kernel = kernel == Kernel::kNaive;
  emulated_cuda::Reset(settings);
  return Run(s, MakeCudaBackendForTesting(options, s.problem, switches));
}

template <class Values>
double ShareWithin(const Values& actual, const Values& expected,
                   int tolerance) {
  EXPECT_EQ(actual.size(), expected.size());
  size_t count = 0;
  for (size_t i = 0; i < actual.size(); ++i) {
    count += std::abs(actual[i] - expected[i]) <= tolerance;
  }
  return static_cast<double>(count) / actual.size();
}

// 1e-4 in steps of the fixed point, and 3e-4 in those of probabilities.
constexpr int kCostTolerance = 4;
constexpr int kProbTolerance = 20;

// Share of the pixels where two estimates have the same depth and normal.
double ShareOfSameChoices(const Estimate& actual, const Estimate& expected) {
  size_t count = 0;
  for (size_t i = 0; i < expected.depth.size(); ++i) {
    const Vec3 difference = actual.normal.data()[i] - expected.normal.data()[i];
    const float depth = expected.depth.data()[i];
    count += std::abs(actual.depth.data()[i] - depth) <= 1e-4f * depth &&
             Dot(difference, difference) < 1e-7f;
  }
  return static_cast<double>(count) / expected.depth.size();
}

// After the last sweep.
void ExpectSameMasks(bool exact, const Estimate& actual,
                     const Estimate& expected) {
  const size_t count = expected.depth.size();
  const size_t mask_bytes = expected.consistent.size() / count;
  ASSERT_EQ(actual.consistent.size(), expected.consistent.size());
  ASSERT_EQ(actual.chosen.size(), count);
  size_t num_same = 0;
  size_t num_filtered = 0;
  for (size_t i = 0; i < count; ++i) {
    const bool filtered = actual.depth.data()[i] == 0;
    num_filtered += filtered;
    num_same += std::memcmp(actual.consistent.data() + i * mask_bytes,
                            expected.consistent.data() + i * mask_bytes,
                            mask_bytes) == 0 &&
                actual.chosen.data()[i] == expected.chosen.data()[i] &&
                filtered == (expected.depth.data()[i] == 0);
  }
  EXPECT_GE(num_same, (exact ? 0.99 : 0.98) * count);
  EXPECT_GT(num_filtered, 0.02 * count);
  EXPECT_LT(num_filtered, 0.98 * count);
}

// exact: whether the emulated textures sample as the CPU does.
void ExpectAgrees(const CudaCase& c, bool exact, const Outcome& actual,
                  const Outcome& expected) {
  // Without noise, rounding decides what little texture correlates with, the
  // more so as few pixels of a window count where their colours differ and
  // where there is texture.
  EXPECT_GE(
      ShareWithin(actual.first_costs, expected.first_costs, kCostTolerance),
      exact ? 0.998 : 0.4);
  if (c.filter) {
    ExpectSameMasks(exact, actual.estimate, expected.estimate);
    return;
  }
  // A draw or a tie that falls to the other side, which is a third of all draws
  // of a pixel, spreads to the next pixels of the line; with a single view ties
  // are frequent.
  const double share = c.num_sources == 1 ? 0.99 : 0.993;
  EXPECT_GE(ShareOfSameChoices(actual.estimate, expected.estimate),
            exact ? share : 0.95);
  EXPECT_GE(ShareWithin(actual.costs, expected.costs, kCostTolerance),
            exact ? share - 0.003 : 0.4);
  // Where it spreads, the messages along the line are others, too.
  const double prob_share = c.num_sources == 1 ? 0.98 : 0.99;
  EXPECT_GE(ShareWithin(actual.estimate.selection_prob,
                        expected.estimate.selection_prob, kProbTolerance),
            exact ? prob_share : 0.5);
}

class CudaSweepTest : public testing::TestWithParam<CudaCase> {};

TEST_P(CudaSweepTest, AgreesWithCpu) {
  const CudaCase& c = GetParam();
  const CudaScene s(c);
  const Outcome expected = RunOnCpu(s);
  emulated_cuda::Settings settings;
  ExpectAgrees(c, true, RunOnGpu(s, Kernel::kPrecise, settings), expected);
  ExpectAgrees(c, false, RunOnGpu(s, Kernel::kUsual, settings), expected);
  settings.exact_filtering = true;
  settings.turns = 9;
  // Such that launches sweep two of three pieces, or all.
  settings.kilohertz = 150000;
  ExpectAgrees(c, true, RunOnGpu(s, Kernel::kUsual, settings), expected);
  if (CommonSizes::Fits(WindowShape(s.options), c.num_sources)) {
    ExpectAgrees(c, true, RunOnGpu(s, Kernel::kNaive, settings), expected);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Problems, CudaSweepTest,
    testing::Values(
        CudaCase{"Down"}, CudaCase{"Left", false, true, 5},
        CudaCase{"Up", true, false, 2}, CudaCase{"Right", true, true, 11},
        CudaCase{"OneView", true, false, 4, 1},
        CudaCase{"ManyViews", false, false, 1, 35},
        CudaCase{"SmallWindow", true, true, 3, 6, 3, 1},
        CudaCase{"Step2", false, false, 4, 5, 10, 2},
        CudaCase{"FullWindow", true, true, 3, 5, 5, 1},
        CudaCase{"Filter", true, false, 6, 9, 5, 2, true},
        CudaCase{"FilterOneView", false, true, 7, 1, 5, 2, true},
        CudaCase{"Masked", true, true, 8, 5, 5, 2, false, true},
        CudaCase{"MaskedLeft", false, false, 9, 5, 5, 2, false, true},
        CudaCase{"MaskedFilter", true, false, 6, 9, 5, 2, true, true}),
    [](const auto& info) { return info.param.name; });

bool IsSame(const Outcome& a, const Outcome& b) {
  return a.first_costs == b.first_costs && a.costs == b.costs &&
         a.estimate.selection_prob == b.estimate.selection_prob &&
         ShareOfSameChoices(a.estimate, b.estimate) == 1;
}

// Whatever the turns of threads, blocks and streams are, and however many
// pieces a launch sweeps: one, two of three, all.
void ExpectMissesNoSync(const CudaCase& c) {
  const CudaScene s(c);
  for (const Kernel kernel :
       {Kernel::kUsual, Kernel::kPrecise, Kernel::kNaive}) {
    emulated_cuda::Settings settings;
    const Outcome expected = RunOnGpu(s, kernel, settings);
    for (const int kilohertz : {100000, 150000, 1000000}) {
      settings.turns = kilohertz / 1000 + 1;
      settings.kilohertz = kilohertz;
      EXPECT_TRUE(IsSame(RunOnGpu(s, kernel, settings), expected));
    }
  }
}

TEST(CudaSweep, MissesNoSync) {
  ExpectMissesNoSync(CudaCase{"", true, true, 1, 6});
}

TEST(CudaSweep, MissesNoSyncBesideMaskedPixels) {
  ExpectMissesNoSync(CudaCase{"", true, true, 1, 6, 5, 2, false, true});
}

// The kernel for common sizes computes what that for any sizes does.
TEST(CudaSweep, KernelsAgree) {
  const CudaScene s(CudaCase{"", true, true, 1, 6});
  emulated_cuda::Settings settings;
  const Outcome precise = RunOnGpu(s, Kernel::kPrecise, settings);
  const Outcome rounded = RunOnGpu(s, Kernel::kUsual, settings);
  EXPECT_FALSE(IsSame(precise, rounded));
  settings.exact_filtering = true;
  const Outcome usual = RunOnGpu(s, Kernel::kUsual, settings);
  EXPECT_GE(ShareOfSameChoices(usual.estimate, precise.estimate), 0.999);
}

// The texture units' rounding moves costs by little.
TEST(CudaSweep, TextureUnitsChangeCostsByLittle) {
  const CudaScene s(CudaCase{""});
  const Outcome precise = RunOnGpu(s, Kernel::kPrecise, {});
  const Outcome rounded = RunOnGpu(s, Kernel::kUsual, {});
  // 1e-3 but where there is hardly any texture, or where so much that few
  // pixels count, over which rounding is not averaged.
  EXPECT_GE(ShareWithin(rounded.first_costs, precise.first_costs,
                        10 * kCostTolerance),
            0.96);
  EXPECT_FALSE(rounded.first_costs == precise.first_costs);
}

}  // namespace
}  // namespace tapa
