#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "src/mvs/tapa/superpixel_planes.h"
#include "tests/mvs/tapa_reference.h"

namespace tapa {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

RefCamera MakeCamera(int width, int height) {
  const float focal = 0.9f * width;
  return {1 / focal, 1 / focal, -0.5f * width / focal, -0.5f * height / focal};
}

// Superpixels as columns of the same width, without any neighbours yet.
Superpixels Stripes(int width, int height, int count) {
  Superpixels superpixels;
  superpixels.labels = Map<uint16_t>(width, height);
  for (int row = 0; row < height; ++row) {
    for (int col = 0; col < width; ++col) {
      superpixels.labels.At(row, col) =
          static_cast<uint16_t>(col * count / width);
    }
  }
  superpixels.neighbors.resize(count);
  return superpixels;
}

Plane MakePlane(float x, float y, float z, float distance) {
  const float norm = std::sqrt(x * x + y * y + z * z);
  return {{x / norm, y / norm, z / norm}, distance};
}

Map<float> Render(const RefCamera& camera, const Superpixels& superpixels,
                  const std::vector<Plane>& planes) {
  const Map<uint16_t>& labels = superpixels.labels;
  Map<float> depth(labels.width(), labels.height());
  for (int row = 0; row < depth.height(); ++row) {
    for (int col = 0; col < depth.width(); ++col) {
      depth.At(row, col) =
          PlaneAt(planes[labels.At(row, col)], camera.Ray(row, col)).depth;
    }
  }
  return depth;
}

void ExpectPlane(const Plane& actual, const Plane& expected, double tolerance) {
  EXPECT_NEAR(actual.normal.x, expected.normal.x, tolerance);
  EXPECT_NEAR(actual.normal.y, expected.normal.y, tolerance);
  EXPECT_NEAR(actual.normal.z, expected.normal.z, tolerance);
  EXPECT_NEAR(actual.distance, expected.distance,
              tolerance * expected.distance);
}

bool Same(const std::vector<FittedPlane>& a,
          const std::vector<FittedPlane>& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
}

TapaOptions RelativeDistance(double distance) {
  TapaOptions options;
  options.plane_distance = -1;
  options.relative_plane_distance = distance;
  return options;
}

const std::vector<Plane> kPlanes = {
    MakePlane(0.1f, 0.2f, -1, 3), MakePlane(-0.5f, 0, -1, 4),
    MakePlane(0, -0.4f, -1, 2), MakePlane(0, 0, -1, 5)};

TEST(FitPlanes, FindsThePlaneOfEverySuperpixel) {
  const RefCamera camera = MakeCamera(80, 60);
  const Superpixels superpixels = Stripes(80, 60, 4);
  Map<float> depth = Render(camera, superpixels, kPlanes);
  const std::vector<FittedPlane> exact =
      FitPlanes(RelativeDistance(0.01), camera, depth, superpixels, 1);
  ASSERT_EQ(exact.size(), 4u);
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(exact[k].inlier_ratio, 1);
    ExpectPlane(exact[k].plane, kPlanes[k], 1e-4);
  }

  // A third without depth, which the ratio does not count, and a fifth of the
  // rest wrong, which it does.
  std::mt19937 random(1);
  int num_points[4] = {};
  int num_right[4] = {};
  for (size_t i = 0; i < depth.size(); ++i) {
    const int k = superpixels.labels.data()[i];
    if (random() % 3 == 0) {
      depth.data()[i] = 0;
      continue;
    }
    ++num_points[k];
    if (random() % 5 == 0) {
      depth.data()[i] *= 1.3f + 0.001f * (random() % 100);
    } else {
      depth.data()[i] *= 1 + 0.002f * (random() % 100 * 0.01f - 0.5f);
      ++num_right[k];
    }
  }
  const std::vector<FittedPlane> fits =
      FitPlanes(RelativeDistance(0.01), camera, depth, superpixels, 1);
  for (int k = 0; k < 4; ++k) {
    ExpectPlane(fits[k].plane, kPlanes[k], 2e-3);
    EXPECT_FLOAT_EQ(fits[k].inlier_ratio,
                    static_cast<float>(num_right[k]) / num_points[k]);
  }
}

TEST(FitPlanes, ResultScalesWithTheScene) {
  const RefCamera camera = MakeCamera(60, 60);
  const Superpixels superpixels = Stripes(60, 60, 3);
  Map<float> depth = Render(camera, superpixels, kPlanes);
  std::mt19937 random(2);
  for (size_t i = 0; i < depth.size(); ++i) {
    depth.data()[i] *= 1 + 0.04f * (random() % 1000 * 0.001f - 0.5f);
  }
  const auto fits =
      FitPlanes(RelativeDistance(0.01), camera, depth, superpixels, 5);
  for (const float scale : {1024.0f, 1.0f / 1024}) {
    Map<float> scaled = depth;
    for (size_t i = 0; i < depth.size(); ++i) {
      scaled.data()[i] *= scale;
    }
    const auto scaled_fits =
        FitPlanes(RelativeDistance(0.01), camera, scaled, superpixels, 5);
    for (int k = 0; k < 3; ++k) {
      EXPECT_LT(fits[k].inlier_ratio, 0.9f);
      EXPECT_NEAR(scaled_fits[k].inlier_ratio, fits[k].inlier_ratio, 2e-3);
      Plane expected = fits[k].plane;
      expected.distance *= scale;
      ExpectPlane(scaled_fits[k].plane, expected, 1e-4);
    }
  }
}

TEST(FitPlanes, AbsoluteDistanceReplacesTheRelativeOne) {
  const RefCamera camera = MakeCamera(60, 60);
  const Superpixels superpixels = Stripes(60, 60, 1);
  Map<float> depth = Render(camera, superpixels, {MakePlane(0, 0, -1, 10)});
  // Every other pixel half a unit behind.
  for (size_t i = 0; i < depth.size(); i += 2) {
    depth.data()[i] += 0.5f;
  }
  const auto ratio = [&](double absolute, double relative) {
    TapaOptions options;
    options.plane_distance = absolute;
    options.relative_plane_distance = relative;
    return FitPlanes(options, camera, depth, superpixels, 1)[0].inlier_ratio;
  };
  EXPECT_NEAR(ratio(0.05, 1), 0.5, 0.1);
  EXPECT_EQ(ratio(0.6, 1e-9), 1);
  EXPECT_EQ(ratio(-1, 0.06), 1);
  EXPECT_EQ(ratio(0, 0.06), 1);
  EXPECT_NEAR(ratio(-1, 0.005), 0.5, 0.1);
}

TEST(FitPlanes, WithoutDepthThereIsNone) {
  const RefCamera camera = MakeCamera(40, 30);
  const Superpixels superpixels = Stripes(40, 30, 4);
  for (const float value : {0.0f, -0.0f, -2.0f, kNan, kInf, -kInf}) {
    const Map<float> depth(40, 30, value);
    for (const FittedPlane& fit :
         FitPlanes(TapaOptions(), camera, depth, superpixels, 1)) {
      EXPECT_EQ(fit.inlier_ratio, 0) << value;
    }
  }
  EXPECT_TRUE(
      FitPlanes(TapaOptions(), camera, Map<float>(), Superpixels(), 1).empty());
}

TEST(FitPlanes, AllEqualDepthIsAPlaneAcrossTheAxis) {
  const RefCamera camera = MakeCamera(40, 30);
  const Superpixels superpixels = Stripes(40, 30, 3);
  const Map<float> depth(40, 30, 7.0f);
  for (const FittedPlane& fit :
       FitPlanes(RelativeDistance(0.01), camera, depth, superpixels, 1)) {
    EXPECT_EQ(fit.inlier_ratio, 1);
    ExpectPlane(fit.plane, MakePlane(0, 0, -1, 7), 1e-5);
  }
}

TEST(FitPlanes, IgnoresWhatIsNoDepth) {
  const RefCamera camera = MakeCamera(80, 60);
  const Superpixels superpixels = Stripes(80, 60, 4);
  Map<float> zeros = Render(camera, superpixels, kPlanes);
  std::mt19937 random(3);
  for (size_t i = 0; i < zeros.size(); i += 1 + random() % 4) {
    zeros.data()[i] = 0;
  }
  const auto expected =
      FitPlanes(RelativeDistance(0.01), camera, zeros, superpixels, 1);
  for (const float value : {-1.0f, -0.0f, kNan, kInf, -kInf}) {
    Map<float> depth = zeros;
    for (size_t i = 0; i < depth.size(); ++i) {
      if (depth.data()[i] == 0) {
        depth.data()[i] = value;
      }
    }
    EXPECT_TRUE(
        Same(FitPlanes(RelativeDistance(0.01), camera, depth, superpixels, 1),
             expected))
        << value;
  }
}

TEST(FitPlanes, NeedsPointsAtAHundredthOfThePixels) {
  const RefCamera camera = MakeCamera(100, 100);
  const Superpixels superpixels = Stripes(100, 100, 1);
  const Map<float> full = Render(camera, superpixels, kPlanes);
  const auto ratio = [&](int num_points) {
    std::vector<int> pixels(full.size());
    for (size_t i = 0; i < pixels.size(); ++i) {
      pixels[i] = static_cast<int>(i);
    }
    std::shuffle(pixels.begin(), pixels.end(), std::mt19937(4));
    Map<float> depth(100, 100, 0.0f);
    for (int i = 0; i < num_points; ++i) {
      depth.data()[pixels[i]] = full.data()[pixels[i]];
    }
    return FitPlanes(RelativeDistance(0.01), camera, depth, superpixels, 1)[0]
        .inlier_ratio;
  };
  EXPECT_EQ(ratio(0), 0);
  EXPECT_EQ(ratio(2), 0);
  EXPECT_EQ(ratio(99), 0);
  EXPECT_EQ(ratio(100), 1);
}

TEST(FitPlanes, WorksForSuperpixelsOfOnePixel) {
  const RefCamera camera = MakeCamera(12, 10);
  const Superpixels superpixels = Stripes(12, 1, 12);
  for (const FittedPlane& fit : FitPlanes(
           TapaOptions(), camera, Map<float>(12, 1, 2.0f), superpixels, 1)) {
    EXPECT_EQ(fit.inlier_ratio, 0);
  }
  // A line of pixels is no plane, however long.
  const Superpixels line = Stripes(500, 1, 1);
  EXPECT_EQ(FitPlanes(TapaOptions(), MakeCamera(500, 1),
                      Map<float>(500, 1, 2.0f), line, 1)[0]
                .inlier_ratio,
            0);
}

TEST(FitPlanes, SeedDecidesTheResult) {
  const RefCamera camera = MakeCamera(80, 60);
  const Superpixels superpixels = Stripes(80, 60, 4);
  Map<float> depth = Render(camera, superpixels, kPlanes);
  std::mt19937 random(5);
  for (size_t i = 0; i < depth.size(); ++i) {
    depth.data()[i] *= 0.8f + 0.0004f * (random() % 1000);
  }
  const auto fit = [&](uint64_t seed) {
    return FitPlanes(RelativeDistance(0.01), camera, depth, superpixels, seed);
  };
  EXPECT_TRUE(Same(fit(1), fit(1)));
  EXPECT_FALSE(Same(fit(1), fit(2)));
}

FittedPlane PlaneWithRatio(float ratio) {
  FittedPlane fit;
  fit.plane = MakePlane(0, 0, -1, 1 + ratio);
  fit.inlier_ratio = ratio;
  return fit;
}

// How often the pixels of superpixel `own` drew each plane, and at the end
// none.
std::vector<int> CountDraws(const Superpixels& superpixels, const PlaneSet& set,
                            int own) {
  std::vector<int> counts(superpixels.count() + 1, 0);
  for (size_t i = 0; i < superpixels.labels.size(); ++i) {
    if (superpixels.labels.data()[i] == own) {
      const uint16_t index = set.index.data()[i];
      ++counts[index == PlaneSet::kNone ? superpixels.count() : index];
    }
  }
  return counts;
}

// Pearson's statistic; shares sum to 1, and where one is 0 nothing may be
// drawn.
double ChiSquare(const std::vector<int>& counts,
                 const std::vector<double>& shares) {
  double total = 0;
  for (const int count : counts) {
    total += count;
  }
  double sum = 0;
  for (size_t i = 0; i < counts.size(); ++i) {
    const double expected = shares[i] * total;
    if (expected == 0) {
      EXPECT_EQ(counts[i], 0) << i;
    } else {
      sum += (counts[i] - expected) * (counts[i] - expected) / expected;
    }
  }
  return sum;
}

TEST(DrawPlanes, FrequenciesAreInlierRatiosAndSimilarities) {
  Superpixels superpixels = Stripes(400, 500, 5);
  // Of superpixel 0: plane, similar and less similar neighbours, one without a
  // plane and one unlike it.
  superpixels.neighbors[0] = {{1, 0.9f}, {2, 0.3f}, {3, 0.8f}, {4, 0.0f}};
  superpixels.neighbors[1] = {{0, 0.9f}};
  superpixels.neighbors[2] = {{3, 1.0f}};
  superpixels.neighbors[3] = {{0, 0.2f}, {1, 0.2f}, {4, 0.6f}};
  superpixels.neighbors[4] = {};
  const std::vector<FittedPlane> planes = {
      PlaneWithRatio(0.4f), PlaneWithRatio(1.0f), PlaneWithRatio(0.7f),
      PlaneWithRatio(0.0f), PlaneWithRatio(0.25f)};
  const std::vector<std::vector<double>> shares = {
      {0.4, 0.45, 0.15, 0, 0, 0},  // 0.6 in the proportion 0.9 : 0.3
      {0, 1, 0, 0, 0, 0},
      {0, 0, 0.7, 0, 0, 0.3},  // its only neighbour has no plane
      {0.2, 0.2, 0, 0, 0.6, 0},
      {0, 0, 0, 0, 0.25, 0.75}};
  for (const uint64_t seed : {0ull, 1ull, 0x123456789ABCDEFull}) {
    for (const uint32_t round : {0u, 1u, 7u}) {
      const PlaneSet set = DrawPlanes(superpixels, planes, seed, round);
      ASSERT_EQ(set.index.width(), 400);
      ASSERT_EQ(set.index.height(), 500);
      for (int k = 0; k < 5; ++k) {
        // Beyond 16.3 once in a thousand times for three degrees of freedom.
        EXPECT_LT(ChiSquare(CountDraws(superpixels, set, k), shares[k]), 16.3)
            << "superpixel " << k << " seed " << seed << " round " << round;
      }
    }
  }
}

TEST(DrawPlanes, PlanesAreThoseThatWereFitted) {
  Superpixels superpixels = Stripes(30, 20, 3);
  superpixels.neighbors = {{{1, 0.5f}}, {{0, 0.5f}, {2, 0.5f}}, {{1, 0.5f}}};
  const std::vector<FittedPlane> planes = {
      PlaneWithRatio(0.4f), PlaneWithRatio(0.5f), PlaneWithRatio(0.7f)};
  const PlaneSet set = DrawPlanes(superpixels, planes, 1, 0);
  for (size_t i = 0; i < set.index.size(); ++i) {
    const uint16_t index = set.index.data()[i];
    ASSERT_LT(index, 3);
    EXPECT_EQ(set.planes[index].distance, planes[index].plane.distance);
  }
}

TEST(DrawPlanes, RoundAndSeedChangeDrawsOnly) {
  Superpixels superpixels = Stripes(100, 100, 2);
  superpixels.neighbors = {{{1, 0.5f}}, {{0, 0.5f}}};
  const std::vector<FittedPlane> planes = {PlaneWithRatio(0.5f),
                                           PlaneWithRatio(0.5f)};
  const auto draw = [&](uint64_t seed, uint32_t round) {
    return DrawPlanes(superpixels, planes, seed, round).index;
  };
  // Share of the pixels that draw the same, about a half if independent.
  const auto agreement = [&](const Map<uint16_t>& a, const Map<uint16_t>& b) {
    int num_same = 0;
    for (size_t i = 0; i < a.size(); ++i) {
      num_same += a.data()[i] == b.data()[i];
    }
    return static_cast<double>(num_same) / a.size();
  };
  EXPECT_EQ(agreement(draw(1, 2), draw(1, 2)), 1);
  EXPECT_NEAR(agreement(draw(1, 2), draw(1, 3)), 0.5, 0.03);
  EXPECT_NEAR(agreement(draw(1, 2), draw(2, 2)), 0.5, 0.03);
  EXPECT_NEAR(agreement(draw(1, 2), draw(2, 1)), 0.5, 0.03);
}

TEST(DrawPlanes, ASingleSuperpixelHasOnlyItsOwnPlane) {
  const Superpixels superpixels = Stripes(100, 100, 1);
  EXPECT_LT(
      ChiSquare(
          CountDraws(superpixels,
                     DrawPlanes(superpixels, {PlaneWithRatio(0.3f)}, 1, 0), 0),
          {0.3, 0.7}),
      10.8);
  const PlaneSet none = DrawPlanes(superpixels, {PlaneWithRatio(0.0f)}, 1, 0);
  EXPECT_EQ(CountDraws(superpixels, none, 0)[1], 100 * 100);
  const Superpixels pixel = Stripes(1, 1, 1);
  EXPECT_EQ(DrawPlanes(pixel, {PlaneWithRatio(1.0f)}, 1, 0).index.At(0, 0), 0);
}

TEST(DrawPlanes, AcceptsAnEmptyImage) {
  const PlaneSet set = DrawPlanes(Superpixels(), {}, 1, 0);
  EXPECT_TRUE(set.index.empty());
  EXPECT_TRUE(set.planes.empty());
}

}  // namespace
}  // namespace tapa
