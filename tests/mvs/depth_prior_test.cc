// Estimation with depth from elsewhere (Problem::prior).

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "src/mvs/camera_table.h"
#include "src/mvs/estimate_depth.h"
#include "src/mvs/prior_planes.h"
#include "tests/mvs/synthetic.h"

namespace tapa {
namespace {

// The plane of a scene, as a prior of another size.
Map<float> TruthOfSize(const SyntheticPlane& scene, int width, int height,
                       float factor = 1) {
  Problem problem = scene.problem();
  const Map<uint8_t>& image = *problem.reference.image;
  const RefCamera camera = CameraTable(problem).reference();
  const float distance =
      scene.depth().At(0, 0) * Dot(scene.normal(), camera.Ray(0, 0));
  Map<float> prior(width, height);
  for (int row = 0; row < height; ++row) {
    for (int col = 0; col < width; ++col) {
      const Vec3 ray = camera.Ray((row + 0.5f) / height * image.height() - 0.5f,
                                  (col + 0.5f) / width * image.width() - 0.5f);
      prior.At(row, col) = factor * distance / Dot(scene.normal(), ray);
    }
  }
  return prior;
}

TEST(PriorPlanes, HaveDepthAndSlopeOfAPriorOfAnySize) {
  const SyntheticPlane scene{SyntheticOptions()};
  Problem problem = scene.problem();
  const std::vector<std::pair<int, int>> sizes = {
      {48, 40}, {12, 10}, {13, 11}, {200, 167}, {5, 4}};
  for (const auto& [width, height] : sizes) {
    SCOPED_TRACE(width);
    problem.prior = TruthOfSize(scene, width, height);
    const Map<PackedDepthNormal> planes = PriorPlanes(problem);
    ASSERT_EQ(planes.width(), 48);
    ASSERT_EQ(planes.height(), 40);
    for (int row = 0; row < 40; ++row) {
      for (int col = 0; col < 48; ++col) {
        const DepthNormal plane = Unpack(planes.At(row, col));
        ASSERT_NEAR(plane.depth / scene.depth().At(row, col), 1, 2e-3);
        ASSERT_GT(Dot(plane.normal, scene.normal()), 0.999);
      }
    }
  }
}

TEST(PriorPlanes, KeepToOneSurface) {
  const SyntheticPlane scene{SyntheticOptions()};
  Problem problem = scene.problem();
  problem.prior = Map<float>(48, 40, 3.0f);
  for (int row = 0; row < 40; ++row) {
    for (int col = 0; col < 24; ++col) {
      problem.prior.At(row, col) = 6;
    }
  }
  const Map<PackedDepthNormal> planes = PriorPlanes(problem);
  for (int col = 0; col < 48; ++col) {
    const DepthNormal plane = Unpack(planes.At(20, col));
    EXPECT_NEAR(plane.depth, col < 24 ? 6 : 3, 1e-3) << col;
    EXPECT_LT(plane.normal.z, -0.999) << col;
  }
}

TEST(PriorPlanes, AreNoneWithoutDepthOrOutOfRange) {
  const SyntheticPlane scene{SyntheticOptions()};
  Problem problem = scene.problem();
  problem.depth_min = 2;
  problem.depth_max = 8;
  const float values[] = {0, -1, NAN, INFINITY, 1.9f, 8.1f};
  for (const float value : values) {
    problem.prior = Map<float>(48, 40, 4.0f);
    problem.prior.At(20, 20) = value;
    const Map<PackedDepthNormal> planes = PriorPlanes(problem);
    EXPECT_EQ(Unpack(planes.At(20, 20)).depth, 0) << value;
    EXPECT_NEAR(Unpack(planes.At(20, 21)).depth, 4, 1e-3) << value;
  }
  // A pixel that stands alone faces along the optical axis.
  problem.prior = Map<float>(48, 40);
  problem.prior.At(20, 20) = 5;
  const DepthNormal alone = Unpack(PriorPlanes(problem).At(20, 20));
  EXPECT_NEAR(alone.depth, 5, 1e-4);
  EXPECT_LT(alone.normal.z, -0.999);
}

// Share of the pixels of a kind whose depth is right to one per cent.
double ShareRight(const SyntheticPlane& scene, const Estimate& estimate,
                  bool wall) {
  int num_right = 0;
  int num_pixels = 0;
  for (size_t i = 0; i < scene.depth().size(); ++i) {
    if ((scene.wall().data()[i] != 0) == wall) {
      const float ratio = estimate.depth.data()[i] / scene.depth().data()[i];
      num_right += std::abs(ratio - 1) < 0.01f;
      ++num_pixels;
    }
  }
  return static_cast<double>(num_right) / num_pixels;
}

// A wall without texture between textured ones, with noise as photographs have.
SyntheticOptions WallOptions() {
  SyntheticOptions options;
  options.width = 96;
  options.height = 72;
  options.focal_length = 100;
  options.wall = 0.8;
  options.noise = 1;
  return options;
}

Options PassOptions(bool geometric, bool tapa) {
  Options options;
  options.geom_consistency = geometric;
  options.num_iterations = 2;
  options.filter = false;
  options.tapa.enabled = tapa;
  options.tapa.refinement = false;
  return options;
}

TEST(DepthPrior, IsBelievedWhereThereIsNoTexture) {
  const SyntheticPlane scene(WallOptions());
  for (const bool geometric : {false, true}) {
    for (const bool tapa : {false, true}) {
      SCOPED_TRACE(testing::Message() << geometric << tapa);
      const Options options = PassOptions(geometric, tapa);
      Problem problem = geometric ? scene.GeometricProblem() : scene.problem();
      const auto without = EstimateDepth(options, problem);
      problem.prior = TruthOfSize(scene, 48, 36);
      const auto with = EstimateDepth(options, problem);
      ASSERT_TRUE(without && with);
      EXPECT_GT(ShareRight(scene, *with, true), 0.6);
      EXPECT_GE(ShareRight(scene, *with, true),
                ShareRight(scene, *without, true));
      EXPECT_GE(ShareRight(scene, *with, false),
                ShareRight(scene, *without, false) - 0.02);
    }
  }
}

TEST(DepthPrior, PhotographsHaveTheLastWord) {
  const SyntheticPlane scene(WallOptions());
  for (const bool geometric : {false, true}) {
    for (const float factor : {0.8f, 1.25f}) {
      const Options options = PassOptions(geometric, false);
      Problem problem = geometric ? scene.GeometricProblem() : scene.problem();
      const auto without = EstimateDepth(options, problem);
      problem.prior = TruthOfSize(scene, 96, 72, factor);
      const auto with = EstimateDepth(options, problem);
      ASSERT_TRUE(without && with);
      EXPECT_GE(ShareRight(scene, *with, false),
                ShareRight(scene, *without, false) - 0.02);
    }
  }
}

TEST(DepthPrior, WithoutADepthChangesNothing) {
  const SyntheticPlane scene{SyntheticOptions()};
  const Options options = PassOptions(true, false);
  Problem problem = scene.GeometricProblem();
  const auto without = EstimateDepth(options, problem);
  problem.prior = Map<float>(20, 20);
  const auto with = EstimateDepth(options, problem);
  ASSERT_TRUE(without && with);
  EXPECT_TRUE(Same(*without, *with));
}

TEST(DepthPrior, ResultDoesNotDependOnThreads) {
  const SyntheticPlane scene(WallOptions());
  Options options = PassOptions(true, true);
  Problem problem = scene.GeometricProblem();
  problem.prior = TruthOfSize(scene, 30, 20);
  options.num_threads = 1;
  const auto one = EstimateDepth(options, problem);
  options.num_threads = 3;
  const auto three = EstimateDepth(options, problem);
  ASSERT_TRUE(one && three);
  EXPECT_TRUE(Same(*one, *three));
}

TEST(DepthPrior, TakesMemory) {
  const SyntheticPlane scene{SyntheticOptions()};
  Problem problem = scene.problem();
  const size_t without = EstimateDepthMemory(Options(), problem);
  problem.prior = Map<float>(20, 10);
  EXPECT_EQ(EstimateDepthMemory(Options(), problem),
            without + 48 * 40 * 8 + 20 * 10 * 4);
}

}  // namespace
}  // namespace tapa
