#include "src/mvs/sweep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <random>
#include <string>

#include "src/mvs/camera_table.h"
#include "src/mvs/cpu/sweep.h"
#include "tests/mvs/reference.h"
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
      const Plane plane = {depths(random),
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

// Parameters of one sweep, as the schedule would set them.
SweepParams MakeParams(const Options& options, int index) {
  SweepParams params;
  params.index = index;
  params.seed = options.seed;
  params.perturbation =
      static_cast<float>(std::pow(2.0, -(index / 4 + index % 4 / 4.0)));
  params.prev_prob_weight =
      static_cast<float>(index) / (4 * options.num_iterations);
  params.selection = ViewSelection::FromSigma(options.ncc_sigma);
  params.prior = ViewPrior::FromAngles(options.min_triangulation_angle,
                                       options.incident_angle_sigma);
  params.geometric = options.geom_consistency;
  return params;
}

struct SweepCase {
  bool geometric;
  int index;

  friend void PrintTo(const SweepCase& c, std::ostream* out) {
    *out << (c.geometric ? "geometric" : "photometric") << " sweep " << c.index;
  }
};

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
  options.geom_consistency = GetParam().geometric;
  options.filter = false;
  options.seed = 11;
  const Problem problem =
      GetParam().geometric ? scene.GeometricProblem() : scene.problem();

  // Half of the pixels start near the truth, so that propagation has something
  // to spread.
  Map<float> depth(44, 36);
  Map<Vec3> normal(44, 36);
  const RefCamera camera = CameraTable(problem).reference();
  std::mt19937 random(4);
  std::uniform_real_distribution<float> factors(0.7f, 1.4f);
  for (int row = 0; row < 36; ++row) {
    for (int col = 0; col < 44; ++col) {
      depth.At(row, col) = scene.depth().At(row, col) *
                           (random() % 2 ? factors(random) : 1.001f);
      normal.At(row, col) =
          RandomNormal(Random(random(), 0, 0), camera.Ray(row, col));
    }
  }

  reference::State expected =
      reference::Initialize(options, problem, depth, normal);
  reference::Sweep(options, problem, GetParam().index, &expected);

  const ProblemData data(options, problem);
  SweepScratch scratch(data);
  SweepState actual(data, false);
  actual.depth = depth;
  actual.normal = normal;
  const auto go_on = [] { return true; };
  ComputeCosts(data, 0, data.height, go_on, &actual, &scratch);
  const auto first_cost = actual.cost;
  const auto direction = static_cast<Direction>(GetParam().index % 4);
  SweepLines(data, MakeParams(options, GetParam().index), SweepGuide(),
             direction, 0, NumLines(data, direction), go_on, &actual, &scratch);

  int num_same = 0;
  int num_changed = 0;
  for (size_t i = 0; i < depth.size(); ++i) {
    const Vec3 difference = actual.normal.data()[i] - expected.normal.data()[i];
    num_same += std::abs(actual.depth.data()[i] - expected.depth.data()[i]) <
                    1e-4f * expected.depth.data()[i] &&
                Dot(difference, difference) < 1e-8f;
    num_changed += actual.depth.data()[i] != depth.data()[i];
  }
  EXPECT_GE(num_same, 0.999 * depth.size());
  EXPECT_GT(num_changed, 0.25 * depth.size());

  // Selection probabilities as the reference derives them from the engine's
  // costs before and after the sweep.
  const double previous_weight =
      GetParam().index / (4.0 * options.num_iterations);
  for (int index = 0; index < NumLines(data, direction); ++index) {
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
    testing::Values(SweepCase{false, 0}, SweepCase{false, 1},
                    SweepCase{false, 2}, SweepCase{false, 3},
                    SweepCase{false, 9}, SweepCase{true, 0}, SweepCase{true, 3},
                    SweepCase{true, 14}),
    [](const auto& info) {
      return std::string(info.param.geometric ? "Geometric" : "Photometric") +
             std::to_string(info.param.index);
    });

TEST(Sweep, FilterKeepsWhatEnoughViewsSupport) {
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
      const Plane plane = {unfiltered->depth.At(row, col),
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

TEST(Sweep, DrawsViewsInProportionToTheirProbability) {
  const SyntheticPlane scene{SyntheticOptions()};
  const CameraTable cameras(scene.problem());
  const SourceCameras views = cameras.sources();
  std::vector<float> cdf(views.padded_count, 1.0f);
  const float steps[] = {0.1f, 0.1f, 0.7f, 1.0f};
  std::copy(steps, steps + 4, cdf.begin());
  std::vector<float> num_drawn(views.padded_count);
  std::vector<int> drawn(views.padded_count);
  PixelScratch s = {};
  s.cdf = cdf.data();
  s.num_drawn = num_drawn.data();
  s.drawn = drawn.data();
  double total[4] = {};
  for (int i = 0; i < 20000; ++i) {
    DrawViews<SerialLanes>(SweepParams(), Random(1, i, 0), views, &s);
    double sum = 0;
    for (int k = 0; k < s.num_distinct; ++k) {
      sum += num_drawn[drawn[k]];
      total[drawn[k]] += num_drawn[drawn[k]];
      EXPECT_TRUE(k == 0 || num_drawn[drawn[k]] <= num_drawn[drawn[k - 1]]);
    }
    ASSERT_EQ(sum, 15);
  }
  EXPECT_NEAR(total[0] / 300000, 0.1, 0.005);
  EXPECT_EQ(total[1], 0);
  EXPECT_NEAR(total[2] / 300000, 0.6, 0.005);
  EXPECT_NEAR(total[3] / 300000, 0.3, 0.005);
}

}  // namespace
}  // namespace tapa
