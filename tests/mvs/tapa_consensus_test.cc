#include <gtest/gtest.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "src/base/depth.h"
#include "src/mvs/tapa/consensus.h"
#include "tests/mvs/synthetic.h"

namespace tapa {
namespace {

struct Point {
  double x, y, z;
};

// From the frame of one camera to that of another, in double precision.
Point Transform(const Camera& from, const Camera& to, const Point& p) {
  const double d[3] = {p.x - from.t[0], p.y - from.t[1], p.z - from.t[2]};
  double world[3], result[3];
  for (int i = 0; i < 3; ++i) {
    world[i] = from.R[i] * d[0] + from.R[3 + i] * d[1] + from.R[6 + i] * d[2];
  }
  for (int i = 0; i < 3; ++i) {
    result[i] = to.R[3 * i] * world[0] + to.R[3 * i + 1] * world[1] +
                to.R[3 * i + 2] * world[2] + to.t[i];
  }
  return {result[0], result[1], result[2]};
}

Point PointAt(const Camera& camera, int row, int col, double depth) {
  return {depth * (col + 0.5 - camera.cx) / camera.fx,
          depth * (row + 0.5 - camera.cy) / camera.fy, depth};
}

// The pixel that sees a point; false: none of the image's.
bool Sees(const Camera& camera, const Point& p, int width, int height, int* row,
          int* col) {
  const double x = p.x / p.z * camera.fx + camera.cx;
  const double y = p.y / p.z * camera.fy + camera.cy;
  *row = static_cast<int>(std::floor(y));
  *col = static_cast<int>(std::floor(x));
  return p.z > 0 && x >= 0 && y >= 0 && x < width && y < height;
}

// The rule as consensus.h states it, pixel by pixel and view by view.
class NaiveConsensus {
 public:
  NaiveConsensus(const Problem& problem, const Map<float>& depth)
      : problem_(problem), depth_(depth) {}

  float Decide(int row, int col) const {
    const float own = depth_.At(row, col);
    const int lead = Lead(row, col, own);
    if (IsDepth(own) && lead >= 0) {
      return own;
    }
    int best_lead = 2;
    double best = 0;
    for (const View& view : problem_.sources) {
      const double seen = Candidate(view, row, col);
      if (seen > 0 && Lead(row, col, seen) > best_lead) {
        best_lead = Lead(row, col, seen);
        best = seen;
      }
    }
    return static_cast<float>(best);
  }

 private:
  // At a pixel, otherwise beside it.
  double Candidate(const View& view, int row, int col) const {
    double nearest = Nearest(view, row, col);
    if (nearest > 0) {
      return nearest;
    }
    for (int r = row - 1; r <= row + 1; ++r) {
      for (int c = col - 1; c <= col + 1; ++c) {
        const double z = Nearest(view, r, c);
        if (z > 0 && (nearest == 0 || z < nearest)) {
          nearest = z;
        }
      }
    }
    return nearest;
  }

  double Nearest(const View& view, int row, int col) const {
    double nearest = 0;
    for (int r = 0; r < view.depth->height(); ++r) {
      for (int c = 0; c < view.depth->width(); ++c) {
        const float z = view.depth->At(r, c);
        if (!IsDepth(z)) {
          continue;
        }
        const Point p = Transform(view.camera, problem_.reference.camera,
                                  PointAt(view.camera, r, c, z));
        int at_row, at_col;
        if (Sees(problem_.reference.camera, p, depth_.width(), depth_.height(),
                 &at_row, &at_col) &&
            at_row == row && at_col == col && (nearest == 0 || p.z < nearest)) {
          nearest = p.z;
        }
      }
    }
    return nearest;
  }

  int Lead(int row, int col, double depth) const {
    int lead = 0;
    for (const View& view : problem_.sources) {
      const Point p =
          Transform(problem_.reference.camera, view.camera,
                    PointAt(problem_.reference.camera, row, col, depth));
      int at_row, at_col;
      if (Sees(view.camera, p, view.depth->width(), view.depth->height(),
               &at_row, &at_col)) {
        const float z = view.depth->At(at_row, at_col);
        lead += IsDepth(z) && std::abs(z / p.z - 1) <= 0.01;
        lead -= IsDepth(z) && z / p.z - 1 > 0.02;
      }
    }
    return lead;
  }

  const Problem& problem_;
  const Map<float>& depth_;
};

// A slanted plane whose true depth all views have.
class ConsensusTest : public testing::Test {
 protected:
  ConsensusTest() : ConsensusTest(SyntheticOptions()) {}
  explicit ConsensusTest(const SyntheticOptions& options)
      : scene_(std::make_unique<SyntheticPlane>(options)),
        problem_(scene_->GeometricProblem()),
        depth_(scene_->depth()),
        normal_(depth_.width(), depth_.height(), scene_->normal()) {
    for (View& source : problem_.sources) {
      sources_.push_back(*source.depth);
    }
    for (size_t m = 0; m < sources_.size(); ++m) {
      problem_.sources[m].depth = &sources_[m];
    }
  }

  bool Run(const Control& control = Control()) {
    return ReachConsensus(options_, problem_, control, &depth_, &normal_);
  }

  const Map<float>& truth() const { return scene_->depth(); }

  Options options_;
  std::unique_ptr<SyntheticPlane> scene_;
  Problem problem_;
  std::vector<Map<float>> sources_;
  Map<float> depth_;
  Map<Vec3> normal_;
};

// In the middle, which all source views see.
constexpr int kRow = 20;
constexpr int kCol = 24;

TEST_F(ConsensusTest, WhatViewsAgreeOnStays) {
  ASSERT_TRUE(Run());
  for (size_t i = 0; i < depth_.size(); ++i) {
    EXPECT_EQ(depth_.data()[i], truth().data()[i]);
    EXPECT_EQ(normal_.data()[i].x, scene_->normal().x);
  }
}

TEST_F(ConsensusTest, WhatViewsSeeThroughGivesWayToWhatTheySee) {
  // In front of the surface, and nothing at all.
  for (int i = 0; i < 6; ++i) {
    depth_.At(kRow + i / 3, kCol + i % 3) *= i < 3 ? 0.8f : 0;
    normal_.At(kRow + i / 3, kCol + i % 3) = {0, 0, -1};
  }
  ASSERT_TRUE(Run());
  for (int i = 0; i < 6; ++i) {
    const int row = kRow + i / 3;
    const int col = kCol + i % 3;
    // The plane itself, not a point of it that is half a pixel away.
    EXPECT_NEAR(depth_.At(row, col) / truth().At(row, col), 1, 1e-5);
    EXPECT_GT(Dot(normal_.At(row, col), scene_->normal()), 0.9999f);
  }
}

// It is this view that sees through what the others see.
TEST_F(ConsensusTest, WhatLiesBehindWhatOthersSeeStays) {
  depth_.At(kRow, kCol) *= 1.3f;
  ASSERT_TRUE(Run());
  EXPECT_EQ(depth_.At(kRow, kCol), 1.3f * truth().At(kRow, kCol));
}

TEST_F(ConsensusTest, TwoViewsAreTooFewToTakeAPixelButNotToClearIt) {
  problem_.sources.resize(2);
  depth_.At(kRow, kCol) *= 0.8f;
  depth_.At(kRow, kCol + 1) = 0;
  ASSERT_TRUE(Run());
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(depth_.At(kRow, kCol + i), 0);
    EXPECT_EQ(normal_.At(kRow, kCol + i).z, 0);
  }
  EXPECT_EQ(depth_.At(kRow, kCol + 2), truth().At(kRow, kCol + 2));
}

TEST_F(ConsensusTest, WhatNobodyKnowsBetterStays) {
  // One view for it, one that sees through it; the others see nothing.
  problem_.sources.resize(2);
  for (size_t i = 0; i < sources_[1].size(); ++i) {
    sources_[1].data()[i] *= 1.3f;
  }
  ASSERT_TRUE(Run());
  EXPECT_EQ(depth_.At(kRow, kCol), truth().At(kRow, kCol));
  problem_.sources.erase(problem_.sources.begin());
  ASSERT_TRUE(Run());
  EXPECT_EQ(depth_.At(kRow, kCol), 0);
}

TEST_F(ConsensusTest, SmallErrorsAreNoReasons) {
  // Between one and two tolerances: neither for it nor against it.
  depth_.At(kRow, kCol) *= 0.985f;
  problem_.sources.resize(2);
  ASSERT_TRUE(Run());
  EXPECT_EQ(depth_.At(kRow, kCol), 0.985f * truth().At(kRow, kCol));
  // By the option.
  options_.tapa.relative_plane_distance = 0.005;
  ASSERT_TRUE(Run());
  EXPECT_EQ(depth_.At(kRow, kCol), 0);
}

TEST_F(ConsensusTest, ViewsWithoutAMapHaveNoVotes) {
  depth_.At(kRow, kCol) *= 0.8f;
  const float wrong = depth_.At(kRow, kCol);
  for (View& source : problem_.sources) {
    source.depth = nullptr;
  }
  ASSERT_TRUE(Run());
  EXPECT_EQ(depth_.At(kRow, kCol), wrong);
  problem_.sources.clear();
  ASSERT_TRUE(Run());
  EXPECT_EQ(depth_.At(kRow, kCol), wrong);
}

TEST_F(ConsensusTest, MaskedPixelsGetNothing) {
  problem_.mask = Map<uint8_t>(depth_.width(), depth_.height());
  problem_.mask.At(kRow, kCol) = 255;
  depth_.At(kRow, kCol) = 0;
  depth_.At(kRow, kCol + 1) = 0;
  ASSERT_TRUE(Run());
  EXPECT_EQ(depth_.At(kRow, kCol), 0);
  EXPECT_GT(depth_.At(kRow, kCol + 1), 0);
}

TEST_F(ConsensusTest, WhatIsNoDepthIsNone) {
  for (const float none : {NAN, INFINITY, -1.0f, 0.0f}) {
    // A source view that sees nothing neither speaks for an estimate nor sees
    // through it.
    sources_[0] = Map<float>(depth_.width(), depth_.height(), none);
    problem_.sources.resize(1);
    depth_ = truth();
    depth_.At(kRow, kCol) *= 0.8f;
    depth_.At(kRow, kCol + 1) = none;
    const float wrong = depth_.At(kRow, kCol);
    ASSERT_TRUE(Run());
    EXPECT_EQ(depth_.At(kRow, kCol), wrong);
    EXPECT_EQ(depth_.At(kRow, kCol + 1), 0);
  }
}

// Their points lie two pixels apart in the reference view.
TEST_F(ConsensusTest, ViewsThatSeeLessTakePixelsWithoutHoles) {
  SyntheticOptions options;
  options.width = 20;
  options.height = 16;
  options.focal_length = 24;
  const SyntheticPlane coarse(options);
  problem_.sources = coarse.GeometricProblem().sources;
  for (int row = 16; row < 24; ++row) {
    for (int col = 20; col < 28; ++col) {
      depth_.At(row, col) *= 0.8f;
    }
  }
  ASSERT_TRUE(Run());
  for (int row = 16; row < 24; ++row) {
    for (int col = 20; col < 28; ++col) {
      EXPECT_NEAR(depth_.At(row, col) / truth().At(row, col), 1, 1e-4);
    }
  }
}

TEST_F(ConsensusTest, EndsWhenStopped) {
  // At whatever step.
  int num_asked = 0;
  int last = INT_MAX;
  Control control;
  control.stopped = [&num_asked, &last] { return ++num_asked > last; };
  ASSERT_TRUE(Run(control));
  const int num_all = num_asked;
  ASSERT_GT(num_all, 100);
  for (last = 0; last < num_all; last += 1 + num_all / 20) {
    num_asked = 0;
    EXPECT_FALSE(Run(control)) << last << " of " << num_all;
    EXPECT_LT(num_asked, last + 20);
  }
}

TEST_F(ConsensusTest, TellsHowFarItIs) {
  std::vector<double> shares;
  Control control;
  control.progress = [&shares](double share) { shares.push_back(share); };
  ASSERT_TRUE(Run(control));
  ASSERT_FALSE(shares.empty());
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1);
}

// Views with boxes at other depths, holes and noise, and of other sizes.
class MixedConsensusTest : public ConsensusTest {
 protected:
  static SyntheticOptions Small() {
    SyntheticOptions options;
    options.width = 24;
    options.height = 20;
    options.focal_length = 30;
    options.num_sources = 5;
    return options;
  }

  MixedConsensusTest() : ConsensusTest(Small()) {
    SyntheticOptions large = Small();
    large.scaled_width = 36;
    large.scaled_height = 30;
    larger_ = std::make_unique<SyntheticPlane>(large);
    const Problem other = larger_->GeometricProblem();
    sources_[1] = *other.sources[1].depth;
    problem_.sources[1].camera = other.sources[1].camera;
    std::mt19937 random(7);
    Disturb(&depth_, &random);
    for (Map<float>& source : sources_) {
      Disturb(&source, &random);
    }
  }

  static void Disturb(Map<float>* depth, std::mt19937* random) {
    std::uniform_real_distribution<float> factor(0.7f, 1.3f);
    std::uniform_real_distribution<float> noise(0.992f, 1.008f);
    for (int box = 0; box < 6; ++box) {
      const int row = (*random)() % depth->height();
      const int col = (*random)() % depth->width();
      const float scale = box == 0 ? 0 : factor(*random);
      for (int r = row; r < std::min(row + 8, depth->height()); ++r) {
        for (int c = col; c < std::min(col + 8, depth->width()); ++c) {
          depth->At(r, c) *= scale;
        }
      }
    }
    for (size_t i = 0; i < depth->size(); ++i) {
      depth->data()[i] *= noise(*random);
    }
  }

  std::unique_ptr<SyntheticPlane> larger_;
};

TEST_F(MixedConsensusTest, IsWhatTheNaiveReferenceSays) {
  const Map<float> before = depth_;
  const NaiveConsensus naive(problem_, before);
  ASSERT_TRUE(Run());
  int num_kept = 0, num_taken = 0, num_gone = 0;
  for (int row = 0; row < depth_.height(); ++row) {
    for (int col = 0; col < depth_.width(); ++col) {
      const float expected = naive.Decide(row, col);
      const float own = before.At(row, col);
      // What is taken is smoothed by up to a tolerance.
      const float tolerance = expected == own ? 0 : 0.0101f * expected;
      EXPECT_NEAR(depth_.At(row, col), expected, tolerance)
          << row << " " << col << " " << own;
      num_kept += expected == own;
      num_gone += expected == 0 && own > 0;
      num_taken += expected > 0 && expected != own;
    }
  }
  EXPECT_GT(num_kept, 100);
  EXPECT_GT(num_taken, 50);
  EXPECT_GT(num_gone, 5);
}

TEST_F(MixedConsensusTest, IsTheSameForAnyNumberOfThreads) {
  const Map<float> depth = depth_;
  const Map<Vec3> normal = normal_;
  options_.num_threads = 1;
  ASSERT_TRUE(Run());
  Map<float> other_depth = depth;
  Map<Vec3> other_normal = normal;
  options_.num_threads = 3;
  ASSERT_TRUE(ReachConsensus(options_, problem_, Control(), &other_depth,
                             &other_normal));
  for (size_t i = 0; i < depth_.size(); ++i) {
    EXPECT_EQ(depth_.data()[i], other_depth.data()[i]);
    EXPECT_EQ(normal_.data()[i].x, other_normal.data()[i].x);
  }
}

}  // namespace
}  // namespace tapa
