#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "src/mvs/tapa/completion.h"

namespace tapa {
namespace {

constexpr int kWidth = 60;
constexpr int kHeight = 40;

RefCamera TestCamera() {
  const float focal = 50;
  return {1 / focal, 1 / focal, -kWidth / 2 / focal, -kHeight / 2 / focal};
}

Problem TestProblem() {
  Problem problem;
  problem.depth_min = 1;
  problem.depth_max = 10;
  return problem;
}

FittedPlane FrontalPlane(float depth, float ratio) {
  FittedPlane fitted;
  fitted.plane = {{0, 0, -1}, depth};
  fitted.inlier_ratio = ratio;
  fitted.max_distance = 0.1f;
  return fitted;
}

// Two superpixels, left and right, with planes at depths 3 and 5.
Segmentation TwoHalves() {
  Segmentation segmentation;
  segmentation.superpixels.labels = Map<uint16_t>(kWidth, kHeight);
  for (int row = 0; row < kHeight; ++row) {
    for (int col = kWidth / 2; col < kWidth; ++col) {
      segmentation.superpixels.labels.At(row, col) = 1;
    }
  }
  segmentation.superpixels.neighbors.resize(2);
  segmentation.planes = {FrontalPlane(3, 0.6f), FrontalPlane(5, 0.9f)};
  return segmentation;
}

Map<float> RandomDepth() {
  std::mt19937 random(1);
  Map<float> depth(kWidth, kHeight);
  for (size_t i = 0; i < depth.size(); ++i) {
    const float values[] = {0, 3, 3.05f, 3.2f, 5, 4.95f, 7};
    depth.data()[i] = values[random() % 7];
  }
  return depth;
}

// The definition, pixel by pixel.
float NaiveAgreement(const Map<float>& depth, const Segmentation& segmentation,
                     int row, int col, int radius) {
  const Map<uint16_t>& labels = segmentation.superpixels.labels;
  const FittedPlane& fitted = segmentation.planes[labels.At(row, col)];
  double all = 0.005 * (2 * radius + 1) * (2 * radius + 1);
  double on_plane = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (labels.At(y, x) == labels.At(row, col) && depth.At(y, x) > 0) {
        const bool near =
            std::abs(y - row) <= radius && std::abs(x - col) <= radius;
        const double weight = near ? 1 : 0.2;
        // The planes are frontal: distances are differences in depth.
        all += weight;
        on_plane += std::abs(depth.At(y, x) - fitted.plane.distance) <= 0.1
                        ? weight
                        : 0;
      }
    }
  }
  return static_cast<float>(on_plane / all);
}

TEST(Completion, AgreementIsThatOfTheEstimatesNearby) {
  const Segmentation segmentation = TwoHalves();
  const Map<float> depth = RandomDepth();
  for (const int radius : {0, 1, 7, 70}) {
    const LocalPlanes planes = FindLocalPlanes(TestProblem(), TestCamera(),
                                               depth, segmentation, radius);
    for (int row = 0; row < kHeight; ++row) {
      for (int col = 0; col < kWidth; ++col) {
        ASSERT_NEAR(planes.agreement.At(row, col),
                    NaiveAgreement(depth, segmentation, row, col, radius), 1e-5)
            << row << " " << col << " " << radius;
        ASSERT_NEAR(planes.depth.At(row, col), col < kWidth / 2 ? 3 : 5, 1e-5);
        ASSERT_EQ(planes.normal.At(row, col).z, -1);
      }
    }
  }
}

TEST(Completion, ASecondPlaneInTheSuperpixelIsSeenWhereItIs) {
  // The upper half lies on the superpixel's plane, the lower one behind it.
  Segmentation segmentation = TwoHalves();
  segmentation.superpixels.labels = Map<uint16_t>(kWidth, kHeight);
  Map<float> depth(kWidth, kHeight, 3);
  for (int row = kHeight / 2; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; ++col) depth.At(row, col) = 4;
  }
  const LocalPlanes planes =
      FindLocalPlanes(TestProblem(), TestCamera(), depth, segmentation, 15);
  EXPECT_GT(planes.agreement.At(3, 30), 0.7f);
  EXPECT_LT(planes.agreement.At(kHeight - 4, 30), 0.3f);
}

TEST(Completion, PlanesOutsideTheRangeOfDepthsAreNone) {
  Segmentation segmentation = TwoHalves();
  segmentation.planes[0] = FrontalPlane(0.5f, 1);
  segmentation.planes[1] = FrontalPlane(20, 1);
  const LocalPlanes planes = FindLocalPlanes(TestProblem(), TestCamera(),
                                             RandomDepth(), segmentation, 5);
  for (size_t i = 0; i < planes.depth.size(); ++i) {
    ASSERT_EQ(planes.depth.data()[i], 0);
    ASSERT_EQ(planes.agreement.data()[i], 0);
  }
}

TEST(Completion, SuperpixelsWithoutPlaneHaveNone) {
  Segmentation segmentation = TwoHalves();
  segmentation.planes[0] = FittedPlane();
  const LocalPlanes planes =
      FindLocalPlanes(TestProblem(), TestCamera(), Map<float>(kWidth, kHeight),
                      segmentation, 5);
  EXPECT_EQ(planes.depth.At(0, 0), 0);
  // Nor is there agreement where there are no estimates nearby.
  EXPECT_GT(planes.depth.At(0, kWidth - 1), 0);
  EXPECT_EQ(planes.agreement.At(0, kWidth - 1), 0);
}

TEST(Completion, MergingKeepsThePlaneWithMoreAgreement) {
  // The left half lies on the first planes, the right one on the others.
  Map<float> depth(kWidth, kHeight, 3);
  for (int row = 0; row < kHeight; ++row) {
    for (int col = kWidth / 2; col < kWidth; ++col) depth.At(row, col) = 6;
  }
  Segmentation other = TwoHalves();
  other.planes = {FrontalPlane(4, 0.5f), FrontalPlane(6, 0.95f)};
  LocalPlanes planes =
      FindLocalPlanes(TestProblem(), TestCamera(), depth, TwoHalves(), 5);
  MergeLocalPlanes(
      FindLocalPlanes(TestProblem(), TestCamera(), depth, other, 5), &planes);
  EXPECT_NEAR(planes.depth.At(5, 5), 3, 1e-5);
  EXPECT_NEAR(planes.depth.At(5, kWidth - 5), 6, 1e-5);
  EXPECT_GT(planes.agreement.At(5, kWidth - 5), 0.9f);
}

TEST(Completion, ReplacesMissingEstimatesAndThoseOfLittleTexture) {
  TapaOptions options;
  options.completion_agreement = 0.5;
  options.completion_textureness = 0.75;
  LocalPlanes planes;
  planes.depth = Map<float>(6, 1, 2);
  planes.normal = Map<Vec3>(6, 1, Vec3{0, 0, -1});
  planes.agreement = Map<float>(6, 1, 0.5f);
  planes.agreement.At(0, 4) = 0.49f;
  planes.depth.At(0, 5) = 0;
  Map<float> textureness(6, 1, 0.9f);
  textureness.At(0, 2) = 0.7f;
  // Missing, textured, flat, missing, missing without agreement, without plane.
  Map<float> trusted(6, 1);
  Map<float> depth(6, 1);
  depth.At(0, 1) = depth.At(0, 2) = 9;
  Map<Vec3> normal(6, 1);
  Map<uint8_t> origin(6, 1, kNoEstimate);
  CompleteWithPlanes(options, planes, textureness, trusted, &depth, &normal,
                     &origin);
  const float expected[] = {2, 9, 2, 2, 0, 0};
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(depth.At(0, i), expected[i]) << i;
    EXPECT_EQ(origin.At(0, i), expected[i] == 2 ? kFromPlane : kNoEstimate);
    EXPECT_EQ(normal.At(0, i).z, expected[i] == 2 ? -1 : 0);
  }
  depth.At(0, 2) = trusted.At(0, 2) = 9;
  CompleteWithPlanes(options, planes, textureness, trusted, &depth, &normal,
                     &origin);
  EXPECT_EQ(depth.At(0, 2), 9);
}

TEST(Completion, RemovesEstimatesThatTooFewViewsSupport) {
  // Eleven sources: two bytes for every pixel.
  const std::vector<uint8_t> consistent = {0, 0, 1, 0, 1, 4, 0, 6};
  const float expected[4][4] = {
      {5, 5, 5, 5}, {0, 5, 5, 5}, {0, 0, 5, 5}, {0, 0, 0, 0}};
  for (int min_num_consistent = 0; min_num_consistent < 4;
       ++min_num_consistent) {
    Map<float> depth(4, 1, 5);
    RemoveInconsistent(consistent, 11, min_num_consistent, &depth);
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(depth.At(0, i), expected[min_num_consistent][i]);
    }
  }
}

}  // namespace
}  // namespace tapa
