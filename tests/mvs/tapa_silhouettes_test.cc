#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
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

// Two surfaces that face the camera, with a silhouette between columns 39 and
// 40, in which the front one's colour ends. Its estimates go on for four
// columns.
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
    MendSilhouettes(options, problem, Control(), camera, color, textureness,
                    &depth, &normal, &origin);
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
  const int step = std::max(1, (8 * scene.options.window_radius + 5) / 10);
  for (int i = -7; i <= 7; i += 2) {
    for (int j = -7; j <= 7; j += 2) {
      const int y = row + i * step / 2;
      const int x = col + j * step / 2;
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

Scene RandomScene() {
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
  return scene;
}

TEST(Silhouettes, AgreeWithNaiveReference) {
  for (const int radius : {1, 2, 5, 8}) {
    SCOPED_TRACE(radius);
    Scene scene = RandomScene();
    scene.options.window_radius = radius;
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
    EXPECT_GT(num_mended, 20);
    EXPECT_LT(num_mended, kWidth * kHeight / 2);
  }
}

TEST(Silhouettes, AreTheSameInTheMirror) {
  const Scene scene = RandomScene();
  Scene mirrored = scene;
  mirrored.camera.offset_x = -scene.camera.Ray(0, kWidth - 1).x;
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; ++col) {
      const int from = kWidth - 1 - col;
      mirrored.color.At(row, col) = scene.color.At(row, from);
      mirrored.textureness.At(row, col) = scene.textureness.At(row, from);
      mirrored.depth.At(row, col) = scene.depth.At(row, from);
      Vec3 normal = scene.normal.At(row, from);
      normal.x = -normal.x;
      mirrored.normal.At(row, col) = normal;
    }
  }
  Scene mended = scene;
  mended.Mend();
  mirrored.Mend();
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; ++col) {
      ASSERT_NEAR(mirrored.depth.At(row, kWidth - 1 - col),
                  mended.depth.At(row, col), 1e-4)
          << row << " " << col;
    }
  }
}

TEST(Silhouettes, SurviveNonsense) {
  Scene scene;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  scene.depth.At(25, 60) = nan;
  scene.depth.At(25, 52) = std::numeric_limits<float>::infinity();
  scene.normal.At(20, 56) = {nan, nan, nan};
  scene.normal.At(20, 60) = Vec3();
  scene.Mend();
  for (int col = 40; col < 44; ++col) {
    EXPECT_EQ(scene.depth.At(25, col), kBehind);
  }
}

}  // namespace
}  // namespace tapa
