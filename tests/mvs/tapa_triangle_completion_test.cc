#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "src/mvs/tapa/completion.h"
#include "src/mvs/tapa/textureness.h"
#include "src/mvs/tapa/triangle_completion.h"
#include "src/mvs/tapa/view_votes.h"
#include "tests/mvs/synthetic.h"

namespace tapa {
namespace {

// A plane with a stripe without texture; all source views know its true depth.
class TriangleCompletionTest : public testing::Test {
 protected:
  TriangleCompletionTest() {
    SyntheticOptions options;
    options.width = 120;
    options.height = 100;
    options.focal_length = 150;
    options.wall = 0.6;
    scene_ = std::make_unique<SyntheticPlane>(options);
    problem_ = scene_->GeometricProblem();
    problem_.depth_min = 1;
    problem_.depth_max = 20;
    for (View& source : problem_.sources) {
      source_depths_.push_back(*source.depth);
    }
    for (size_t m = 0; m < problem_.sources.size(); ++m) {
      problem_.sources[m].depth = &source_depths_[m];
    }
    textureness_ = ComputeTextureness(*problem_.reference.image,
                                      TexturenessOf(options_.tapa));
    // Wrong on the stripe.
    estimate_ = scene_->depth();
    for (size_t i = 0; i < estimate_.size(); ++i) {
      if (scene_->wall().data()[i] != 0) {
        estimate_.data()[i] *= 1.1f;
      }
    }
    trusted_ = scene_->depth();
    normal_ = Map<Vec3>(estimate_.width(), estimate_.height());
    origin_ = Map<uint8_t>(estimate_.width(), estimate_.height(), kSwept);
  }

  void Complete() {
    CompleteWithTriangles(options_, problem_, Control(), textureness_, trusted_,
                          &estimate_, &normal_, &origin_);
  }

  void BlindViews() {
    for (Map<float>& depth : source_depths_) {
      depth = Map<float>(depth.width(), depth.height());
    }
  }

  // Of the true plane, but further away by a factor, in every step-th row and
  // column.
  void GiveEstimates(float factor, int step) {
    for (int row = 0; row < estimate_.height(); row += step) {
      for (int col = 0; col < estimate_.width(); col += step) {
        estimate_.At(row, col) = factor * scene_->depth().At(row, col);
        normal_.At(row, col) = scene_->normal();
      }
    }
  }

  // Share of the stripe where the estimate is right now.
  double ShareRight() const {
    int num_all = 0;
    int num_right = 0;
    for (size_t i = 0; i < estimate_.size(); ++i) {
      if (scene_->wall().data()[i] != 0) {
        ++num_all;
        num_right += std::abs(estimate_.data()[i] / scene_->depth().data()[i] -
                              1) < 0.003;
      }
    }
    return static_cast<double>(num_right) / num_all;
  }

  Options options_;
  std::unique_ptr<SyntheticPlane> scene_;
  Problem problem_;
  std::vector<Map<float>> source_depths_;
  Map<float> textureness_;
  Map<float> estimate_;
  Map<float> trusted_;
  Map<Vec3> normal_;
  Map<uint8_t> origin_;
};

TEST_F(TriangleCompletionTest, BridgesWhatHasNoTexture) {
  EXPECT_EQ(ShareRight(), 0);
  Complete();
  EXPECT_GT(ShareRight(), 0.8);
  int num_from_planes = 0;
  for (size_t i = 0; i < estimate_.size(); ++i) {
    if (origin_.data()[i] == kFromPlane) {
      ++num_from_planes;
      EXPECT_LT(textureness_.data()[i], 0.5f);
      EXPECT_GT(Dot(normal_.data()[i], scene_->normal()), 0.99f);
    }
  }
  EXPECT_GT(num_from_planes, 100);
}

TEST_F(TriangleCompletionTest, FillsHolesToo) {
  for (size_t i = 0; i < estimate_.size(); ++i) {
    if (scene_->wall().data()[i] != 0) {
      estimate_.data()[i] = 0;
    }
  }
  Complete();
  EXPECT_GT(ShareRight(), 0.8);
}

TEST_F(TriangleCompletionTest, LeavesWhatIsMasked) {
  problem_.mask = Map<uint8_t>(estimate_.width(), estimate_.height(), 1);
  Complete();
  EXPECT_EQ(ShareRight(), 0);
}

// No view says anything, and the estimates, off by less than anchors are asked
// for, go through what lies around them.
TEST_F(TriangleCompletionTest, LeavesWhatAnchorsSpeakForToo) {
  BlindViews();
  GiveEstimates(1.015f, 1);
  Complete();
  EXPECT_EQ(ShareRight(), 0);
}

TEST_F(TriangleCompletionTest, ReplacesWhatAnchorsSpeakAgainst) {
  BlindViews();
  GiveEstimates(1.03f, 1);
  Complete();
  EXPECT_GT(ShareRight(), 0.8);
}

// One in nine estimates goes through what lies around it, as above, but those
// beside it do not.
TEST_F(TriangleCompletionTest, PixelsAroundHaveTheirSay) {
  BlindViews();
  GiveEstimates(1.03f, 1);
  GiveEstimates(1.015f, 3);
  Complete();
  EXPECT_GT(ShareRight(), 0.8);
}

// The source views see through the triangles; all of them look at the middle.
TEST_F(TriangleCompletionTest, LeavesWhatViewsSeeThrough) {
  for (Map<float>& depth : source_depths_) {
    for (size_t i = 0; i < depth.size(); ++i) {
      depth.data()[i] *= 1.1f;
    }
  }
  const Map<float> before = estimate_;
  Complete();
  for (int row = 30; row < 70; ++row) {
    for (int col = 35; col < 85; ++col) {
      EXPECT_EQ(estimate_.At(row, col), before.At(row, col));
    }
  }
}

// What a camera says of a point, in double precision; depth 0: nothing.
int NaiveVote(const Camera& from, const View& view, int row, int col,
              double depth) {
  const std::array<double, 3> p = {depth * (col + 0.5 - from.cx) / from.fx,
                                   depth * (row + 0.5 - from.cy) / from.fy,
                                   depth};
  std::array<double, 3> world = {0, 0, 0};
  std::array<double, 3> q = {0, 0, 0};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      world[i] += from.R[3 * j + i] * (p[j] - from.t[j]);
    }
  }
  for (int i = 0; i < 3; ++i) {
    q[i] = view.camera.t[i];
    for (int j = 0; j < 3; ++j) {
      q[i] += view.camera.R[3 * i + j] * world[j];
    }
  }
  const double x = view.camera.fx * q[0] / q[2] + view.camera.cx;
  const double y = view.camera.fy * q[1] / q[2] + view.camera.cy;
  if (x < 0 || y < 0 || x >= view.depth->width() || y >= view.depth->height()) {
    return 0;
  }
  const double seen = view.depth->At(static_cast<int>(y), static_cast<int>(x));
  return std::abs(seen / q[2] - 1) <= 0.01 ? 1 : 0;
}

TEST_F(TriangleCompletionTest, VotesAreThoseOfTheViewsThatSeeThePoint) {
  // None for a point that stands behind what all views see.
  Map<float> behind = scene_->depth();
  for (size_t i = 0; i < behind.size(); ++i) {
    behind.data()[i] *= 1.2f;
  }
  const Map<int16_t> votes =
      CountVotes(options_, problem_, Control(), scene_->depth(), behind);
  int num_different = 0;
  int most = 0;
  for (int row = 0; row < behind.height(); ++row) {
    for (int col = 0; col < behind.width(); ++col) {
      int expected = 0;
      for (const View& view : problem_.sources) {
        expected += NaiveVote(problem_.reference.camera, view, row, col,
                              scene_->depth().At(row, col));
      }
      most = std::max(most, expected);
      num_different += votes.At(row, col) != expected;
    }
  }
  EXPECT_EQ(most, 4);
  // Rounding decides at borders of pixels.
  EXPECT_LT(num_different, 0.01 * behind.size());
}

TEST_F(TriangleCompletionTest, AViewThatSeesThroughCountsTwice) {
  Map<float> before = scene_->depth();
  for (size_t i = 0; i < before.size(); ++i) {
    before.data()[i] *= 0.8f;
  }
  const Map<float> nothing(before.width(), before.height());
  const Map<int16_t> against =
      CountVotes(options_, problem_, Control(), before, nothing);
  const Map<int16_t> both =
      CountVotes(options_, problem_, Control(), scene_->depth(), before);
  const int row = before.height() / 2;
  const int col = before.width() / 2;
  EXPECT_EQ(against.At(row, col), -8);
  EXPECT_EQ(both.At(row, col), 12);
  EXPECT_EQ(
      CountVotes(options_, problem_, Control(), nothing, before).At(row, col),
      0);
}

}  // namespace
}  // namespace tapa
