#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "src/mvs/sweep/hypotheses.h"
#include "src/mvs/tapa/completion.h"
#include "src/mvs/tapa/silhouettes.h"
#include "tests/mvs/synthetic.h"

namespace tapa {
namespace {

constexpr int kWidth = 90;
constexpr int kHeight = 50;
constexpr float kFront = 2;
constexpr float kBehind = 4;

// Two surfaces that face the camera, with a silhouette in column 40 of texture
// in which the front one's colour ends. Its estimates go on for four columns.
struct Scene {
  Scene()
      : camera{0.01f, 0.01f, -0.45f, -0.25f},
        color(kWidth, kHeight, {60, 60, 60}),
        textureness(kWidth, kHeight, 0.2f),
        depth(kWidth, kHeight, kFront),
        normal(kWidth, kHeight, {0, 0, -1}),
        origin(kWidth, kHeight, kSwept) {
    problem.depth_min = 1;
    problem.depth_max = 10;
    for (int row = 0; row < kHeight; ++row) {
      for (int col = 40; col < kWidth; ++col) {
        color.At(row, col) = {160, 120, 160};
        depth.At(row, col) = col < 44 ? kFront : kBehind;
      }
      textureness.At(row, 39) = textureness.At(row, 40) = 0.9f;
    }
  }

  void Mend() {
    MendSilhouettes(options, problem, camera, color, textureness, &depth,
                    &normal, &origin);
  }

  Options options;
  Problem problem;
  RefCamera camera;
  Map<Rgb> color;
  Map<float> textureness;
  Map<float> depth;
  Map<Vec3> normal;
  Map<uint8_t> origin;
};

TEST(Silhouettes, EndWhereTheColourDoes) {
  Scene scene;
  scene.Mend();
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; ++col) {
      EXPECT_EQ(scene.depth.At(row, col), col < 40 ? kFront : kBehind)
          << row << " " << col;
      const bool is_mended = col >= 40 && col < 44;
      EXPECT_EQ(scene.origin.At(row, col), is_mended ? kFromPlane : kSwept);
    }
  }
}

TEST(Silhouettes, StayWhereNoneOfTheirColourIsAwayFromTexture) {
  Scene scene;
  // A bar in front, thinner than a window, of a colour of its own.
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 58; col < 62; ++col) {
      scene.color.At(row, col) = {20, 200, 20};
      scene.depth.At(row, col) = kFront;
      scene.textureness.At(row, col) = 0.9f;
    }
  }
  scene.Mend();
  EXPECT_EQ(scene.depth.At(25, 60), kFront);
  EXPECT_EQ(scene.depth.At(25, 55), kBehind);
}

TEST(Silhouettes, StayWithoutTextureAndWithoutEstimates) {
  Scene scene;
  scene.depth.At(25, 42) = 0;
  scene.Mend();
  EXPECT_EQ(scene.depth.At(25, 42), 0);
  EXPECT_EQ(scene.depth.At(25, 43), kBehind);

  Scene plain;
  plain.textureness = Map<float>(kWidth, kHeight, 0.2f);
  plain.Mend();
  EXPECT_EQ(plain.depth.At(25, 42), kFront);
}

// The definition in the header, one pixel after the other.
struct NaiveOpinion {
  double depth;
  double weight;
  Vec3 normal;
};

bool IsNearTexture(const Scene& scene, int row, int col) {
  const int radius = scene.options.window_radius;
  for (int y = std::max(0, row - radius);
       y <= std::min(kHeight - 1, row + radius); ++y) {
    // Of each row as much as OpenCV's ellipse has.
    const int dy = y - row;
    const int dx =
        static_cast<int>(std::lround(std::sqrt(radius * radius - dy * dy)));
    for (int x = std::max(0, col - dx); x <= std::min(kWidth - 1, col + dx);
         ++x) {
      if (scene.textureness.At(y, x) > 0.5) {
        return true;
      }
    }
  }
  return false;
}

std::vector<NaiveOpinion> NaiveOpinions(const Scene& scene, int row, int col) {
  std::vector<NaiveOpinion> opinions;
  const Vec3 ray = scene.camera.Ray(row, col);
  for (int y = row - 15; y <= row + 15; y += 4) {
    for (int x = col - 15; x <= col + 15; x += 4) {
      if (y < 0 || x < 0 || y >= kHeight || x >= kWidth ||
          IsNearTexture(scene, y, x) || !(scene.depth.At(y, x) > 0)) {
        continue;
      }
      const Vec3& n = scene.normal.At(y, x);
      const double depth =
          scene.depth.At(y, x) * Dot(n, scene.camera.Ray(y, x)) / Dot(n, ray);
      if (Dot(n, ray) < 0 && depth >= 1 && depth <= 10) {
        const Rgb& a = scene.color.At(row, col);
        const Rgb& b = scene.color.At(y, x);
        const double difference =
            std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b);
        opinions.push_back({depth, std::exp(-difference / 30), n});
      }
    }
  }
  return opinions;
}

double NaiveShare(const std::vector<NaiveOpinion>& opinions, double depth) {
  double near = 0, total = 0;
  for (const NaiveOpinion& o : opinions) {
    total += o.weight;
    near += std::abs(o.depth - depth) <= 0.01 * depth ? o.weight : 0;
  }
  return total > 4 ? near / total : 0;
}

DepthNormal NaiveMend(const Scene& scene, int row, int col) {
  const DepthNormal own = {scene.depth.At(row, col), scene.normal.At(row, col)};
  const auto opinions = NaiveOpinions(scene, row, col);
  if (!IsNearTexture(scene, row, col) || !(own.depth > 0) ||
      NaiveShare(opinions, own.depth) >= 0.5) {
    return own;
  }
  // The weighted median: the smallest depth with half of the weight up to it.
  DepthNormal median = own;
  double best = 1e9;
  for (const NaiveOpinion& o : opinions) {
    double up_to = 0, total = 0;
    for (const NaiveOpinion& other : opinions) {
      total += other.weight;
      up_to += other.depth <= o.depth ? other.weight : 0;
    }
    if (up_to >= 0.5 * total && o.depth < best) {
      best = o.depth;
      median = {static_cast<float>(o.depth), o.normal};
    }
  }
  return NaiveShare(opinions, median.depth) >= 0.5 ? median : own;
}

TEST(Silhouettes, AgreeWithNaiveReference) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(0, 1);
  Scene scene;
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; ++col) {
      scene.depth.At(row, col) *= 1 + 0.02f * uniform(random);
      scene.normal.At(row, col) =
          RandomNormal(Random(random(), 0, 0), scene.camera.Ray(row, col));
      if (uniform(random) < 0.5f) {
        scene.normal.At(row, col) = {0, 0, -1};
      }
      if (uniform(random) < 0.1f) {
        scene.depth.At(row, col) = 0;
      }
      if (uniform(random) < 0.005f) {
        scene.textureness.At(row, col) = 0.8f;
      }
      scene.color.At(row, col).g += static_cast<uint8_t>(20 * uniform(random));
    }
  }
  Scene mended = scene;
  mended.Mend();
  int num_mended = 0;
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; ++col) {
      const DepthNormal expected = NaiveMend(scene, row, col);
      ASSERT_NEAR(mended.depth.At(row, col), expected.depth, 1e-4)
          << row << " " << col;
      ASSERT_EQ(mended.normal.At(row, col).x, expected.normal.x);
      num_mended += expected.depth != scene.depth.At(row, col);
    }
  }
  EXPECT_GT(num_mended, 50);
  EXPECT_LT(num_mended, kWidth * kHeight / 2);
}

}  // namespace
}  // namespace tapa
