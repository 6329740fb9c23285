// Estimation with a mask (Problem::mask).

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <stdexcept>
#include <string>

#include "src/mvs/estimate_depth.h"
#include "src/mvs/sweep/hypotheses.h"
#include "src/mvs/tapa/stages.h"
#include "tests/mvs/masked_half.h"
#include "tests/mvs/synthetic.h"

namespace tapa {
namespace {

Options SomeOptions(bool geometric) {
  Options options;
  options.geom_consistency = geometric;
  options.num_iterations = 2;
  return options;
}

Problem SomeProblem(const SyntheticPlane& scene, bool geometric) {
  return geometric ? scene.GeometricProblem() : scene.problem();
}

// A disc, a line of single pixels, and the first columns.
Map<uint8_t> SomeMask(int width, int height) {
  Map<uint8_t> mask(width, height);
  for (int row = 0; row < height; ++row) {
    for (int col = 0; col < width; ++col) {
      const bool in_disc =
          std::hypot(row - 0.5 * height, col - 0.6 * width) < 0.25 * height;
      mask.At(row, col) =
          in_disc || col < 3 || (row == 4 && col % 2 == 0) ? 255 : 0;
    }
  }
  return mask;
}

Map<uint8_t> SomeMask(const SyntheticPlane& scene) {
  return SomeMask(scene.depth().width(), scene.depth().height());
}

bool HasConsistentView(const Estimate& estimate, size_t pixel) {
  const size_t bytes = estimate.consistent.size() / estimate.depth.size();
  for (size_t i = 0; i < bytes; ++i) {
    if (estimate.consistent[pixel * bytes + i] != 0) {
      return true;
    }
  }
  return false;
}

void ExpectNothingWhereMasked(const Map<uint8_t>& mask,
                              const Estimate& estimate) {
  const size_t num_sources = estimate.selection_prob.size() / mask.size();
  for (size_t i = 0; i < mask.size(); ++i) {
    if (mask.data()[i] == 0) {
      continue;
    }
    const Vec3& normal = estimate.normal.data()[i];
    ASSERT_EQ(estimate.depth.data()[i], 0) << i;
    ASSERT_EQ(Dot(normal, normal), 0) << i;
    ASSERT_FALSE(HasConsistentView(estimate, i)) << i;
    for (size_t m = 0; m < num_sources; ++m) {
      ASSERT_EQ(estimate.selection_prob[i * num_sources + m], 0) << i;
    }
  }
}

TEST(Mask, MaskedPixelsGetNoEstimateAndOthersDo) {
  const SyntheticPlane scene{SyntheticOptions()};
  const Map<uint8_t> mask = SomeMask(scene);
  for (const bool geometric : {false, true}) {
    for (const bool filter : {false, true}) {
      Options options = SomeOptions(geometric);
      options.filter = filter;
      Problem problem = SomeProblem(scene, geometric);
      problem.mask = mask;
      const auto estimate = EstimateDepth(options, problem);
      ASSERT_TRUE(estimate);
      ExpectNothingWhereMasked(mask, *estimate);
      int num_estimates = 0;
      for (size_t i = 0; i < mask.size(); ++i) {
        num_estimates += estimate->depth.data()[i] > 0;
        EXPECT_TRUE(filter || mask.data()[i] != 0 ||
                    estimate->depth.data()[i] > 0);
      }
      EXPECT_GT(num_estimates, 200);
    }
  }
}

TEST(Mask, IsLikeTheBorderOfTheImage) {
  const SyntheticPlane scene{SyntheticOptions()};
  for (const bool geometric : {false, true}) {
    const MaskedHalf half(scene, geometric);
    const Options options = SomeOptions(geometric);
    const auto masked = EstimateDepth(options, half.masked());
    const auto cut = EstimateDepth(options, half.cut());
    ASSERT_TRUE(masked && cut);
    EXPECT_EQ(MaskedHalf::Difference(*masked, *cut), "");
  }
}

TEST(Mask, ChangesNothingWhereNothingIsMasked) {
  const SyntheticPlane scene{SyntheticOptions()};
  for (const bool geometric : {false, true}) {
    const Options options = SomeOptions(geometric);
    Problem problem = SomeProblem(scene, geometric);
    const auto without = EstimateDepth(options, problem);
    problem.mask = Map<uint8_t>(48, 40, 0);
    const auto with = EstimateDepth(options, problem);
    ASSERT_TRUE(without && with);
    EXPECT_TRUE(Same(*without, *with));
  }
}

TEST(Mask, ResultDoesNotDependOnThreads) {
  const SyntheticPlane scene{SyntheticOptions()};
  Options options = SomeOptions(true);
  Problem problem = scene.GeometricProblem();
  problem.mask = SomeMask(scene);
  options.num_threads = 1;
  const auto one = EstimateDepth(options, problem);
  options.num_threads = 3;
  const auto three = EstimateDepth(options, problem);
  ASSERT_TRUE(one && three);
  EXPECT_TRUE(Same(*one, *three));
}

TEST(Mask, EverythingMayBeMasked) {
  const SyntheticPlane scene{SyntheticOptions()};
  for (const bool tapa : {false, true}) {
    Options options = SomeOptions(true);
    options.tapa.enabled = tapa;
    Problem problem = scene.GeometricProblem();
    problem.mask = Map<uint8_t>(48, 40, 1);
    const auto estimate = EstimateDepth(options, problem);
    ASSERT_TRUE(estimate);
    ExpectNothingWhereMasked(problem.mask, *estimate);
  }
}

// Share of the pixels that are not masked whose depth is right to one per cent.
double ShareRight(const SyntheticPlane& scene, const Map<uint8_t>& mask,
                  const Estimate& estimate) {
  int num_right = 0;
  int num_pixels = 0;
  for (size_t i = 0; i < mask.size(); ++i) {
    if (mask.data()[i] == 0) {
      const float ratio = estimate.depth.data()[i] / scene.depth().data()[i];
      num_right += std::abs(ratio - 1) < 0.01f;
      ++num_pixels;
    }
  }
  return static_cast<double>(num_right) / num_pixels;
}

TEST(Mask, OthersAreAsGood) {
  SyntheticOptions scene_options;
  scene_options.width = 96;
  scene_options.height = 72;
  scene_options.focal_length = 110;
  const SyntheticPlane scene(scene_options);
  const Map<uint8_t> mask = SomeMask(scene);
  Options options = SomeOptions(false);
  options.num_iterations = 4;
  options.filter = false;
  Problem problem = scene.problem();
  const auto whole = EstimateDepth(options, problem);
  problem.mask = mask;
  const auto masked = EstimateDepth(options, problem);
  ASSERT_TRUE(whole && masked);
  EXPECT_GE(ShareRight(scene, mask, *masked),
            ShareRight(scene, mask, *whole) - 0.03);
}

// CPU time in seconds.
double SecondsOf(const Options& options, const Problem& problem) {
  const std::clock_t begin = std::clock();
  EXPECT_TRUE(EstimateDepth(options, problem));
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

TEST(Mask, SavesTheTimeOfMaskedPixels) {
  SyntheticOptions scene_options;
  scene_options.width = 160;
  scene_options.height = 120;
  scene_options.focal_length = 160;
  const SyntheticPlane scene(scene_options);
  for (const bool geometric : {false, true}) {
    Options options = SomeOptions(geometric);
    options.num_threads = 1;
    const MaskedHalf half(scene, geometric);
    Problem whole = half.masked();
    whole.mask = Map<uint8_t>();
    // Black is cheap to correlate: the whole scene has texture everywhere.
    whole.reference.image = scene.problem().reference.image;
    Problem all = half.masked();
    all.mask = Map<uint8_t>(160, 120, 1);
    const double seconds = SecondsOf(options, whole);
    EXPECT_LT(SecondsOf(options, half.masked()), 0.65 * seconds);
    EXPECT_LT(SecondsOf(options, all), 0.1 * seconds);
  }
}

// A mask in the middle of a wall without texture, which TAPA completes.
TEST(Mask, TapaLeavesMaskedPixelsAlone) {
  SyntheticOptions scene_options;
  scene_options.width = 160;
  scene_options.height = 120;
  scene_options.focal_length = 160;
  scene_options.num_sources = 8;
  scene_options.wall = 0.8;
  const SyntheticPlane scene(scene_options);
  Problem problem = scene.GeometricProblem();
  problem.mask = SomeMask(scene);
  for (const bool completion : {true, false}) {
    Options options = SomeOptions(true);
    options.tapa.enabled = true;
    options.tapa.completion = completion;
    // With which much is left for it to complete here.
    options.sigma_color = 0.2;
    // So that what one round filled would serve the next.
    options.tapa.fill_rounds = 3;
    TapaRecord record;
    Control control;
    control.record = &record;
    const auto estimate = EstimateDepth(options, problem, control);
    ASSERT_TRUE(estimate);
    ExpectNothingWhereMasked(problem.mask, *estimate);
    int num_completed = 0;
    for (size_t i = 0; i < problem.mask.size(); ++i) {
      const int origin = record.origin.data()[i];
      num_completed += origin == kFromPlane || origin == kFilled;
      if (problem.mask.data()[i] != 0) {
        EXPECT_EQ(origin, kNoEstimate);
        EXPECT_EQ(record.chosen.data()[i], kNumHypotheses);
      } else {
        EXPECT_LT(record.chosen.data()[i], kNumHypotheses);
      }
    }
    EXPECT_GT(num_completed, completion ? 100 : 0);
    EXPECT_GT(ShareRight(scene, problem.mask, *estimate), 0.8);
  }
}

TEST(Mask, HasTheSizeOfTheImage) {
  const SyntheticPlane scene{SyntheticOptions()};
  Problem problem = scene.problem();
  problem.mask = Map<uint8_t>(40, 48);
  try {
    EstimateDepth(SomeOptions(false), problem);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("mask"), std::string::npos);
  }
}

TEST(Mask, TakesAByteOfMemoryPerPixel) {
  const SyntheticPlane scene{SyntheticOptions()};
  Problem problem = scene.problem();
  const size_t without = EstimateDepthMemory(Options(), problem);
  problem.mask = SomeMask(scene);
  EXPECT_EQ(EstimateDepthMemory(Options(), problem),
            without + problem.mask.size());
}

}  // namespace
}  // namespace tapa
