#include "src/fusion/fuse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <stdexcept>

#include "src/fusion/packed_normal.h"
#include "tests/fusion/scene.h"

namespace tapa {
namespace {

std::vector<FusedPoint> AllPoints(const FusedCloud& cloud) {
  std::vector<FusedPoint> points;
  for (const auto& view : cloud.views) {
    view.VisitPoints(
        [&points](const FusedPoint& point) { points.push_back(point); });
  }
  return points;
}

FusedCloud FuseScene(const Scene& scene, const FusionOptions& options = {},
                     int num_threads = 2) {
  FusedCloud cloud;
  FusionControl control;
  control.num_threads = num_threads;
  EXPECT_TRUE(Fuse(options, scene.Problem(), control, &cloud));
  return cloud;
}

// Multiplies depths by up to 1 + amount and takes some away.
void Disturb(double amount, unsigned seed, SurfaceMap* surface) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (size_t i = 0; i < surface->size(); ++i) {
    surface->data()[i].depth *= 1 + amount * uniform(random);
    if (uniform(random) > 0.9) {
      surface->data()[i].depth = 0;
    }
  }
}

TEST(FuseTest, TwoViewsThatAgreeSuffice) {
  const ScenePlane plane{{0.1f, 0, -1}, -4};
  const FusedCloud cloud = FuseScene(RowOfViews(2, plane));
  ASSERT_EQ(cloud.views.size(), 2u);
  // What the first view has shown the second one does not show again.
  EXPECT_GT(cloud.views[0].points.size(), 64u * 48 * 3 / 4);
  EXPECT_LT(cloud.views[1].points.size(), 64u * 48 / 3);
  EXPECT_GT(cloud.views[1].points.size(), 0u);
  for (const FusedPoint& point : AllPoints(cloud)) {
    EXPECT_NEAR(Dot(plane.normal, point.position), plane.distance, 2e-3);
    EXPECT_GT(Dot(UnpackNormal(point.normal), {0.0995f, 0, -0.995f}), 0.999);
    EXPECT_GE(point.confidence, 0.2f);
  }
  const FusedPoint& first = cloud.views[0].points[1000];
  EXPECT_EQ(first.visible, 1u);
  EXPECT_EQ(first.color.r, 1);
  EXPECT_NEAR(first.confidence, 2, 0.2);
}

TEST(FuseTest, OneViewIsNotBelieved) {
  EXPECT_EQ(FuseScene(RowOfViews(1)).NumPoints(), 0u);
}

TEST(FuseTest, PointsAreWeightedMeans) {
  Scene scene = RowOfViews(2);
  for (size_t i = 0; i < scene.surfaces[1]->size(); ++i) {
    scene.surfaces[1]->data()[i].depth *= 1.002f;
  }
  const FusedCloud cloud = FuseScene(scene);
  const auto& points = cloud.views[0].points;
  double sum = 0;
  for (const FusedPoint& point : points) {
    EXPECT_LE(point.position.z, 4.0046);
    EXPECT_GE(point.position.z, 3.9999);
    sum += point.position.z;
  }
  EXPECT_NEAR(sum / points.size(), 4.0035, 0.001);
}

TEST(FuseTest, AViewThatSeesThroughSpeaksAgainst) {
  // Two views have a patch in front of the wall, which a third looks through.
  Scene scene = RowOfViews(2);
  Scene with_third = RowOfViews(3);
  const ScenePlane patch{{0, 0, -1}, -3};
  const auto add_patch = [&](Scene* to) {
    for (int view = 0; view < 2; ++view) {
      const SurfaceMap near = SeePlane(patch, to->views[view].camera, 64, 48);
      for (int row = 16; row < 32; ++row) {
        for (int col = 20; col < 60; ++col) {
          to->surfaces[view]->At(row, col) = near.At(row, col);
        }
      }
    }
  };
  add_patch(&scene);
  add_patch(&with_third);
  const auto num_near = [](const FusedCloud& cloud) {
    int count = 0;
    for (const FusedPoint& point : AllPoints(cloud)) {
      count += point.position.z < 3.5;
    }
    return count;
  };
  FusionOptions options;
  options.spread = 0;
  EXPECT_GT(num_near(FuseScene(scene, options)), 300);
  EXPECT_LT(num_near(FuseScene(with_third, options)), 100);
  options.doubt = 0;
  EXPECT_GT(num_near(FuseScene(with_third, options)), 300);
}

TEST(FuseTest, AWallThatIsConfirmedInPartIsConfirmed) {
  Scene scene = RowOfViews(2);
  for (int row = 0; row < 24; ++row) {
    for (int col = 0; col < 64; ++col) {
      scene.surfaces[1]->At(row, col).depth = 0;
    }
  }
  FusionOptions options;
  options.spread = 0;
  const size_t alone = FuseScene(scene, options).views[0].points.size();
  options.spread = 0.3;
  const size_t together = FuseScene(scene, options).views[0].points.size();
  EXPECT_LT(alone, 64u * 48 / 2);
  EXPECT_GT(together, alone + 64 * 10);
}

TEST(FuseTest, DoesNotDependOnThreads) {
  Scene scene = RowOfViews(5);
  for (size_t i = 0; i < scene.surfaces.size(); ++i) {
    Disturb(0.006, i, scene.surfaces[i].get());
  }
  const auto one = AllPoints(FuseScene(scene, {}, 1));
  const auto four = AllPoints(FuseScene(scene, {}, 4));
  ASSERT_GT(one.size(), 1000u);
  ASSERT_EQ(one.size(), four.size());
  for (size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(std::memcmp(&one[i].position, &four[i].position, sizeof(Vec3)),
              0);
    EXPECT_EQ(one[i].normal, four[i].normal);
    EXPECT_EQ(one[i].visible, four[i].visible);
    EXPECT_EQ(one[i].confidence, four[i].confidence);
  }
}

TEST(FuseTest, LeavesOutWhatIsNotWanted) {
  const Scene scene = RowOfViews(2);
  FusionProblem problem = scene.Problem();
  problem.is_wanted = [](const Vec3& point) { return point.x > 0; };
  FusedCloud cloud;
  ASSERT_TRUE(Fuse({}, problem, {}, &cloud));
  EXPECT_GT(cloud.NumPoints(), 1000u);
  for (const FusedPoint& point : AllPoints(cloud)) {
    EXPECT_GT(point.position.x, 0);
  }
}

TEST(FuseTest, StopsAndReportsProgress) {
  const Scene scene = RowOfViews(3);
  FusionControl control;
  double last = 0;
  control.progress = [&](double share) {
    EXPECT_GE(share, last - 1e-9);
    EXPECT_LE(share, 1 + 1e-9);
    last = share;
    return true;
  };
  FusedCloud cloud;
  EXPECT_TRUE(Fuse({}, scene.Problem(), control, &cloud));
  EXPECT_NEAR(last, 1, 1e-6);
  control.progress = [&](double share) { return share < 0.5; };
  FusedCloud part;
  EXPECT_FALSE(Fuse({}, scene.Problem(), control, &part));
}

TEST(FuseTest, SurvivesStrangeMaps) {
  Scene scene = RowOfViews(2);
  const float inf = std::numeric_limits<float>::infinity();
  const float values[] = {inf, -inf, NAN, -1, 0, 1e-30f, 1e30f};
  for (size_t i = 0; i < scene.surfaces[1]->size(); ++i) {
    scene.surfaces[i % 2]->data()[i].depth = values[i % 7];
  }
  for (const FusedPoint& point : AllPoints(FuseScene(scene))) {
    EXPECT_TRUE(std::isfinite(point.position.z));
  }
}

TEST(FuseTest, RefusesMapsOfAnotherSizeAndBadOptions) {
  Scene scene = RowOfViews(2);
  FusionOptions options;
  options.num_views = 65;
  FusedCloud cloud;
  EXPECT_THROW(Fuse(options, scene.Problem(), {}, &cloud),
               std::invalid_argument);
  *scene.surfaces[1] = SurfaceMap(10, 10);
  EXPECT_THROW(Fuse({}, scene.Problem(), {}, &cloud), std::invalid_argument);
}

}  // namespace
}  // namespace tapa
