#include "src/eval/cloud_checks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace tapa {
namespace {

// Points on a circle around (5, 6, 7).
std::vector<Vec3> Circle(float radius, int count) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const float angle = 6.2831853f * static_cast<float>(i) / count;
    points.push_back(
        {5 + radius * std::cos(angle), 6 + radius * std::sin(angle), 7});
  }
  return points;
}

bool Says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(CloudChecksTest, TypicalRadius) {
  EXPECT_EQ(TypicalRadius({}), 0);
  EXPECT_EQ(TypicalRadius({{1, 2, 3}}), 0);
  EXPECT_NEAR(TypicalRadius(Circle(2, 1000)), 2, 0.02);
  // More points than are looked at, and some far away.
  std::vector<Vec3> many = Circle(2, 250001);
  for (size_t i = 0; i < many.size(); i += 10) many[i] = {1e30f, -1e30f, 0};
  EXPECT_NEAR(TypicalRadius(many), 2, 0.5);
}

TEST(CloudChecksTest, Unit) {
  const std::vector<Vec3> metres = Circle(2, 1000);
  EXPECT_EQ(CheckUnit(metres, Circle(30, 1000), "s.ply"), "");
  EXPECT_EQ(CheckUnit(metres, Circle(0.15f, 1000), "s.ply"), "");
  const std::string larger = CheckUnit(metres, Circle(2000, 1000), "s.ply");
  EXPECT_TRUE(Says(larger, "s.ply is 1e+03 times larger")) << larger;
  const std::string smaller = CheckUnit(metres, Circle(0.02f, 1000), "s.ply");
  EXPECT_TRUE(Says(smaller, "s.ply is 1e+02 times smaller")) << smaller;
  EXPECT_EQ(CheckUnit({}, metres, "s.ply"), "");
  EXPECT_EQ(CheckUnit({{1, 2, 3}}, metres, "s.ply"), "");
}

TEST(CloudChecksTest, Precision) {
  EXPECT_EQ(CheckPrecision({}, 0.01, "c.ply"), "");
  EXPECT_EQ(CheckPrecision({{0, -8000, 0}}, 0.01, "c.ply"), "");
  const std::string text = CheckPrecision({{0, -400000, 0}}, 0.01, "c.ply");
  EXPECT_TRUE(Says(text, "c.ply has coordinates of up to 4e+05")) << text;
}

TEST(CloudChecksTest, Overlap) {
  EXPECT_EQ(CheckOverlap({{2, true}, {1, true}}, 0.5, 2), "");
  const std::string text = CheckOverlap({{2, true}, {2, true}}, 0.5, 2);
  EXPECT_TRUE(Says(text, "within 0.5 m of the reconstruction")) << text;
}

TEST(CloudChecksTest, Judged) {
  EXPECT_EQ(CheckJudged({{2, false}, {1, false}}, 2), "");
  EXPECT_EQ(CheckJudged({{2, false}, {2, true}}, 2), "");
  EXPECT_TRUE(Says(CheckJudged({{2, false}}, 2), "can be judged"));
}

}  // namespace
}  // namespace tapa
