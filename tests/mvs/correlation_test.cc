#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <random>
#include <string>

#include "src/mvs/cpu/sweep.h"
#include "tests/mvs/reference.h"
#include "tests/mvs/synthetic.h"

namespace tapa {
namespace {

// Runs a check with every instruction set that this machine has.
template <typename Check>
void ForEachInstructionSet(const Check& check) {
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    SCOPED_TRACE(InstructionSet());
    check();
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

float EngineCost(const ProblemData& data, int row, int col,
                 const DepthNormal& plane, int m, Patch* patch) {
  const RefCamera camera = data.cameras.reference();
  PreparePatch(data, row, col, patch);
  return PhotometricCost(
      data, *patch,
      ComputeWarp(data.cameras.sources(), m, row, col,
                  HomographyVector(camera, plane, camera.Ray(row, col))),
      m);
}

// Not too close to edge-on, where the window reaches beyond the horizon and
// rounding is magnified without bounds.
DepthNormal RandomPlane(const Problem& problem, const Vec3& ray,
                        std::mt19937* random) {
  std::uniform_real_distribution<float> depth(0.5f * problem.depth_min,
                                              2.0f * problem.depth_max);
  DepthNormal plane;
  do {
    plane = {depth(*random), RandomNormal(Random((*random)(), 0, 0), ray)};
  } while (Dot(plane.normal, ray) > -0.3f);
  return plane;
}

// Largest difference to the reference over all pixels, views and random planes.
// Pixels whose variance is at the threshold for having texture may fall on
// either side of it.
void CompareCosts(const Options& options, const Problem& problem,
                  bool has_few_samples = false) {
  const ProblemData data(options, problem);
  const RefCamera camera = data.cameras.reference();
  Patch patch(data.window);
  std::mt19937 random(7);
  // Without SIMD all samples are added up one by one, which rounds more; few
  // samples, or few that count, may have so little contrast that rounding
  // shows.
  const bool rounds_more =
      InstructionSet() == std::string("SCALAR") || has_few_samples;
  const double tolerance = rounds_more ? 1e-3 : 1e-4;
  int num_informative = 0;
  for (int row = 0; row < data.height; row += 3) {
    for (int col = 0; col < data.width; col += 2) {
      const DepthNormal plane =
          RandomPlane(problem, camera.Ray(row, col), &random);
      for (int m = 0; m < data.num_sources; ++m) {
        const double expected =
            reference::PhotometricCost(options, problem, row, col, plane, m);
        EXPECT_NEAR(EngineCost(data, row, col, plane, m, &patch), expected,
                    tolerance)
            << row << " " << col << " " << m << " depth " << plane.depth;
        num_informative += expected < 2;
      }
    }
  }
  EXPECT_GT(num_informative, data.width * data.height / 20);
}

TEST(Correlation, AgreesWithReferenceForAllInstructionSets) {
  const SyntheticPlane scene{SyntheticOptions()};
  ForEachInstructionSet([&] { CompareCosts(Options(), scene.problem()); });
}

TEST(Correlation, AgreesWithReferenceForAllWindows) {
  SyntheticOptions scene_options;
  scene_options.num_sources = 1;
  const SyntheticPlane scene(scene_options);
  for (const int radius : {1, 2, 4, 5, 8, 20, 32}) {
    for (const int step : {1, 2}) {
      if (radius == 1 && step == 2) {
        continue;  // Four samples correlate by chance.
      }
      SCOPED_TRACE(testing::Message()
                   << "radius " << radius << " step " << step);
      Options options;
      options.window_radius = radius;
      options.window_step = step;
      options.sigma_color = 0.1 + 0.02 * radius;
      options.sigma_spatial = step == 1 ? -1 : 3;
      for (const double sigma : {-1.0, 0.5, 2.0}) {
        options.search.sigma_textured = sigma;
        CompareCosts(options, scene.problem(), radius == 1 || sigma > 0);
      }
    }
  }
}

TEST(Correlation, AgreesWithReferenceOnNoise) {
  const SyntheticPlane scene{SyntheticOptions()};
  Problem problem = scene.problem();
  std::mt19937 random(3);
  const Map<uint8_t> a = RandomImage(48, 40, &random);
  // Views may have other sizes than the reference.
  const Map<uint8_t> b = RandomImage(31, 77, &random);
  problem.reference.image = &a;
  for (View& view : problem.sources) {
    view.image = &b;
  }
  // All is texture, so few samples count, and of those few have the colour of
  // the centre.
  ForEachInstructionSet([&] { CompareCosts(Options(), problem, true); });
}

TEST(Correlation, LooksAtNearSamplesOnlyWhereThereIsTexture) {
  const SyntheticPlane scene{SyntheticOptions()};
  Problem problem = scene.problem();
  std::mt19937 random(3);
  const Map<uint8_t> noise = RandomImage(48, 40, &random);
  const Map<uint8_t> flat(48, 40, 200);
  // Offsets are -5, -3, -1, 1, 3 and 5: 16 samples are within 3 pixels.
  const auto samples = [&problem](double sigma, const Map<uint8_t>& image) {
    problem.reference.image = &image;
    Options options;
    options.search.sigma_textured = sigma;
    const ProblemData data(options, problem);
    Patch patch(data.window);
    PreparePatch(data, 20, 24, &patch);
    return patch.padded_samples;
  };
  EXPECT_EQ(samples(2, noise), 16);
  EXPECT_EQ(samples(2, flat), 32);
  EXPECT_EQ(samples(-1, noise), 32);
  EXPECT_EQ(samples(2.5, noise), 32);
}

TEST(Correlation, HasSamplesThatCountHoweverSmallTheSpread) {
  const SyntheticPlane scene{SyntheticOptions()};
  Options options;
  options.sigma_spatial = 0.01;
  const ProblemData data(options, scene.problem());
  Patch patch(data.window);
  PreparePatch(data, 20, 24, &patch);
  EXPECT_TRUE(std::isfinite(patch.variance));
  EXPECT_TRUE(std::isfinite(patch.mean));
}

TEST(Correlation, IsZeroAtTheTruthAndTwoWithoutTexture) {
  const SyntheticPlane scene{SyntheticOptions()};
  Problem problem = scene.problem();
  {
    const ProblemData data(Options(), problem);
    Patch patch(data.window);
    const DepthNormal truth = {scene.depth().At(20, 24), scene.normal()};
    EXPECT_LT(EngineCost(data, 20, 24, truth, 0, &patch), 0.01f);
  }
  const Map<uint8_t> flat(48, 40, 200);
  problem.sources[0].image = &flat;
  {
    const ProblemData data(Options(), problem);
    Patch patch(data.window);
    const DepthNormal truth = {scene.depth().At(20, 24), scene.normal()};
    EXPECT_EQ(EngineCost(data, 20, 24, truth, 0, &patch), kMaxCost);
  }
  problem.reference.image = &flat;
  const ProblemData data(Options(), problem);
  Patch patch(data.window);
  const DepthNormal truth = {scene.depth().At(20, 24), scene.normal()};
  EXPECT_EQ(EngineCost(data, 20, 24, truth, 1, &patch), kMaxCost);
}

TEST(Correlation, SurvivesPlanesBehindTheCameraAndNonsense) {
  const SyntheticPlane scene{SyntheticOptions()};
  const ProblemData data(Options(), scene.problem());
  const float inf = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Patch patch(data.window);
  ForEachInstructionSet([&] {
    for (const float depth : {0.0f, -1.0f, 1e-30f, 1e-3f, 1e30f, inf, nan}) {
      for (const Vec3 normal :
           {Vec3{0, 0, -1}, Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0, 0, 0},
            Vec3{nan, 0, -1}, Vec3{0.999f, 0, -0.0447f}}) {
        for (int col = 0; col < data.width; col += 11) {
          const float cost =
              EngineCost(data, 5, col, {depth, normal}, 0, &patch);
          EXPECT_GE(cost, 0.0f);
          EXPECT_LE(cost, kMaxCost);
        }
      }
    }
  });
}

TEST(Correlation, SourceImageKeepsEveryPixelBetweenBlackBorders) {
  std::mt19937 random(1);
  const Map<uint8_t> image = RandomImage(7, 5, &random);
  const SourceImage source(image);
  const auto pixel = [&](int row, int col) {
    return row >= 0 && col >= 0 && row < 5 && col < 7 ? image.At(row, col) : 0;
  };
  for (int row = 0; row <= image.height() + 1; ++row) {
    for (int col = 0; col <= image.width() + 1; ++col) {
      uint8_t quad[4];
      std::memcpy(quad, source.data() + row * source.stride() + col, 4);
      EXPECT_EQ(quad[0], pixel(row - 1, col - 1));
      EXPECT_EQ(quad[1], pixel(row, col - 1));
      EXPECT_EQ(quad[2], pixel(row - 1, col));
      EXPECT_EQ(quad[3], pixel(row, col));
    }
  }
}

}  // namespace
}  // namespace tapa
