#include "src/mvs/cpu/sweep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <ostream>
#include <random>
#include <string>

#include "src/mvs/camera_table.h"
#include "src/mvs/estimate_depth.h"
#include "src/mvs/schedule.h"
#include "src/mvs/sweep/sweep_pixel.h"
#include "src/mvs/sweep/texture_weights.h"
#include "src/mvs/tapa/textureness.h"
#include "tests/mvs/reference.h"
#include "tests/mvs/sweep_start.h"
#include "tests/mvs/synthetic.h"

namespace tapa {
namespace {

TEST(ViewSelection, AgreesWithReferenceAlongALine) {
  const Options options;
  const ViewSelection selection = ViewSelection::FromSigma(options.ncc_sigma);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  // Visible and occluded stretches, then costs without any order.
  std::vector<double> costs;
  for (int i = 0; i < 400; ++i) {
    const double mean = i > 300 ? 1.0 : (i / 70) % 2 ? 0.9 : 0.2;
    const double spread = i > 300 ? 2.0 : 0.4;
    costs.push_back(
        std::clamp(mean + spread * (uniform(random) - 0.5), 0.0, 2.0));
  }
  float forward = ViewSelection::kBorderMessage;
  double expected_forward = 0.5;
  float backward = ViewSelection::kBorderMessage;
  double expected_backward = 0.5;
  for (size_t i = 0; i < costs.size(); ++i) {
    const float cost = static_cast<float>(costs[i]);
    const double emission = reference::Emission(options, cost);
    EXPECT_NEAR(selection.Emission(cost), emission, 1e-6);
    forward = ViewSelection::Forward(selection.Emission(cost), forward);
    expected_forward = reference::ForwardMessage(emission, expected_forward);
    EXPECT_NEAR(forward / (1 + forward), expected_forward, 1e-5);
    backward = ViewSelection::Backward(selection.Emission(cost), backward);
    expected_backward = reference::BackwardMessage(emission, expected_backward);
    EXPECT_NEAR(backward / (1 + backward), expected_backward, 1e-5);
    const double previous = uniform(random);
    EXPECT_NEAR(ViewSelection::Probability(forward, backward,
                                           static_cast<float>(previous), 0.3f),
                reference::SelectionProb(expected_forward, expected_backward,
                                         previous, 0.3),
                1e-5);
  }
}

TEST(ViewSelection, LikelihoodHasTheKnownConstants) {
  const ViewSelection selection = ViewSelection::FromSigma(0.6);
  // The filter's threshold: the likelihood of NCC 0.1.
  EXPECT_NEAR(selection.Emission(0.9f), 0.432, 5e-4);
  EXPECT_GT(selection.Emission(0.0f), 1.0f);
  EXPECT_LT(selection.Emission(2.0f), 0.01f);
}

TEST(ViewSelection, FixedPointIsExactAtTheEndsAndRoundTrips) {
  EXPECT_EQ(DecodeCost(EncodeCost(0.0f)), 0.0f);
  EXPECT_EQ(DecodeCost(EncodeCost(kMaxCost)), kMaxCost);
  EXPECT_EQ(DecodeProb(EncodeProb(1.0f)), 1.0f);
  for (int code = 0; code <= 65535; ++code) {
    EXPECT_EQ(EncodeCost(DecodeCost(code)), code);
    EXPECT_EQ(EncodeProb(DecodeProb(code)), code);
  }
}

TEST(ViewPrior, AgreesWithReference) {
  const SyntheticPlane scene{SyntheticOptions()};
  const Problem& problem = scene.problem();
  const CameraTable cameras(problem);
  const SourceCameras views = cameras.sources();
  std::mt19937 random(9);
  std::uniform_real_distribution<float> depths(1, 60);
  for (const double min_angle : {0.0, 1.0, 5.0}) {
    Options options;
    options.min_triangulation_angle = min_angle;
    const ViewPrior prior =
        ViewPrior::FromAngles(min_angle, options.incident_angle_sigma);
    for (int i = 0; i < 500; ++i) {
      const int row = random() % 40;
      const int col = random() % 48;
      const Vec3 ray = cameras.reference().Ray(row, col);
      const DepthNormal plane = {depths(random),
                                 RandomNormal(Random(random(), 0, 0), ray)};
      // Nearly edge-on windows reach beyond the horizon, where areas mean
      // nothing.
      if (Dot(plane.normal, ray) > -0.3f) {
        continue;
      }
      const int m = random() % views.count;
      const ViewingAngles angles =
          ComputeViewingAngles(views, m, plane.depth * ray, plane.normal);
      const Warp warp =
          ComputeWarp(views, m, row, col,
                      HomographyVector(cameras.reference(), plane, ray));
      const float actual = prior.Triangulation(angles.cos_triangulation) *
                           prior.Incident(angles.cos_incident) *
                           ViewPrior::Resolution(warp, options.window_radius);
      EXPECT_NEAR(actual,
                  reference::Prior(options, problem, row, col, plane, m), 2e-3)
          << plane.depth;
    }
  }
}

TEST(GeometricCost, AgreesWithReference) {
  const SyntheticPlane scene{SyntheticOptions()};
  Problem problem = scene.GeometricProblem();
  // Holes must cost the maximum.
  Map<float> holes = *problem.sources[0].depth;
  for (size_t i = 0; i < holes.size(); i += 3) {
    holes.data()[i] = 0;
  }
  problem.sources[0].depth = &holes;
  const Options options;
  const CameraTable cameras(problem);
  const SourceCameras views = cameras.sources();
  int num_below_max = 0;
  std::mt19937 random(2);
  std::uniform_real_distribution<float> factors(0.9f, 1.1f);
  for (int row = 0; row < 40; ++row) {
    for (int col = 0; col < 48; ++col) {
      const float depth = scene.depth().At(row, col) * factors(random);
      for (int m = 0; m < views.count; ++m) {
        const Projection p = ProjectToSource(views, m, row, col, depth);
        const int c = static_cast<int>(std::floor(p.col + 0.5f));
        const int r = static_cast<int>(std::floor(p.row + 0.5f));
        const bool inside = c >= 0 && r >= 0 && c < 48 && r < 40;
        const float cost = ReprojectionError(
            views, m, row, col, p,
            inside ? problem.sources[m].depth->At(r, c) : 0.0f, 3.0f);
        const double expected =
            reference::GeometricCost(options, problem, row, col, depth, m);
        EXPECT_NEAR(cost, expected, 1e-3);
        num_below_max += expected < 3;
      }
    }
  }
  EXPECT_GT(num_below_max, 1000);
}

struct SweepCase {
  bool geometric;
  bool guided;
  int index;
  bool measures_all = false;

  friend void PrintTo(const SweepCase& c, std::ostream* out) {
    *out << (c.geometric ? "geometric" : "photometric")
         << (c.guided ? " guided" : "") << " sweep " << c.index
         << (c.measures_all ? ", all views measured" : "");
  }
};

// A state at which sweeps start, in the engine's form.
SweepState MakeState(const ProblemData& data, const Map<float>& depth,
                     const Map<Vec3>& normal, SweepScratch* scratch) {
  SweepState state(data, false);
  state.depth = depth;
  state.normal = normal;
  state.chosen = Map<uint8_t>(data.width, data.height);
  ComputeCosts(
      data, 0, data.height, [] { return true; }, &state, scratch);
  return state;
}

// A whole sweep.
void RunSweep(const ProblemData& data, const Options& options, int index,
              const GuideMaps& guide, SweepState* state,
              SweepScratch* scratch) {
  const SweepParams params =
      Schedule(options, data.num_sources, true).At(index);
  SweepLines(
      data, params, guide.Guide(), 0,
      NumLines(params.SweepDirection(), data.width, data.height),
      [] { return true; }, state, scratch);
}

class SweepTest : public testing::TestWithParam<SweepCase> {};

// Every sweep starts from the same state with the same random numbers in the
// engine and in the reference.
TEST_P(SweepTest, MakesTheChoicesOfTheReference) {
  SyntheticOptions scene_options;
  scene_options.width = 44;
  scene_options.height = 36;
  scene_options.num_sources = 5;
  const SyntheticPlane scene(scene_options);
  Options options;
  options.num_iterations = 5;
  options.geom_consistency = GetParam().geometric;
  options.filter = false;
  options.search.measure_all = GetParam().measures_all;
  options.seed = 11;
  const Problem problem =
      GetParam().geometric ? scene.GeometricProblem() : scene.problem();
  const auto [depth, normal] = StartNearTruth(scene);
  std::mt19937 random(6);
  const GuideMaps guide =
      GetParam().guided ? MakeGuide(scene, &random) : GuideMaps();

  reference::State expected =
      reference::Initialize(options, problem, depth, normal);
  reference::Sweep(options, problem, guide, GetParam().index, &expected);

  const ProblemData data(options, problem);
  SweepScratch scratch(data);
  SweepState actual = MakeState(data, depth, normal, &scratch);
  const auto first_cost = actual.cost;
  RunSweep(data, options, GetParam().index, guide, &actual, &scratch);

  int num_same = 0;
  int num_same_choices = 0;
  int num_changed = 0;
  int num_chosen[kNumHypotheses] = {};
  for (size_t i = 0; i < depth.size(); ++i) {
    // The first pixel of a line propagates its own plane to itself.
    const uint8_t choice = actual.chosen.data()[i];
    const uint8_t expected_choice = expected.chosen.data()[i];
    num_same_choices += choice == expected_choice ||
                        std::max(choice, expected_choice) <= kPropagated;
    ++num_chosen[choice];
    const Vec3 difference = actual.normal.data()[i] - expected.normal.data()[i];
    num_same += std::abs(actual.depth.data()[i] - expected.depth.data()[i]) <
                    1e-4f * expected.depth.data()[i] &&
                Dot(difference, difference) < 1e-8f;
    num_changed += actual.depth.data()[i] != depth.data()[i];
  }
  // Some hypotheses are alike to all digits of single precision, and what one
  // pixel chooses spreads.
  constexpr double kShareSame = 0.995;
  EXPECT_GE(num_same, kShareSame * depth.size());
  EXPECT_GE(num_same_choices, kShareSame * depth.size());
  EXPECT_GT(num_changed, 0.25 * depth.size());
  // Every other sweep tries no planes of superpixels.
  const bool tries_planes = GetParam().guided && GetParam().index % 2 == 1;
  const auto is_chosen = [&](Hypothesis hypothesis) {
    return num_chosen[hypothesis] > 0.03 * depth.size();
  };
  EXPECT_EQ(is_chosen(kDepthPrior), GetParam().guided);
  EXPECT_EQ(is_chosen(kFinePlane), tries_planes);
  EXPECT_EQ(is_chosen(kCoarsePlane), tries_planes);

  // Selection probabilities as the reference derives them from the engine's
  // costs before and after the sweep.
  const double previous_weight =
      GetParam().index / (4.0 * options.num_iterations);
  const int num_lines =
      NumLines(DirectionOf(GetParam().index), data.width, data.height);
  for (int index = 0; index < num_lines; ++index) {
    const std::vector<reference::Position> pixels =
        reference::LinePixels(problem, GetParam().index % 4, index);
    for (int m = 0; m < data.num_sources; ++m) {
      const auto at = [&](const reference::Position& p) {
        return (static_cast<size_t>(p.row) * data.width + p.col) *
                   data.num_sources +
               m;
      };
      const auto emission = [&](uint16_t cost) {
        return reference::Emission(options, DecodeCost(cost));
      };
      std::vector<double> backward(pixels.size() + 1, 0.5);
      for (size_t i = pixels.size(); i-- > 0;) {
        backward[i] = reference::BackwardMessage(
            emission(first_cost[at(pixels[i])]), backward[i + 1]);
      }
      double forward = 0.5;
      for (size_t i = 0; i < pixels.size(); ++i) {
        forward = reference::ForwardMessage(
            emission(actual.cost[at(pixels[i])]), forward);
        // Half a step of the fixed point on top, for this sweep's and, by its
        // weight, for the previous probability.
        EXPECT_NEAR(DecodeProb(actual.prob[at(pixels[i])]),
                    reference::SelectionProb(forward, backward[i], 0.5,
                                             previous_weight),
                    1e-5 + (0.5 + previous_weight) / 65535);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    AllDirections, SweepTest,
    testing::Values(SweepCase{false, false, 0}, SweepCase{false, false, 1},
                    SweepCase{false, false, 2}, SweepCase{false, false, 3},
                    SweepCase{false, false, 9}, SweepCase{true, false, 0},
                    SweepCase{true, false, 3}, SweepCase{true, false, 14},
                    SweepCase{false, true, 0}, SweepCase{false, true, 5},
                    SweepCase{false, true, 10}, SweepCase{true, true, 1},
                    SweepCase{true, true, 4}, SweepCase{true, true, 11},
                    SweepCase{false, false, 6, true},
                    SweepCase{true, true, 7, true}),
    [](const auto& info) {
      return std::string(info.param.geometric ? "Geometric" : "Photometric") +
             (info.param.guided ? "Guided" : "") +
             std::to_string(info.param.index);
    });

// Section 4.2: "regions with low texture" are to favour planes.
TEST(TextureWeights, DefaultsFavourPlanesWhereThereIsLittleTexture) {
  const TapaOptions options;
  const auto weights = [&options](double variance) {
    const double e = options.textureness_variance;
    return TextureWeights::FromTextureness(
        static_cast<float>((variance + e) /
                           (variance + e / options.min_textureness)),
        static_cast<float>(options.weight_range));
  };
  // Standard deviations of 0, 2 and 4 grey levels against 8 and 50.
  for (const double deviation : {0.0, 2.0, 4.0}) {
    const TextureWeights little = weights(std::pow(deviation / 255, 2));
    EXPECT_LT(little.planar.photometric, little.own.photometric);
  }
  for (const double deviation : {8.0, 50.0}) {
    const TextureWeights much = weights(std::pow(deviation / 255, 2));
    EXPECT_GT(much.planar.photometric, much.own.photometric);
  }
}

TEST(TextureWeights, AreThoseOfThePaper) {
  for (const double range : {0.0, 0.1, 0.2, 0.5, 1.0}) {
    for (const double t : {0.5, 0.5 + 1e-6, 0.6, 0.75, 0.9, 1.0, 0.0, 0.3}) {
      const TextureWeights weights = TextureWeights::FromTextureness(
          static_cast<float>(t), static_cast<float>(range));
      const double plus = reference::PlusWeight(t, range);
      const double minus = reference::MinusWeight(t, range);
      EXPECT_NEAR(weights.own.photometric, minus, 1e-6);
      EXPECT_NEAR(weights.own.geometric, plus, 1e-6);
      EXPECT_NEAR(weights.planar.photometric, plus, 1e-6);
      EXPECT_NEAR(weights.planar.geometric, minus, 1e-6);
    }
  }
  // The paper's numbers at both ends.
  const TextureWeights full = TextureWeights::FromTextureness(1.0f, 0.2f);
  EXPECT_EQ(full.planar.photometric, 1.0f);
  EXPECT_EQ(full.own.photometric, 0.8f);
  // Without texture all weights are the same number, bit for bit.
  for (const float range : {0.0f, 0.1f, 0.2f, 0.3f, 0.7f, 1.0f}) {
    const TextureWeights flat = TextureWeights::FromTextureness(0.5f, range);
    EXPECT_EQ(flat.own.photometric, flat.planar.photometric);
    EXPECT_EQ(flat.own.photometric, flat.own.geometric);
    EXPECT_EQ(flat.own.photometric, flat.planar.geometric);
  }
}

bool SameState(const SweepState& a, const SweepState& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() &&
           std::memcmp(x.data(), y.data(), x.size() * sizeof(x.data()[0])) == 0;
  };
  return same(a.depth, b.depth) && same(a.normal, b.normal) &&
         a.cost == b.cost && a.prob == b.prob && same(a.chosen, b.chosen);
}

TEST(Sweep, WithoutPlanesAndWeightsIsThePlainAlgorithm) {
  const SyntheticPlane scene{SyntheticOptions()};
  const auto [depth, normal] = StartNearTruth(scene);
  for (const bool geometric : {false, true}) {
    Options options;
    options.geom_consistency = geometric;
    const Problem problem =
        geometric ? scene.GeometricProblem() : scene.problem();
    const ProblemData data(options, problem);
    SweepScratch scratch(data);
    const auto sweep_twice = [&](const GuideMaps& guide) {
      SweepState state = MakeState(data, depth, normal, &scratch);
      RunSweep(data, options, 4, guide, &state, &scratch);
      RunSweep(data, options, 5, guide, &state, &scratch);
      return state;
    };
    const SweepState plain = sweep_twice(GuideMaps());

    std::mt19937 random(1);
    const GuideMaps guide = MakeGuide(scene, &random);
    EXPECT_FALSE(SameState(sweep_twice(guide), plain));
    // No pixel has a plane, and weights change nothing.
    GuideMaps idle = guide;
    idle.weight_range = 0;
    for (PlaneSet* set : {&idle.fine, &idle.coarse}) {
      set->index = Map<uint16_t>(data.width, data.height, PlaneSet::kNone);
    }
    idle.depth_prior =
        Map<PackedDepthNormal>(data.width, data.height, PackNothing());
    EXPECT_TRUE(SameState(sweep_twice(idle), plain));
    // No plane is possible: out of range, behind the camera, turned away or
    // seen edge-on.
    GuideMaps impossible;
    impossible.depth_min = problem.depth_min;
    impossible.depth_max = problem.depth_max;
    const Vec3 n = scene.normal();
    for (PlaneSet* set : {&impossible.fine, &impossible.coarse}) {
      *set = DrawAtRandom({PlaneThrough(0.2f, n),
                           PlaneThrough(100, n),
                           {n, -4},
                           {-n, 4},
                           {-n, -4},
                           {{0, 0, 0}, 4},
                           {{NAN, 0, -1}, 4},
                           {{0, 0, -1}, NAN}},
                          data.width, data.height, &random);
    }
    EXPECT_TRUE(SameState(sweep_twice(impossible), plain));
  }
}

TEST(Sweep, RangeOfDepthsIncludesItsEnds) {
  const SyntheticPlane scene{SyntheticOptions()};
  const Problem& problem = scene.problem();
  Options options;
  options.geom_consistency = false;
  const Map<uint8_t> flat(48, 40, 90);
  Problem flat_problem = problem;
  flat_problem.reference.image = &flat;
  const ProblemData data(options, flat_problem);
  SweepScratch scratch(data);
  const auto [depth, normal] = StartNearTruth(scene);
  for (const float distance : {1.9f, 2.0f, 5.0f, 8.0f, 8.1f}) {
    GuideMaps guide;
    guide.depth_min = 2;
    guide.depth_max = 8;
    guide.fine.planes = {{{0, 0, -1}, distance}};
    guide.fine.index = Map<uint16_t>(48, 40, uint16_t{0});
    SweepState state = MakeState(data, depth, normal, &scratch);
    RunSweep(data, options, 1, guide, &state, &scratch);
    const bool in_range = distance >= 2 && distance <= 8;
    EXPECT_EQ(state.chosen.At(20, 24) == kFinePlane, in_range) << distance;
  }
}

// Where nothing can be measured the planes win: the coarse one, or the fine one
// where there is no other. Without weights, and with those of the paper, every
// hypothesis costs the same there; with the default ones planes cost less.
void ExpectPlanesToWinOnAFlatPatch(bool geometric) {
  SyntheticOptions scene_options;
  scene_options.num_sources = 7;
  const SyntheticPlane scene(scene_options);
  const auto [depth, normal] = StartNearTruth(scene);
  const Map<uint8_t> flat(48, 40, 90);
  // Source views know no depth: geometric costs are all the largest one.
  const Map<float> no_depth(48, 40, 0.0f);
  Problem problem = scene.problem();
  problem.reference.image = &flat;
  for (View& source : problem.sources) {
    source.depth = &no_depth;
  }
  Options options;
  options.num_iterations = 5;
  options.geom_consistency = geometric;
  const ProblemData data(options, problem);
  SweepScratch scratch(data);
  // 0: no weights.
  for (const double min_textureness :
       {0.0, 0.5, TapaOptions().min_textureness}) {
    for (const int index : {1, 3, 7, 11}) {
      SCOPED_TRACE(testing::Message()
                   << "textureness " << min_textureness << ", sweep " << index);
      std::mt19937 random(index);
      GuideMaps guide = MakeGuide(scene, &random);
      guide.depth_prior = {};
      const Vec3 n = scene.normal();
      guide.fine = DrawAtRandom({PlaneThrough(3, n), PlaneThrough(5, n)}, 48,
                                40, &random);
      guide.coarse = DrawAtRandom({PlaneThrough(4, n), PlaneThrough(4.5f, n)},
                                  48, 40, &random);
      if (min_textureness > 0) {
        TexturenessOptions texture;
        texture.min_textureness = min_textureness;
        guide.textureness = ComputeTextureness(flat, texture);
      } else {
        guide.textureness = Map<float>();
      }
      SweepState state = MakeState(data, depth, normal, &scratch);
      RunSweep(data, options, index, guide, &state, &scratch);

      const RefCamera camera = CameraTable(problem).reference();
      int num_wrong = 0;
      for (int row = 5; row < 35; ++row) {
        for (int col = 5; col < 43; ++col) {
          const size_t pixel = static_cast<size_t>(row) * 48 + col;
          for (int m = 0; m < 7; ++m) {
            ASSERT_EQ(DecodeCost(state.cost[pixel * 7 + m]), kMaxCost);
          }
          const uint16_t fine = guide.fine.index.At(row, col);
          const uint16_t coarse = guide.coarse.index.At(row, col);
          const int chosen = state.chosen.At(row, col);
          if (coarse != PlaneSet::kNone) {
            num_wrong += chosen != kCoarsePlane;
            if (chosen == kCoarsePlane) {
              EXPECT_FLOAT_EQ(
                  state.depth.At(row, col),
                  PlaneAt(guide.coarse.planes[coarse], camera.Ray(row, col))
                      .depth);
            }
          } else if (fine != PlaneSet::kNone) {
            num_wrong += chosen != kFinePlane;
          }
        }
      }
      EXPECT_EQ(num_wrong, 0);
    }
  }
}

TEST(Sweep, OnAFlatPatchPlanesWin) { ExpectPlanesToWinOnAFlatPatch(false); }

TEST(Sweep, OnAFlatPatchPlanesWinInTheGeometricPass) {
  ExpectPlanesToWinOnAFlatPatch(true);
}

TEST(Sweep, FilterKeepsWhatIsConsistentWithEnoughViews) {
  SyntheticOptions scene_options;
  scene_options.baseline = 0.35;
  const SyntheticPlane scene(scene_options);
  const Problem problem = scene.GeometricProblem();
  Options options;
  options.num_iterations = 1;
  const auto estimate = EstimateDepth(options, problem);
  options.filter = false;
  const auto unfiltered = EstimateDepth(options, problem);
  ASSERT_TRUE(estimate && unfiltered);
  EXPECT_TRUE(unfiltered->consistent.empty());

  int num_kept = 0;
  int num_agreeing = 0;
  for (int row = 0; row < 40; ++row) {
    for (int col = 0; col < 48; ++col) {
      const size_t pixel = static_cast<size_t>(row) * 48 + col;
      const DepthNormal plane = {unfiltered->depth.At(row, col),
                                 unfiltered->normal.At(row, col)};
      double prob[4];
      for (int m = 0; m < 4; ++m) {
        prob[m] = estimate->selection_prob[pixel * 4 + m] / 65535.0;
      }
      const int count =
          reference::CountConsistent(options, problem, row, col, plane, prob);
      const bool kept = estimate->depth.At(row, col) > 0;
      EXPECT_EQ(__builtin_popcount(estimate->consistent[pixel]) >= 2, kept);
      num_kept += kept;
      num_agreeing += kept == (count >= 2);
    }
  }
  EXPECT_GE(num_agreeing, 0.995 * 40 * 48);
  EXPECT_GT(num_kept, 400);
  EXPECT_LT(num_kept, 40 * 48);
}

// One lane goes another way than many, whose functions it can run, too.
TEST(Sweep, DrawsTheSameViewsWithAnyNumberOfLanes) {
  for (const int num_sources : {1, 3, 16}) {
    SyntheticOptions scene_options;
    scene_options.num_sources = num_sources;
    const SyntheticPlane scene(scene_options);
    const CameraTable cameras(scene.problem());
    const SourceCameras views = cameras.sources();
    const RefCamera camera = cameras.reference();
    std::vector<float> cdf(views.padded_count);
    std::vector<float> num_drawn(views.padded_count);
    std::vector<float> uniform(kDrawBlock);
    std::vector<int> order(views.padded_count);
    PixelScratch s = {};
    s.cdf = cdf.data();
    s.num_drawn = num_drawn.data();
    s.order = order.data();
    s.uniform = uniform.data();
    SweepParams params;
    params.measure_all = true;
    std::mt19937 random(num_sources);
    for (int i = 0; i < 1000; ++i) {
      params.num_samples = 1 + i % 100;
      std::vector<float> steps(views.padded_count, kNeverDrawn);
      float sum = 0;
      for (int m = 0; m < num_sources; ++m) {
        // Some views have no chance.
        sum += std::max(0.0f,
                        std::uniform_real_distribution<float>(-1, 1)(random));
        steps[m] = sum;
      }
      for (int m = 0; m < num_sources; ++m) {
        steps[m] = sum > 0 ? steps[m] / sum : (m + 1.0f) / num_sources;
      }
      const PixelContext pixel = {
          params, camera,          views,         s,           0, 0,
          Vec3(), Random(1, i, 0), DepthNormal(), PixelGuide()};
      cdf = steps;
      const int num_distinct = DrawViewsOneByOne(pixel);
      const std::vector<float> counts = num_drawn;
      const std::vector<int> ranks = order;
      cdf = steps;
      CountDraws<SerialLanes>(pixel);
      ASSERT_EQ(OrderViews<SerialLanes>(num_sources, s), num_distinct);
      for (int m = 0; m < num_sources; ++m) {
        ASSERT_EQ(num_drawn[m], counts[m]);
        ASSERT_EQ(order[m], ranks[m]);
      }
    }
  }
}

TEST(Sweep, DrawsViewsInProportionToTheirProbability) {
  const SyntheticPlane scene{SyntheticOptions()};
  const CameraTable cameras(scene.problem());
  const SourceCameras views = cameras.sources();
  const std::vector<float> steps = {0.1f, 0.1f, 0.7f, 1.0f};
  std::vector<float> cdf(views.padded_count, 1.0f);
  std::vector<float> num_drawn(views.padded_count);
  std::vector<int> order(views.padded_count);
  std::vector<float> uniform(kDrawBlock);
  PixelScratch s = {};
  s.cdf = cdf.data();
  s.num_drawn = num_drawn.data();
  s.order = order.data();
  s.uniform = uniform.data();
  SweepParams params;
  params.num_samples = 15;
  params.measure_all = true;
  const RefCamera camera = cameras.reference();
  double total[4] = {};
  for (int i = 0; i < 20000; ++i) {
    std::copy(steps.begin(), steps.end(), cdf.begin());
    const PixelContext pixel = {
        params, camera,          views,         s,           0, 0,
        Vec3(), Random(1, i, 0), DepthNormal(), PixelGuide()};
    const int num_distinct = DrawViews<SerialLanes>(pixel);
    double sum = 0;
    int seen = 0;
    for (int k = 0; k < 4; ++k) {
      const float drawn = num_drawn[order[k]];
      EXPECT_EQ(drawn > 0, k < num_distinct);
      EXPECT_TRUE(k == 0 || drawn <= num_drawn[order[k - 1]]);
      sum += drawn;
      total[order[k]] += drawn;
      seen |= 1 << order[k];
    }
    ASSERT_EQ(sum, 15);
    ASSERT_EQ(seen, 15) << "not an order of all views";
  }
  EXPECT_NEAR(total[0] / 300000, 0.1, 0.005);
  EXPECT_EQ(total[1], 0);
  EXPECT_NEAR(total[2] / 300000, 0.6, 0.005);
  EXPECT_NEAR(total[3] / 300000, 0.3, 0.005);
}

}  // namespace
}  // namespace tapa
