// The CUDA backend's kernels on the host: lane by lane in an emulated warp, and
// compared with the CPU backend.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>

#include "src/mvs/cpu/sweep.h"
#include "tests/mvs/host_kernels.h"
#include "tests/mvs/sweep_start.h"
#include "tests/mvs/synthetic.h"

namespace tapa {
namespace {

TEST(HostWarp, FindsLanesThatMissEachOther) {
  EXPECT_THROW(HostWarp::Run([] {
                 if (HostWarp::Lane() != 7) {
                   HostWarp::Sync();
                 }
               }),
               std::logic_error);
  EXPECT_THROW(HostWarp::Run([] {
                 if (HostWarp::Lane() < 16) {
                   HostWarp::Sync();
                 } else {
                   HostWarp::Shuffle(0, 16, 32);
                   HostWarp::Shuffle(0, HostWarp::Lane(), 4);
                   HostWarp::Sync();
                 }
                 HostWarp::Sync();
               }),
               std::logic_error);
}

TEST(HostWarp, ShowsAMissingSync) {
  const auto sum_of_neighbours = [](uint32_t order, bool sync) {
    std::vector<int> shared(HostWarp::kSize, 0);
    std::vector<int> seen(HostWarp::kSize);
    HostWarp::Run(
        [&] {
          const int lane = HostWarp::Lane();
          shared[lane] = lane;
          if (sync) {
            HostWarp::Sync();
          }
          seen[lane] = shared[(lane + 1) % HostWarp::kSize];
        },
        order);
    return seen;
  };
  EXPECT_EQ(sum_of_neighbours(0, true), sum_of_neighbours(5, true));
  EXPECT_NE(sum_of_neighbours(0, false), sum_of_neighbours(5, false));
}

TEST(WarpLanes, SumAcrossLanes) {
  for (const int count : {1, 5, 20, 32, 33, 64, 77}) {
    std::vector<float> values(count);
    std::iota(values.begin(), values.end(), 1.0f);
    const float total = 0.5f * count * (count + 1);
    HostWarp::Run(
        [&] {
          const float sum = WarpLanes::Accumulate(count, values.data());
          EXPECT_EQ(sum, total);
        },
        3);
    for (int i = 0; i < count; ++i) {
      EXPECT_EQ(values[i], 0.5f * (i + 1) * (i + 2));
    }
  }
  HostWarp::Run([] {
    const int lane = WarpLanes::First();
    EXPECT_EQ(WarpLanes::Sum(lane), 496);
    EXPECT_EQ(WarpLanes::Sum(0.5f * lane), 248);
    // Groups meet on their own, as often as they like.
    if (WarpLanes::Group() != 2) {
      const int first = WarpLanes::Group() * WarpLanes::kGroupSize;
      EXPECT_EQ(WarpLanes::GroupSum(1.0f * lane), 4 * first + 6);
    }
  });
}

TEST(PackedPlane, KeepsNormals) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  double worst = 0;
  for (int i = 0; i < 100000; ++i) {
    Vec3 n = {normal(random), normal(random), normal(random)};
    // Axes and planes between them, too.
    for (float* c : {&n.x, &n.y, &n.z}) {
      *c = random() % 8 == 0 ? 0.0f : *c;
    }
    const float length = std::sqrt(Dot(n, n));
    if (length == 0) {
      continue;
    }
    n = (1 / length) * n;
    const Plane back = Unpack(Pack({2.5f, n}));
    EXPECT_EQ(back.depth, 2.5f);
    EXPECT_NEAR(Dot(back.normal, back.normal), 1, 1e-6);
    const Vec3 difference = back.normal - n;
    worst = std::max<double>(worst, std::sqrt(Dot(difference, difference)));
    // What was packed before comes back as the same code.
    EXPECT_EQ(PackNormal(back.normal), PackNormal(n));
  }
  EXPECT_LT(worst, 7e-5);
  EXPECT_EQ(Dot(UnpackNormal(kNoNormal), UnpackNormal(kNoNormal)), 0);
}

TEST(Textureness, KeepsOneHalfExactly) {
  EXPECT_EQ(DecodeTextureness(EncodeTextureness(0.5f)), 0.5f);
  EXPECT_EQ(DecodeTextureness(EncodeTextureness(1.0f)), 1.0f);
  for (float t = 0; t <= 1; t += 0.0123f) {
    EXPECT_NEAR(DecodeTextureness(EncodeTextureness(t)), t, 8e-6);
  }
}

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
  int window_step = 1;
  bool filter = false;

  friend void PrintTo(const CudaCase& c, std::ostream* out) { *out << c.name; }
};

// A problem with a start, and what the CPU backend makes of it.
struct CudaScene {
  explicit CudaScene(const CudaCase& c)
      : scene(SceneOptions(c)),
        problem(c.geometric ? scene.GeometricProblem() : scene.problem()),
        start(RoundNormals(StartNearTruth(scene))) {
    options.geom_consistency = c.geometric;
    options.filter = c.filter;
    options.window_radius = c.window_radius;
    options.window_step = c.window_step;
    options.seed = 11;
    params = MakeSweepParams(options, c.index);
    params.window_radius = static_cast<float>(c.window_radius);
    params.filter = c.filter;
    params.filter_min_prob = params.selection.Emission(0.9f);
    params.filter_cos_min_triangulation = std::cos(0.05f);
    params.filter_min_num_consistent = std::min(2, c.num_sources);
    std::mt19937 random(6);
    if (c.guided) {
      guide = MakeGuide(scene, &random);
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

  const SyntheticPlane scene;
  const Problem problem;
  const Start start;
  Options options;
  SweepParams params;
  SweepGuide guide;
};

class CudaSweepTest : public testing::TestWithParam<CudaCase> {};

// Shares of the pixels, or of the values, where two states agree.
struct Agreement {
  double choices = 0;
  double costs = 0;
  double probs = 0;
};

double ShareWithin(const std::vector<uint16_t>& actual,
                   const UninitializedVector<uint16_t>& expected,
                   int tolerance) {
  size_t count = 0;
  for (size_t i = 0; i < actual.size(); ++i) {
    count += std::abs(actual[i] - expected[i]) <= tolerance;
  }
  return static_cast<double>(count) / actual.size();
}

// 1e-4 in steps of the fixed point, and 3e-4 in those of probabilities.
constexpr int kCostTolerance = 4;
constexpr int kProbTolerance = 20;

template <class Kernels>
Agreement Compare(const Kernels& kernels, const SweepState& expected) {
  Agreement result;
  const size_t count = expected.depth.size();
  for (size_t i = 0; i < count; ++i) {
    const Plane actual = Unpack(kernels.planes()[i]);
    const Vec3 difference = actual.normal - expected.normal.data()[i];
    const float depth = expected.depth.data()[i];
    result.choices += std::abs(actual.depth - depth) <= 1e-4f * depth &&
                      Dot(difference, difference) < 1e-7f;
  }
  result.choices /= count;
  result.costs = ShareWithin(kernels.cost(), expected.cost, kCostTolerance);
  result.probs = ShareWithin(kernels.prob(), expected.prob, kProbTolerance);
  return result;
}

// After the last sweep.
template <class Kernels>
void ExpectSameSupport(const Kernels& kernels, const SweepState& expected,
                       int n) {
  const size_t count = expected.depth.size();
  const size_t mask_bytes = (n + 7) / 8;
  int num_same = 0;
  int num_filtered = 0;
  for (size_t i = 0; i < count; ++i) {
    const auto* bytes =
        reinterpret_cast<const uint8_t*>(kernels.cost().data() + i * n);
    const bool filtered = kernels.planes()[i].normal == kNoNormal;
    num_filtered += filtered;
    EXPECT_EQ(filtered, kernels.planes()[i].depth == 0);
    num_same += std::memcmp(bytes, expected.consistent.data() + i * mask_bytes,
                            mask_bytes) == 0 &&
                bytes[mask_bytes] == expected.chosen.data()[i] &&
                filtered == (expected.depth.data()[i] == 0);
  }
  EXPECT_GE(num_same, 0.99 * count);
  EXPECT_GT(num_filtered, 0.02 * count);
  EXPECT_LT(num_filtered, 0.98 * count);
}

template <class Lanes, class Sizes, bool kPrecise>
void ExpectAgreesWithCpu(const CudaCase& c, int piece_length, uint32_t order) {
  const CudaScene s(c);
  const ProblemData data(s.options, s.problem);
  SweepScratch scratch(data);
  SweepState expected(data, c.filter);
  expected.depth = s.start.depth;
  expected.normal = s.start.normal;
  expected.chosen = Map<uint8_t>(data.width, data.height);
  const auto go_on = [] { return true; };
  ComputeCosts(data, 0, data.height, go_on, &expected, &scratch);

  HostKernels<Lanes, Sizes, kPrecise> kernels(s.options, s.problem,
                                              piece_length, order);
  kernels.SetGuide(s.guide);
  kernels.SetEstimate(s.start.depth, s.start.normal);
  // Without noise, rounding decides what little texture correlates with.
  const Agreement first = Compare(kernels, expected);
  EXPECT_EQ(first.choices, 1);
  EXPECT_EQ(first.probs, 1);
  EXPECT_GE(first.costs, kPrecise ? 0.999 : 0.5);

  const auto direction = static_cast<Direction>(c.index % 4);
  SweepLines(data, s.params, s.guide, direction, 0, NumLines(data, direction),
             go_on, &expected, &scratch);
  kernels.Sweep(s.params);
  if (c.filter) {
    ExpectSameSupport(kernels, expected, data.num_sources);
    return;
  }
  // A draw or a tie that falls to the other side spreads to the next pixels of
  // the line; with a single view ties are frequent.
  const double share = data.num_sources == 1 ? 0.995 : 0.999;
  const Agreement after = Compare(kernels, expected);
  EXPECT_GE(after.choices, kPrecise ? share : 0.95);
  EXPECT_GE(after.costs, kPrecise ? share - 0.003 : 0.5);
  EXPECT_GE(after.probs, kPrecise ? 0.99 : 0.5);
}

TEST_P(CudaSweepTest, WarpAgreesWithCpu) {
  const CudaCase& c = GetParam();
  const WindowShape window = [&] {
    Options options;
    options.window_radius = c.window_radius;
    options.window_step = c.window_step;
    return WindowShape::FromOptions(options);
  }();
  if (CommonSizes::Fits(window, c.num_sources)) {
    ExpectAgreesWithCpu<WarpLanes, CommonSizes, true>(c, 8, 0);
  } else {
    ExpectAgreesWithCpu<WarpLanes, AnySizes, true>(c, 100, 9);
  }
}

TEST_P(CudaSweepTest, SerialKernelAgreesWithCpu) {
  ExpectAgreesWithCpu<SerialLanes, AnySizes, true>(GetParam(), 5, 0);
  ExpectAgreesWithCpu<SerialLanes, AnySizes, false>(GetParam(), 64, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Problems, CudaSweepTest,
    testing::Values(CudaCase{"Down"}, CudaCase{"Left", false, true, 5},
                    CudaCase{"Up", true, false, 2},
                    CudaCase{"Right", true, true, 11},
                    CudaCase{"OneView", true, false, 4, 1},
                    CudaCase{"ManyViews", false, false, 1, 35},
                    CudaCase{"SmallWindow", true, true, 3, 6, 3},
                    CudaCase{"Step2", false, false, 4, 5, 10, 2},
                    CudaCase{"Filter", true, false, 6, 9, 5, 1, true},
                    CudaCase{"FilterOneView", false, true, 7, 1, 5, 1, true}),
    [](const auto& info) { return info.param.name; });

// All template instances, and whatever the turns of the lanes and the pieces of
// the lines are.
TEST(CudaSweep, InstancesAgreeAndNoSyncIsMissing) {
  const CudaCase c{"", true, true, 1, 6};
  const CudaScene s(c);
  const auto run = [&](auto kernels) {
    kernels.SetGuide(s.guide);
    kernels.SetEstimate(s.start.depth, s.start.normal);
    kernels.Sweep(s.params);
    return kernels;
  };
  const auto same = [](const auto& a, const auto& b) {
    return a.cost() == b.cost() && a.prob() == b.prob() &&
           std::memcmp(a.planes().data(), b.planes().data(),
                       a.planes().size() * sizeof(PackedPlane)) == 0;
  };
  const auto common = run(
      HostKernels<WarpLanes, CommonSizes, true>(s.options, s.problem, 8, 0));
  const auto other = run(
      HostKernels<WarpLanes, CommonSizes, true>(s.options, s.problem, 11, 77));
  const auto any =
      run(HostKernels<WarpLanes, AnySizes, true>(s.options, s.problem, 40, 5));
  EXPECT_TRUE(same(common, other));
  EXPECT_TRUE(same(common, any));
  const auto filtered = run(
      HostKernels<WarpLanes, CommonSizes, false>(s.options, s.problem, 8, 3));
  const auto filtered_any =
      run(HostKernels<WarpLanes, AnySizes, false>(s.options, s.problem, 9, 4));
  EXPECT_TRUE(same(filtered, filtered_any));
  EXPECT_FALSE(same(common, filtered));
}

// The texture units' rounding moves costs by little.
TEST(CudaSweep, TextureUnitsChangeCostsByLittle) {
  const CudaScene s(CudaCase{""});
  HostKernels<SerialLanes, CommonSizes, true> precise(s.options, s.problem);
  HostKernels<SerialLanes, CommonSizes, false> rounded(s.options, s.problem);
  precise.SetEstimate(s.start.depth, s.start.normal);
  rounded.SetEstimate(s.start.depth, s.start.normal);
  int worst = 0;
  size_t num_close = 0;
  for (size_t i = 0; i < precise.cost().size(); ++i) {
    const int difference = std::abs(precise.cost()[i] - rounded.cost()[i]);
    worst = std::max(worst, difference);
    num_close += difference <= 10 * kCostTolerance;
  }
  // 1e-3 but where there is hardly any texture.
  EXPECT_GE(num_close, 0.99 * precise.cost().size());
  EXPECT_GT(worst, 0);
}

}  // namespace
}  // namespace tapa
