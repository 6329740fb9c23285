#include "src/mvs/sweep/hypotheses.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace tapa {
namespace {

TEST(Math, ExpNegativeIsAccurate) {
  for (float x = 0; x > -86; x -= 0.0137f) {
    EXPECT_NEAR(ExpNegative(x) / std::exp(static_cast<double>(x)), 1, 4e-7);
  }
  EXPECT_EQ(ExpNegative(-1000), 0);
}

TEST(Math, SinCosSmallIsAccurate) {
  for (double a = -0.5; a <= 0.5; a += 0.001) {
    float s, c;
    SinCosSmall(static_cast<float>(a), &s, &c);
    EXPECT_NEAR(s, std::sin(a), 1e-7);
    EXPECT_NEAR(c, std::cos(a), 1e-7);
  }
}

TEST(Random, IsUniformAndDependsOnEveryKey) {
  const int kBins = 64;
  const int kDraws = 200000;
  // Along each of the keys the numbers must be uniform, too: chi-square over
  // the bins stays below its 99.99 % quantile.
  for (const char key : {'p', 's', 'd', 'k'}) {
    std::vector<int> count(kBins);
    for (int i = 0; i < kDraws; ++i) {
      const Random random(key == 'k' ? i : 5, key == 'p' ? i : 77,
                          key == 's' ? i : 3);
      const float u = random.Uniform(key == 'd' ? i : 9);
      ASSERT_GE(u, 0.0f);
      ASSERT_LT(u, 1.0f);
      ++count[static_cast<int>(u * kBins)];
    }
    double chi_square = 0;
    for (const int n : count) {
      const double expected = static_cast<double>(kDraws) / kBins;
      chi_square += (n - expected) * (n - expected) / expected;
    }
    EXPECT_LT(chi_square, 115) << key;
  }
  EXPECT_EQ(Random(1, 2, 3).Uniform(4), Random(1, 2, 3).Uniform(4));
}

TEST(Hypotheses, RandomNormalsCoverTheVisibleHemisphere) {
  const Vec3 ray = {0.4f, -0.2f, 1.0f};
  Vec3 mean;
  const int kDraws = 50000;
  for (int i = 0; i < kDraws; ++i) {
    const Vec3 n = RandomNormal(Random(3, i, 0), ray);
    EXPECT_NEAR(Dot(n, n), 1, 1e-5);
    EXPECT_LE(Dot(n, ray), 0);
    mean = mean - (-1.0f / kDraws) * n;
  }
  // The mean of a uniform hemisphere is half its axis.
  const float norm = std::sqrt(Dot(ray, ray));
  EXPECT_NEAR(mean.x, -0.5 * ray.x / norm, 0.01);
  EXPECT_NEAR(mean.y, -0.5 * ray.y / norm, 0.01);
  EXPECT_NEAR(mean.z, -0.5 * ray.z / norm, 0.01);
}

TEST(Hypotheses, PerturbedNormalsStayUnitCloseAndVisible) {
  const Vec3 ray = {-0.3f, 0.1f, 1.0f};
  for (int i = 0; i < 20000; ++i) {
    const Vec3 normal = RandomNormal(Random(1, i, 0), ray);
    const float perturbation = 1.0f / (1 + i % 32);
    const Vec3 n = PerturbNormal(Random(2, i, 1), perturbation, normal, ray);
    EXPECT_NEAR(Dot(n, n), 1, 1e-5);
    EXPECT_LE(Dot(n, ray), 0);
    const float angle = std::acos(std::min(1.0f, Dot(n, normal)));
    EXPECT_LE(angle, 0.5f * std::sqrt(3.0f) * perturbation + 1e-3f);
  }
}

TEST(Hypotheses, RandomOnesAreTriedInTheirShareOfSweeps) {
  const int kDraws = 30000;
  for (const float share : {1.0f, 0.25f, 0.0f}) {
    int count[kNumHypotheses] = {};
    for (int i = 0; i < kDraws; ++i) {
      ++count[DrawRandomHypothesis(Random(3, i, 0), share)];
    }
    for (const int hypothesis : {kRandom, kRandomNormal, kRandomDepth}) {
      EXPECT_NEAR(count[hypothesis] / double{kDraws}, share / 3, 0.01);
    }
    EXPECT_EQ(count[kCurrent] == 0, share == 1.0f);
  }
}

TEST(Hypotheses, PerturbedDepthStaysInItsRange) {
  float lowest = 1;
  float highest = 1;
  for (int i = 0; i < 10000; ++i) {
    const float depth = PerturbDepth(Random(1, i, 0), 0.25f, 8.0f) / 8.0f;
    lowest = std::min(lowest, depth);
    highest = std::max(highest, depth);
  }
  EXPECT_GE(lowest, 0.75f);
  EXPECT_LT(lowest, 0.76f);
  EXPECT_LE(highest, 1.25f);
  EXPECT_GT(highest, 1.24f);
}

TEST(DepthNormal, PropagationStaysOnThePlane) {
  const RefCamera camera = {1 / 50.0f, 1 / 55.0f, -0.4f, -0.3f};
  const Vec3 from = camera.Ray(10, 12);
  const DepthNormal plane = {3.0f,
                             (1 / std::sqrt(1.13f)) * Vec3{0.3f, -0.2f, -1}};
  for (int row = 0; row < 40; row += 7) {
    for (int col = 0; col < 50; col += 9) {
      const Vec3 to = camera.Ray(row, col);
      const float depth = PropagateDepth(plane, from, to);
      EXPECT_NEAR(Dot(plane.normal, depth * to),
                  Dot(plane.normal, plane.depth * from), 1e-5);
    }
  }
  // A ray along the plane keeps the depth.
  EXPECT_EQ(PropagateDepth({2.0f, {1, 0, 0}}, {1, 0, 1}, {0, 0, 1}), 2.0f);
}

}  // namespace
}  // namespace tapa
