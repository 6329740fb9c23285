#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "src/mvs/camera_table.h"
#include "src/mvs/tapa/surface_anchors.h"
#include "src/mvs/tapa/textureness.h"
#include "tests/mvs/synthetic.h"

namespace tapa {
namespace {

// A textured plane whose true depth all views have.
class SurfaceAnchorsTest : public testing::Test {
 protected:
  SurfaceAnchorsTest() {
    SyntheticOptions options;
    options.width = 96;
    options.height = 72;
    options.focal_length = 120;
    scene_ = std::make_unique<SyntheticPlane>(options);
    problem_ = scene_->GeometricProblem();
    depth_ = scene_->depth();
    // The reference view itself has no anchor.
    textureness_ = Map<float>(depth_.width(), depth_.height(), 0.2f);
  }

  std::vector<SurfaceAnchor> Find(const Control& control = Control()) const {
    return FindSurfaceAnchors(options_, problem_, control,
                              MakeRefCamera(problem_.reference.camera), depth_,
                              textureness_);
  }

  Options options_;
  std::unique_ptr<SyntheticPlane> scene_;
  Problem problem_;
  Map<float> depth_;
  Map<float> textureness_;
};

TEST_F(SurfaceAnchorsTest, SourceViewsHaveSomeOnTheSurface) {
  const std::vector<SurfaceAnchor> anchors = Find();
  EXPECT_GT(anchors.size(), 200u);
  const Vec3 normal = scene_->normal();
  const RefCamera camera = MakeRefCamera(problem_.reference.camera);
  const Vec3 any = depth_.At(36, 48) * camera.Ray(36, 48);
  for (const auto& [pixel, point] : anchors) {
    // Within the view, half a pixel from its ray at most.
    ASSERT_GE(pixel.row, 0);
    ASSERT_GE(pixel.col, 0);
    ASSERT_LT(pixel.row, depth_.height());
    ASSERT_LT(pixel.col, depth_.width());
    const Vec3 ray = camera.Ray(pixel.row, pixel.col);
    EXPECT_NEAR(point.x / point.z, ray.x, 0.51f * camera.inv_fx);
    EXPECT_NEAR(point.y / point.z, ray.y, 0.51f * camera.inv_fy);
    EXPECT_NEAR(Dot(normal, point), Dot(normal, any), 1e-3);
  }
}

// Sources of another size than the reference view.
TEST_F(SurfaceAnchorsTest, SourceViewsMayBeOfAnySize) {
  SyntheticOptions options;
  options.width = 48;
  options.height = 36;
  options.focal_length = 60;
  const SyntheticPlane small(options);
  const Problem other = small.GeometricProblem();
  problem_.sources = other.sources;
  const std::vector<SurfaceAnchor> anchors = Find();
  EXPECT_GT(anchors.size(), 50u);
  const RefCamera camera = MakeRefCamera(problem_.reference.camera);
  const Vec3 any = depth_.At(36, 48) * camera.Ray(36, 48);
  bool is_beyond = false;
  for (const auto& [pixel, point] : anchors) {
    EXPECT_NEAR(Dot(scene_->normal(), point), Dot(scene_->normal(), any), 1e-3);
    is_beyond |= pixel.row >= 36 && pixel.col >= 48;
  }
  EXPECT_TRUE(is_beyond);
}

TEST_F(SurfaceAnchorsTest, WhatIsBehindTheCameraIsNotSeen) {
  for (View& view : problem_.sources) {
    // Half a turn about the vertical axis.
    for (const int i : {0, 1, 2, 6, 7, 8}) {
      view.camera.R[i] *= -1;
    }
    view.camera.t[0] *= -1;
    view.camera.t[2] *= -1;
  }
  EXPECT_TRUE(Find().empty());
}

TEST_F(SurfaceAnchorsTest, OneViewHasOneInASquare) {
  textureness_ = ComputeTextureness(*problem_.reference.image,
                                    TexturenessOf(options_.tapa));
  options_.geom_consistency = false;
  const std::vector<SurfaceAnchor> own = Find();
  const std::vector<Anchor> expected =
      FindAnchors(options_.tapa, depth_, textureness_, kClearTexture);
  ASSERT_EQ(own.size(), expected.size());
  ASSERT_GT(own.size(), 100u);
  for (size_t i = 0; i < own.size(); ++i) {
    EXPECT_EQ(own[i].pixel.row, expected[i].row);
    EXPECT_EQ(own[i].pixel.col, expected[i].col);
    EXPECT_EQ(own[i].point.z, depth_.At(expected[i].row, expected[i].col));
  }
  options_.geom_consistency = true;
  EXPECT_GT(Find().size(), 2 * own.size());
}

TEST_F(SurfaceAnchorsTest, WhatIsHiddenIsNotSeen) {
  for (int row = 0; row < depth_.height(); ++row) {
    for (int col = 0; col < depth_.width(); ++col) {
      // Nearer, not there, further away and nearly the same.
      const float factors[] = {0.97f, 0, 1.5f, 0.995f};
      depth_.At(row, col) *= factors[4 * col / depth_.width()];
    }
  }
  int counts[4] = {};
  for (const SurfaceAnchor& anchor : Find()) {
    ++counts[4 * anchor.pixel.col / depth_.width()];
  }
  EXPECT_EQ(counts[0], 0);
  EXPECT_GT(counts[1], 30);
  EXPECT_GT(counts[2], 30);
  EXPECT_GT(counts[3], 30);
}

TEST_F(SurfaceAnchorsTest, NoneAreMasked) {
  problem_.mask = Map<uint8_t>(depth_.width(), depth_.height());
  const size_t all = Find().size();
  for (int row = 0; row < depth_.height(); ++row) {
    for (int col = 0; col < 48; ++col) {
      problem_.mask.At(row, col) = 1;
    }
  }
  const std::vector<SurfaceAnchor> anchors = Find();
  EXPECT_LT(anchors.size(), 0.7 * all);
  EXPECT_GT(anchors.size(), 0.3 * all);
  for (const SurfaceAnchor& anchor : anchors) {
    EXPECT_GE(anchor.pixel.col, 48);
  }
}

TEST_F(SurfaceAnchorsTest, ViewsWithoutDepthOrTextureHaveNone) {
  const Map<uint8_t> grey(depth_.width(), depth_.height(), 128);
  problem_.sources[0].depth = nullptr;
  problem_.sources[1].image = &grey;
  const size_t some = Find().size();
  EXPECT_GT(some, 0u);
  problem_.sources.erase(problem_.sources.begin(),
                         problem_.sources.begin() + 2);
  EXPECT_EQ(Find().size(), some);
}

TEST_F(SurfaceAnchorsTest, EndsWhenTold) {
  Control control;
  control.stopped = [] { return true; };
  EXPECT_TRUE(Find(control).empty());
}

}  // namespace
}  // namespace tapa
