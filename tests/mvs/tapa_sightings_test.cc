#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "src/base/depth.h"
#include "src/mvs/tapa/sightings.h"
#include "tests/mvs/synthetic.h"

namespace tapa {
namespace {

// A plane whose true depth all source views have; they see it under 3 degrees
// and more.
class SightingsTest : public testing::Test {
 protected:
  SightingsTest() {
    SyntheticOptions options;
    options.baseline = 0.8;
    scene_ = std::make_unique<SyntheticPlane>(options);
    problem_ = scene_->GeometricProblem();
    for (View& source : problem_.sources) {
      source_depths_.push_back(*source.depth);
    }
    for (size_t m = 0; m < problem_.sources.size(); ++m) {
      problem_.sources[m].depth = &source_depths_[m];
    }
    nothing_ = Map<float>(scene_->depth().width(), scene_->depth().height());
  }

  Map<float> Find(const Map<float>& swept, const Map<float>& known) const {
    return FindSightings(options_, problem_, Control(), swept, known);
  }

  static double ShareOfDepths(const Map<float>& map) {
    size_t count = 0;
    for (size_t i = 0; i < map.size(); ++i) {
      count += IsDepth(map.data()[i]) ? 1 : 0;
    }
    return static_cast<double>(count) / map.size();
  }

  Options options_;
  std::unique_ptr<SyntheticPlane> scene_;
  Problem problem_;
  std::vector<Map<float>> source_depths_;
  Map<float> nothing_;
};

TEST_F(SightingsTest, AreTheDepthsThatSourceViewsAgreeOn) {
  const Map<float> found = Find(nothing_, nothing_);
  EXPECT_GT(ShareOfDepths(found), 0.7);
  for (size_t i = 0; i < found.size(); ++i) {
    // They lie up to half a pixel beside the centres of pixels.
    if (IsDepth(found.data()[i])) {
      EXPECT_NEAR(found.data()[i], scene_->depth().data()[i], 0.03);
    }
  }
}

TEST_F(SightingsTest, AreOnlyWhereNothingIsKnown) {
  Map<float> known = nothing_;
  for (int row = 0; row < known.height(); ++row) {
    for (int col = 0; col < known.width() / 2; ++col) {
      known.At(row, col) = 1;
    }
  }
  const Map<float> found = Find(nothing_, known);
  EXPECT_GT(ShareOfDepths(found), 0.3);
  for (size_t i = 0; i < found.size(); ++i) {
    EXPECT_FALSE(IsDepth(known.data()[i]) && IsDepth(found.data()[i]));
  }
}

TEST_F(SightingsTest, NeedOtherViewsThatAgree) {
  for (size_t m = 1; m < source_depths_.size(); ++m) {
    for (size_t i = 0; i < source_depths_[m].size(); ++i) {
      source_depths_[m].data()[i] *= 1.0f + 0.3f * m;
    }
  }
  EXPECT_EQ(ShareOfDepths(Find(nothing_, nothing_)), 0);
  // The reference view is one that can agree, but one alone does not suffice.
  EXPECT_EQ(ShareOfDepths(Find(scene_->depth(), nothing_)), 0);
  options_.filter_min_num_consistent = 1;
  EXPECT_EQ(ShareOfDepths(Find(nothing_, nothing_)), 0);
  EXPECT_GT(ShareOfDepths(Find(scene_->depth(), nothing_)), 0.3);
}

TEST_F(SightingsTest, NeedRaysAtAnAngle) {
  options_.filter_min_triangulation_angle = 90;
  EXPECT_EQ(ShareOfDepths(Find(nothing_, nothing_)), 0);
}

TEST_F(SightingsTest, OfSeveralTheNearestCounts) {
  // Two views agree on a plane that is nearer, the others on the true one.
  SyntheticOptions options;
  options.baseline = 0.8;
  options.depth = 3;
  const SyntheticPlane nearer(options);
  const Problem other = nearer.GeometricProblem();
  Problem both = problem_;
  for (size_t m = 0; m < 2; ++m) {
    both.sources[m].depth = other.sources[m].depth;
  }
  options_.filter_min_num_consistent = 1;
  Problem near_only = both;
  near_only.sources.resize(2);
  const Map<float> near =
      FindSightings(options_, near_only, Control(), nothing_, nothing_);
  const Map<float> found =
      FindSightings(options_, both, Control(), nothing_, nothing_);
  EXPECT_GT(ShareOfDepths(near), 0.3);
  for (size_t i = 0; i < found.size(); ++i) {
    if (IsDepth(near.data()[i])) {
      EXPECT_EQ(found.data()[i], near.data()[i]);
    }
  }
}

TEST_F(SightingsTest, SourceViewsMayLackDepthsAndDifferInSize) {
  source_depths_[0] =
      Map<float>(source_depths_[0].width(), source_depths_[0].height());
  SyntheticOptions options;
  options.baseline = 0.8;
  options.scaled_width = 96;
  options.scaled_height = 80;
  const SyntheticPlane larger(options);
  const Problem other = larger.GeometricProblem();
  problem_.sources[1] = other.sources[1];
  const Map<float> found = Find(nothing_, nothing_);
  EXPECT_GT(ShareOfDepths(found), 0.5);
}

TEST_F(SightingsTest, EndsWhenStopped) {
  Control control;
  control.stopped = [] { return true; };
  const Map<float> found =
      FindSightings(options_, problem_, control, nothing_, nothing_);
  EXPECT_EQ(ShareOfDepths(found), 0);
}

}  // namespace
}  // namespace tapa
