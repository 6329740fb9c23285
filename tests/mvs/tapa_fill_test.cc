#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "src/base/depth.h"
#include "src/mvs/sweep/hypotheses.h"
#include "src/mvs/tapa/fill.h"
#include "tests/mvs/synthetic.h"
#include "tests/mvs/tapa_reference.h"

namespace tapa {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

RefCamera MakeCamera(int width, int height) {
  const float focal = 60;
  return {1 / focal, 1 / focal, -0.5f * width / focal, -0.5f * height / focal};
}

struct Scene {
  Scene(int width, int height, double share_missing, unsigned seed)
      : camera(MakeCamera(width, height)),
        depth(width, height),
        normal(width, height) {
    std::mt19937 random(seed);
    image = RandomImage(width, height, &random);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (int row = 0; row < height; ++row) {
      for (int col = 0; col < width; ++col) {
        normal.At(row, col) =
            RandomNormal(Random(random(), 0, 0), camera.Ray(row, col));
        // Two surfaces with relief.
        depth.At(row, col) = (col < width / 2 ? 2 : 5) + uniform(random);
        if (uniform(random) < share_missing) {
          depth.At(row, col) = 0;
          normal.At(row, col) = Vec3();
        }
      }
    }
  }

  RefCamera camera;
  Map<uint8_t> image;
  Map<float> depth;
  Map<Vec3> normal;
};

int CountDepths(const Map<float>& depth) {
  return static_cast<int>(
      std::count_if(depth.data(), depth.data() + depth.size(), IsDepth));
}

// Returns the number of pixels filled.
int CountFilled(const FillOptions& options, const RefCamera& camera,
                const Map<uint8_t>& image, Map<float>* depth,
                Map<Vec3>* normal) {
  const int num_before = CountDepths(*depth);
  FillMissing(options, camera, image, depth, normal);
  return CountDepths(*depth) - num_before;
}

void ExpectReference(const FillOptions& options, const Scene& scene) {
  Scene actual = scene;
  Scene expected = scene;
  FillMissing(options, scene.camera, scene.image, &actual.depth,
              &actual.normal);
  reference::FillMissing(options, scene.camera, scene.image, &expected.depth,
                         &expected.normal);
  for (size_t i = 0; i < scene.depth.size(); ++i) {
    const float depth = expected.depth.data()[i];
    ASSERT_NEAR(actual.depth.data()[i], depth, 1e-5 * depth) << i;
    const Vec3 difference = actual.normal.data()[i] - expected.normal.data()[i];
    ASSERT_LT(Dot(difference, difference), 1e-8) << i;
  }
}

TEST(FillMissing, AgreesWithReference) {
  const struct {
    int width, height;
  } sizes[] = {{1, 1}, {1, 40}, {40, 1}, {3, 3}, {37, 29}};
  unsigned seed = 0;
  for (const auto& size : sizes) {
    for (const double share_missing : {0.0, 0.2, 0.7, 0.97, 1.0}) {
      const Scene scene(size.width, size.height, share_missing, ++seed);
      for (const int radius : {0, 1, 3, 5}) {
        for (const int num_rounds : {0, 1, 3}) {
          SCOPED_TRACE(testing::Message()
                       << size.width << "x" << size.height << " missing "
                       << share_missing << " radius " << radius << " rounds "
                       << num_rounds);
          FillOptions options;
          options.radius = radius;
          options.num_rounds = num_rounds;
          options.sigma_spatial = 1.0f + radius;
          options.sigma_color = 0.1f + 0.1f * radius;
          ExpectReference(options, scene);
        }
      }
    }
  }
}

TEST(FillMissing, AcceptsAnEmptyImage) {
  Map<float> depth;
  Map<Vec3> normal;
  EXPECT_EQ(CountFilled(FillOptions(), MakeCamera(1, 1), Map<uint8_t>(), &depth,
                        &normal),
            0);
}

TEST(FillMissing, LeavesEstimatesAlone) {
  const Scene before(40, 30, 0.5, 1);
  Scene after = before;
  FillOptions options;
  options.num_rounds = 3;
  const int num_filled = CountFilled(options, before.camera, before.image,
                                     &after.depth, &after.normal);
  int num_missing = 0;
  for (size_t i = 0; i < before.depth.size(); ++i) {
    if (before.depth.data()[i] > 0) {
      EXPECT_EQ(after.depth.data()[i], before.depth.data()[i]);
      EXPECT_EQ(std::memcmp(&after.normal.data()[i], &before.normal.data()[i],
                            sizeof(Vec3)),
                0);
    } else {
      num_missing += after.depth.data()[i] > 0;
    }
  }
  EXPECT_EQ(num_filled, num_missing);
  EXPECT_GT(num_filled, 0);
}

TEST(FillMissing, EqualDepthStaysEqual) {
  Scene scene(30, 20, 0.6, 2);
  for (size_t i = 0; i < scene.depth.size(); ++i) {
    if (scene.depth.data()[i] > 0) {
      scene.depth.data()[i] = 3.7f;
      scene.normal.data()[i] = {0, 0, -1};
    }
  }
  FillMissing(FillOptions(), scene.camera, scene.image, &scene.depth,
              &scene.normal);
  for (size_t i = 0; i < scene.depth.size(); ++i) {
    EXPECT_EQ(scene.depth.data()[i], 3.7f);
    EXPECT_FLOAT_EQ(scene.normal.data()[i].z, -1);
  }
}

TEST(FillMissing, ReachesTheRadiusInEachRound) {
  const auto reach = [](int radius, int num_rounds) {
    Map<float> depth(61, 61, 0.0f);
    Map<Vec3> normal(61, 61);
    depth.At(30, 30) = 2;
    normal.At(30, 30) = {0, 0, -1};
    FillOptions options;
    options.radius = radius;
    options.num_rounds = num_rounds;
    const int num_filled =
        CountFilled(options, MakeCamera(61, 61), Map<uint8_t>(61, 61, 100),
                    &depth, &normal);
    // A square around the pixel.
    int half = 0;
    while (half < 30 && depth.At(30, 31 + half) > 0) {
      ++half;
    }
    for (int row = 0; row < 61; ++row) {
      for (int col = 0; col < 61; ++col) {
        const int distance = std::max(std::abs(row - 30), std::abs(col - 30));
        EXPECT_EQ(depth.At(row, col), distance <= half ? 2 : 0);
      }
    }
    EXPECT_EQ(num_filled, (2 * half + 1) * (2 * half + 1) - 1);
    return half;
  };
  EXPECT_EQ(reach(0, 5), 0);
  EXPECT_EQ(reach(1, 1), 1);
  EXPECT_EQ(reach(5, 1), 5);
  EXPECT_EQ(reach(5, 3), 15);
  EXPECT_EQ(reach(3, 100), 30);
  EXPECT_EQ(reach(5, 0), 0);
}

TEST(FillMissing, WithoutEstimatesThereIsNothing) {
  for (const float value : {0.0f, -0.0f, -1.0f, kNan, kInf, -kInf}) {
    Map<float> depth(20, 20, value);
    Map<Vec3> normal(20, 20);
    EXPECT_EQ(CountFilled(FillOptions(), MakeCamera(20, 20),
                          Map<uint8_t>(20, 20), &depth, &normal),
              0);
  }
}

TEST(FillMissing, FillsWhatIsNoDepth) {
  const Scene scene(40, 30, 0.4, 3);
  Scene expected = scene;
  const int num_filled = CountFilled(FillOptions(), scene.camera, scene.image,
                                     &expected.depth, &expected.normal);
  for (const float value : {-1.0f, kNan, kInf, -kInf}) {
    Scene actual = scene;
    for (size_t i = 0; i < actual.depth.size(); ++i) {
      if (actual.depth.data()[i] == 0) {
        actual.depth.data()[i] = value;
        actual.normal.data()[i] = {kNan, 0, -1};
      }
    }
    EXPECT_EQ(CountFilled(FillOptions(), scene.camera, scene.image,
                          &actual.depth, &actual.normal),
              num_filled);
    EXPECT_EQ(std::memcmp(actual.depth.data(), expected.depth.data(),
                          expected.depth.size() * sizeof(float)),
              0)
        << value;
  }
}

TEST(FillMissing, KeepsDiscontinuities) {
  // Two slanted surfaces with a gap between them that covers the step.
  constexpr int kSize = 40;
  const RefCamera camera = MakeCamera(kSize, kSize);
  Map<float> depth(kSize, kSize, 0.0f);
  Map<Vec3> normal(kSize, kSize);
  Map<uint8_t> image(kSize, kSize, 60);
  const auto truth = [](int row, int col) {
    return (col < 20 ? 2.0f : 6.0f) + 0.01f * row;
  };
  for (int row = 0; row < kSize; ++row) {
    for (int col = 0; col < kSize; ++col) {
      if (col >= 20) {
        image.At(row, col) = 180;
      }
      if (std::abs(col - 19.5) > 2) {
        depth.At(row, col) = truth(row, col);
        normal.At(row, col) = {0, 0, -1};
      }
    }
  }
  EXPECT_EQ(CountFilled(FillOptions(), camera, image, &depth, &normal),
            4 * kSize);
  for (int row = 0; row < kSize; ++row) {
    for (int col = 0; col < kSize; ++col) {
      const float filled = depth.At(row, col);
      // Never between the surfaces, and on the right one where that fills more
      // of the window.
      EXPECT_TRUE(filled < 2.5f || filled > 5.9f) << row << " " << col;
      EXPECT_NEAR(filled, truth(row, col), 0.1) << row << " " << col;
    }
  }
}

TEST(FillMissing, OfEquallyFullBinsTheNearestWins) {
  Map<float> depth(3, 1, 0.0f);
  Map<Vec3> normal(3, 1, {0, 0, -1});
  FillOptions options;
  options.radius = 1;
  for (const bool near_first : {false, true}) {
    depth.At(0, 0) = near_first ? 1 : 9;
    depth.At(0, 1) = 0;
    depth.At(0, 2) = near_first ? 9 : 1;
    ASSERT_EQ(CountFilled(options, MakeCamera(3, 1), Map<uint8_t>(3, 1), &depth,
                          &normal),
              1);
    EXPECT_EQ(depth.At(0, 1), 1);
  }
}

TEST(FillMissing, WeighsByDistanceAndIntensity) {
  // Equal depths but for little: one bin would hold both if there were no
  // range, so two near depths stand beside a third that widens the range.
  Map<float> depth(4, 1, 0.0f);
  Map<Vec3> normal(4, 1, {0, 0, -1});
  Map<uint8_t> image(4, 1, 100);
  depth.At(0, 0) = 2.0f;
  depth.At(0, 2) = 2.1f;
  depth.At(0, 3) = 9.0f;
  image.At(0, 0) = 151;
  FillOptions options;
  options.radius = 2;
  options.sigma_spatial = 3;
  options.sigma_color = 0.2f;
  ASSERT_EQ(CountFilled(options, MakeCamera(4, 1), image, &depth, &normal), 1);
  // Both one pixel away; the first differs by a fifth, one sigma.
  const double weight = std::exp(-0.5);
  EXPECT_NEAR(depth.At(0, 1), (2.0 * weight + 2.1) / (weight + 1), 1e-6);
}

TEST(FillMissing, LeavesOutNormalsThatWouldFaceAway) {
  const RefCamera camera = MakeCamera(200, 3);
  Map<float> depth(200, 3, 0.0f);
  Map<Vec3> normal(200, 3);
  // Visible from its own pixel, not from those to its right.
  const Vec3 ray = camera.Ray(1, 100);
  const Vec3 slanted = {0.9999f, 0, -0.0141f};
  ASSERT_LT(Dot(slanted, ray), 0);
  depth.At(1, 100) = 2;
  normal.At(1, 100) = slanted;
  FillMissing(FillOptions(), camera, Map<uint8_t>(200, 3), &depth, &normal);
  for (int row = 0; row < 3; ++row) {
    for (int col = 95; col <= 105; ++col) {
      const bool visible = Dot(slanted, camera.Ray(row, col)) < 0;
      EXPECT_EQ(depth.At(row, col) > 0, visible) << row << " " << col;
    }
  }
  // Normals that cancel out give no direction.
  Map<float> two(3, 1, 2.0f);
  two.At(0, 1) = 0;
  Map<Vec3> opposite(3, 1);
  opposite.At(0, 0) = {1, 0, 0};
  opposite.At(0, 2) = {-1, 0, 0};
  EXPECT_EQ(CountFilled(FillOptions(), MakeCamera(3, 1), Map<uint8_t>(3, 1),
                        &two, &opposite),
            0);
  EXPECT_EQ(two.At(0, 1), 0);
}

TEST(FillMissing, FillsUpToTheBorder) {
  for (const bool vertical : {false, true}) {
    for (const int border : {0, 19}) {
      Map<float> depth(20, 20, 4.0f);
      Map<Vec3> normal(20, 20, {0, 0, -1});
      for (int i = 0; i < 20; ++i) {
        depth.At(vertical ? i : border, vertical ? border : i) = 0;
      }
      EXPECT_EQ(CountFilled(FillOptions(), MakeCamera(20, 20),
                            Map<uint8_t>(20, 20, 255), &depth, &normal),
                20);
      for (size_t i = 0; i < depth.size(); ++i) {
        EXPECT_EQ(depth.data()[i], 4);
      }
    }
  }
}

TEST(FillMissing, IsDeterministic) {
  const Scene scene(60, 50, 0.7, 5);
  Scene a = scene;
  Scene b = scene;
  FillOptions options;
  options.num_rounds = 2;
  FillMissing(options, scene.camera, scene.image, &a.depth, &a.normal);
  FillMissing(options, scene.camera, scene.image, &b.depth, &b.normal);
  EXPECT_EQ(std::memcmp(a.depth.data(), b.depth.data(),
                        a.depth.size() * sizeof(float)),
            0);
  EXPECT_EQ(std::memcmp(a.normal.data(), b.normal.data(),
                        a.normal.size() * sizeof(Vec3)),
            0);
}

}  // namespace
}  // namespace tapa
