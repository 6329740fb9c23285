// How the CUDA backend packs what it keeps in a device's memory.

#include "src/mvs/sweep/packed_depth_normal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "src/mvs/cuda/sweep_task.h"

namespace tapa {
namespace {

TEST(PackedDepthNormal, KeepsNormals) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  double worst = 0;
  for (int i = 0; i < 100000; ++i) {
    Vec3 n = {normal(random), normal(random), normal(random)};
    // Axes and planes between them, too.
    for (float* c : {&n.x, &n.y, &n.z}) {
      *c = random() % 8 == 0 ? 0.0f : *c;
    }
    const float length = std::sqrt(Dot(n, n));
    if (length == 0) {
      continue;
    }
    n = (1 / length) * n;
    const DepthNormal back = Unpack(Pack({2.5f, n}));
    EXPECT_EQ(back.depth, 2.5f);
    EXPECT_NEAR(Dot(back.normal, back.normal), 1, 1e-6);
    const Vec3 difference = back.normal - n;
    worst = std::max<double>(worst, std::sqrt(Dot(difference, difference)));
    // What was packed before comes back as the same code.
    EXPECT_EQ(PackNormal(back.normal), PackNormal(n));
  }
  EXPECT_LT(worst, 7e-5);
  EXPECT_EQ(Dot(UnpackNormal(kNoNormal), UnpackNormal(kNoNormal)), 0);
}

TEST(Textureness, KeepsOneHalfExactly) {
  EXPECT_EQ(DecodeTextureness(EncodeTextureness(0.5f)), 0.5f);
  EXPECT_EQ(DecodeTextureness(EncodeTextureness(1.0f)), 1.0f);
  for (float t = 0; t <= 1; t += 0.0123f) {
    EXPECT_NEAR(DecodeTextureness(EncodeTextureness(t)), t, 8e-6);
  }
}

}  // namespace
}  // namespace tapa
