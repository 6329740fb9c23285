#include "src/fusion/packed_normal.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace tapa {
namespace {

TEST(PackedNormalTest, KeepsDirections) {
  std::mt19937 random(1);
  std::normal_distribution<float> draw;
  for (int i = 0; i < 100000; ++i) {
    const Vec3 n{draw(random), draw(random), draw(random)};
    const Vec3 unit = 1 / std::sqrt(Dot(n, n)) * n;
    const Vec3 difference = UnpackNormal(PackNormal(n)) - unit;
    EXPECT_LT(std::sqrt(Dot(difference, difference)), 7e-5);
  }
}

TEST(PackedNormalTest, MakesDirectionsOfAnything) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Vec3& n : {Vec3{0, 0, 0}, Vec3{nan, 0, 1}, Vec3{0, 0, -1}}) {
    const Vec3 unit = UnpackNormal(PackNormal(n));
    EXPECT_NEAR(Dot(unit, unit), 1, 1e-5);
  }
}

}  // namespace
}  // namespace tapa
