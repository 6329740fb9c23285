#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "src/mvs/tapa/anchor_votes.h"
#include "src/mvs/tapa/triangle_planes.h"

namespace tapa {
namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 120;

RefCamera TestCamera() {
  const float focal = 130;
  return {1 / focal, 1 / focal, -kWidth / 2 / focal, -kHeight / 2 / focal};
}

constexpr Plane kSlanted = {{0.28f, 0, -0.96f}, 3};

Map<float> DepthOf(const Plane& plane) {
  Map<float> depth(kWidth, kHeight);
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; ++col) {
      depth.At(row, col) = PlaneAt(plane, TestCamera().Ray(row, col)).depth;
    }
  }
  return depth;
}

std::vector<Anchor> RandomAnchors(int count) {
  std::mt19937 random(1);
  std::vector<Anchor> anchors;
  for (int i = 0; i < count; ++i) {
    anchors.push_back({static_cast<int>(random() % kHeight),
                       static_cast<int>(random() % kWidth)});
  }
  return anchors;
}

double Side(const Anchor& a, const Anchor& b, int row, int col) {
  return static_cast<double>(b.col - a.col) * (row - a.row) -
         static_cast<double>(b.row - a.row) * (col - a.col);
}

// Whether some triangle of anchors covers a pixel: whether it lies within their
// convex hull.
bool IsCovered(const std::vector<Anchor>& anchors, int row, int col) {
  for (const Anchor& a : anchors) {
    for (const Anchor& b : anchors) {
      // A line with all anchors on one side, and the pixel on the other.
      const bool is_edge =
          Side(a, b, row, col) > 0 &&
          std::all_of(anchors.begin(), anchors.end(), [&](const Anchor& c) {
            return Side(a, b, c.row, c.col) <= 0;
          });
      if (is_edge && !(a.row == b.row && a.col == b.col)) {
        return false;
      }
    }
  }
  return true;
}

TEST(TriangulateAnchors, CoversTheHullWithPlanesThroughTheAnchors) {
  const Map<float> depth = DepthOf(kSlanted);
  const std::vector<Anchor> anchors = RandomAnchors(40);
  const TrianglePlanes triangles =
      TriangulateAnchors(TestCamera(), depth, anchors);
  EXPECT_GT(triangles.planes.size(), 40u);
  int num_covered = 0;
  int num_different = 0;
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; ++col) {
      const DepthNormal found = triangles.At(TestCamera(), row, col);
      const bool is_covered = IsCovered(anchors, row, col);
      num_covered += is_covered;
      // Sides are drawn on whole pixels.
      num_different += is_covered != (found.depth > 0);
      if (found.depth > 0) {
        EXPECT_NEAR(found.depth, depth.At(row, col), 1e-3);
        EXPECT_GT(Dot(found.normal, kSlanted.normal), 0.9999f);
      }
    }
  }
  EXPECT_GT(num_covered, kWidth * kHeight / 2);
  EXPECT_LT(num_different, kWidth + kHeight);
}

// Neighbours of a tent's ridge are on either side of it.
TEST(TriangulateAnchors, KeepsACreaseBetweenAnchors) {
  Map<float> depth(kWidth, kHeight);
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; ++col) {
      depth.At(row, col) = 4 - 0.01f * std::abs(col - 80);
    }
  }
  const TrianglePlanes triangles = TriangulateAnchors(
      TestCamera(), depth,
      {{10, 10}, {110, 10}, {10, 80}, {110, 80}, {10, 150}, {110, 150}});
  EXPECT_EQ(triangles.planes.size(), 4u);
  EXPECT_GT(triangles.At(TestCamera(), 60, 30).normal.x, 0.1f);
  EXPECT_LT(triangles.At(TestCamera(), 60, 130).normal.x, -0.1f);
  EXPECT_EQ(triangles.At(TestCamera(), 60, 5).depth, 0);
}

TEST(TriangulateAnchors, HasNoPlaneWhereThereIsNone) {
  const Map<float> depth = DepthOf(kSlanted);
  for (const auto& anchors :
       std::vector<std::vector<Anchor>>{{},
                                        {{10, 10}},
                                        {{10, 10}, {50, 50}},
                                        {{10, 10}, {20, 20}, {30, 30}},
                                        {{10, 10}, {10, 10}, {10, 10}}}) {
    EXPECT_TRUE(
        TriangulateAnchors(TestCamera(), depth, anchors).planes.empty());
  }
  // Seen edge-on: all on one ray's plane.
  Map<float> edge_on(kWidth, kHeight, 3);
  edge_on.At(60, 20) = 1;
  edge_on.At(60, 140) = 9;
  edge_on.At(61, 80) = 3;
  EXPECT_TRUE(
      TriangulateAnchors(TestCamera(), edge_on, {{60, 20}, {60, 140}, {61, 80}})
          .planes.empty());
}

// Corners and anchors that share a triangle with one, by looking at all.
std::set<int> NaiveAround(const TrianglePlanes& triangles, size_t triangle) {
  std::set<int> around;
  for (const int corner : triangles.corners[triangle]) {
    for (const std::array<int, 3>& other : triangles.corners) {
      if (std::count(other.begin(), other.end(), corner) > 0) {
        around.insert(other.begin(), other.end());
      }
    }
  }
  return around;
}

TEST(AnchorVotes, AreThoseOfAnchorsAround) {
  // A slanted plane and, to the right, another one.
  Map<float> depth = DepthOf(kSlanted);
  const Plane other = {{0, 0.28f, -0.96f}, 4};
  const Map<float> right = DepthOf(other);
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 90; col < kWidth; ++col) {
      depth.At(row, col) = right.At(row, col);
    }
  }
  const TrianglePlanes triangles =
      TriangulateAnchors(TestCamera(), depth, RandomAnchors(60));
  ASSERT_EQ(triangles.corners.size(), triangles.planes.size());
  const AnchorVotes votes(triangles, 0.02);
  int most = 0;
  for (size_t i = 0; i < triangles.corners.size(); ++i) {
    const std::set<int> around = NaiveAround(triangles, i);
    for (const Plane& plane : {kSlanted, other, triangles.planes[i]}) {
      int expected = 0;
      for (const int anchor : around) {
        const Vec3 p = triangles.anchors[anchor];
        const double along = static_cast<double>(plane.normal.x) * p.x +
                             static_cast<double>(plane.normal.y) * p.y +
                             static_cast<double>(plane.normal.z) * p.z;
        expected += std::abs(-plane.distance / along - 1) <= 0.02;
      }
      EXPECT_EQ(votes.Count(static_cast<int>(i), plane), expected);
      most = std::max(most, expected);
    }
    EXPECT_GE(votes.Count(static_cast<int>(i), triangles.planes[i]), 3);
    EXPECT_EQ(votes.Count(static_cast<int>(i), Plane()), 0);
  }
  EXPECT_GT(most, 8);
}

TEST(FindAnchors, TakesTheMostTexturedOfASquare) {
  const Map<float> depth = DepthOf(kSlanted);
  Map<float> texture(kWidth, kHeight, 0.3f);
  EXPECT_TRUE(FindAnchors(TapaOptions(), depth, texture, 0.7).empty());
  // Squares have 4 pixels a side, from the second row and column on.
  texture.At(41, 41) = 0.7f;
  texture.At(42, 43) = 0.9f;
  texture.At(101, 9) = 0.8f;
  texture.At(0, 50) = 1;
  const std::vector<Anchor> anchors =
      FindAnchors(TapaOptions(), depth, texture, 0.7);
  ASSERT_EQ(anchors.size(), 2u);
  EXPECT_EQ(anchors[0].row, 42);
  EXPECT_EQ(anchors[0].col, 43);
  EXPECT_EQ(anchors[1].row, 101);
  EXPECT_EQ(anchors[1].col, 9);
}

TEST(FindAnchors, TakesNoneOffTheSurface) {
  Map<float> depth = DepthOf(kSlanted);
  Map<float> texture(kWidth, kHeight, 0.3f);
  texture.At(42, 42) = texture.At(62, 62) = texture.At(82, 82) = 0.9f;
  depth.At(42, 42) *= 1.02f;
  depth.At(62, 62) = 0;
  // Two beside it may differ.
  depth.At(82, 83) = depth.At(83, 83) = 0;
  const std::vector<Anchor> anchors =
      FindAnchors(TapaOptions(), depth, texture, 0.7);
  ASSERT_EQ(anchors.size(), 1u);
  EXPECT_EQ(anchors[0].row, 82);
}

}  // namespace
}  // namespace tapa
