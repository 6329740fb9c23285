#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "src/base/depth.h"
#include "src/mvs/sweep/plane.h"
#include "src/mvs/tapa/completion.h"
#include "src/mvs/tapa/region_planes.h"
#include "src/mvs/tapa/surface_anchors.h"
#include "tests/mvs/synthetic.h"

namespace tapa {
namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 100;
constexpr int kFrame = 6;

Plane Tilted(float x, float y, float distance) {
  const float norm = std::sqrt(x * x + y * y + 1);
  return {{x / norm, y / norm, -1 / norm}, distance / norm};
}

// A plane of one colour in a textured frame, with estimates that are right in
// the frame only.
struct Scene {
  Scene()
      : camera{0.005f, 0.005f, -0.4f, -0.25f},
        plane(Tilted(0.2f, -0.3f, 4)),
        color(kWidth, kHeight, {120, 130, 140}),
        textureness(kWidth, kHeight, 0.2f),
        depth(kWidth, kHeight),
        normal(kWidth, kHeight, {0, 0, -1}),
        origin(kWidth, kHeight, kSwept) {
    problem.depth_min = 1;
    problem.depth_max = 20;
    ForEach([this](int row, int col) {
      const bool in_frame = row < kFrame || col < kFrame ||
                            row >= kHeight - kFrame || col >= kWidth - kFrame;
      textureness.At(row, col) = in_frame ? 0.9f : 0.2f;
      depth.At(row, col) = On(plane, row, col) * (in_frame ? 1 : 1.3f);
    });
  }

  template <typename Visitor>
  void ForEach(const Visitor& visit) const {
    for (int row = 0; row < kHeight; ++row) {
      for (int col = 0; col < kWidth; ++col) {
        visit(row, col);
      }
    }
  }

  float On(const Plane& other, int row, int col) const {
    return PlaneAt(other, camera.Ray(row, col)).depth;
  }

  void Complete(const Control& control = Control()) {
    CompleteRegions(options, problem, control, camera, color, textureness,
                    &depth, &normal, &origin);
  }

  Options options;
  Problem problem;
  RefCamera camera;
  Plane plane;
  Map<Rgb> color;
  Map<float> textureness;
  Map<float> depth;
  Map<Vec3> normal;
  Map<uint8_t> origin;
};

TEST(Regions, TakeThePlaneThroughWhatSurroundsThem) {
  Scene scene;
  scene.depth.At(50, 80) = 0;
  scene.depth.At(50, 81) = std::numeric_limits<float>::quiet_NaN();
  scene.Complete();
  scene.ForEach([&scene](int row, int col) {
    ASSERT_NEAR(scene.depth.At(row, col) / scene.On(scene.plane, row, col), 1,
                1e-3)
        << row << " " << col;
    const bool in_frame = scene.textureness.At(row, col) > 0.5f;
    EXPECT_EQ(scene.origin.At(row, col), in_frame ? kSwept : kFromPlane);
    if (!in_frame) {
      EXPECT_NEAR(scene.normal.At(row, col).y, scene.plane.normal.y, 1e-3);
    }
  });
}

TEST(Regions, StayWhereTheirPlaneIsNotKnown) {
  Scene scene;
  // Anchors along the upper edge only: a line.
  scene.ForEach([&scene](int row, int col) {
    if (row >= kFrame) {
      scene.textureness.At(row, col) = 0.2f;
    }
  });
  const Map<float> before = scene.depth;
  scene.Complete();
  for (int col = 0; col < kWidth; ++col) {
    EXPECT_EQ(scene.depth.At(kHeight / 2, col), before.At(kHeight / 2, col));
    EXPECT_EQ(scene.depth.At(kHeight - 20, col), before.At(kHeight - 20, col));
  }
}

TEST(Regions, StayWithFewAnchors) {
  Scene scene;
  scene.ForEach([&scene](int row, int col) {
    const bool in_corner = row < kFrame && col < kFrame;
    scene.textureness.At(row, col) = in_corner ? 0.9f : 0.2f;
  });
  const Map<float> before = scene.depth;
  scene.Complete();
  scene.ForEach([&](int row, int col) {
    ASSERT_EQ(scene.depth.At(row, col), before.At(row, col));
  });
}

// Anchors of other views, which see the region from where it has an edge.
TEST(Regions, TakeThePlaneThroughWhatOtherViewsSee) {
  Scene scene;
  scene.textureness = Map<float>(kWidth, kHeight, 0.2f);
  std::mt19937 random(3);
  const Map<uint8_t> image = RandomImage(kWidth, kHeight, &random);
  Map<float> source_depth(kWidth, kHeight);
  scene.ForEach([&](int row, int col) {
    source_depth.At(row, col) = scene.On(scene.plane, row, col);
  });
  View view;
  view.camera = {200, 200, 80.5, 50.5};
  view.image = &image;
  view.depth = &source_depth;
  scene.problem.reference = view;
  scene.problem.sources = {view};
  const Map<float> before = scene.depth;

  scene.options.geom_consistency = false;
  scene.Complete();
  EXPECT_EQ(scene.depth.At(50, 80), before.At(50, 80));
  scene.options.geom_consistency = true;
  scene.Complete();
  scene.ForEach([&scene](int row, int col) {
    ASSERT_NEAR(scene.depth.At(row, col) / scene.On(scene.plane, row, col), 1,
                0.011)
        << row << " " << col;
  });
}

// Many views that see one spot are no more than one that does.
TEST(Regions, StayWhereOnlyASpotIsSeenByManyViews) {
  Scene scene;
  scene.textureness = Map<float>(kWidth, kHeight, 0.2f);
  std::mt19937 random(3);
  Map<uint8_t> image(kWidth, kHeight, 128);
  const Map<uint8_t> noise = RandomImage(2, 2, &random);
  Map<float> source_depth(kWidth, kHeight);
  scene.ForEach([&](int row, int col) {
    source_depth.At(row, col) = scene.On(scene.plane, row, col);
    if (row / 2 == 24 && col / 2 == 40) {
      image.At(row, col) = noise.At(row % 2, col % 2);
    }
  });
  View view;
  view.camera = {200, 200, 80.5, 50.5};
  view.image = &image;
  view.depth = &source_depth;
  scene.problem.reference = view;
  scene.problem.sources = std::vector<View>(20, view);
  ASSERT_GE(FindSurfaceAnchors(scene.options, scene.problem, Control(),
                               scene.camera, scene.depth, scene.textureness)
                .size(),
            40u);
  const Map<float> before = scene.depth;
  scene.Complete();
  scene.ForEach([&](int row, int col) {
    ASSERT_EQ(scene.depth.At(row, col), before.At(row, col));
  });
}

TEST(Regions, KeepASecondSurfaceThatHasAnchorsOfItsOwn) {
  Scene scene;
  const Plane left = Tilted(-0.6f, 0, 2);
  scene.ForEach([&](int row, int col) {
    if (col < 60) {
      scene.depth.At(row, col) = scene.On(left, row, col);
    }
  });
  // Without anchors of its own, and of a few pixels only.
  for (int row = 40; row < 60; ++row) {
    for (int col = 90; col < 100; ++col) {
      scene.depth.At(row, col) = 1.1f * scene.On(scene.plane, row, col);
    }
  }
  scene.Complete();
  scene.ForEach([&](int row, int col) {
    const Plane& expected = col < 60 ? left : scene.plane;
    ASSERT_NEAR(scene.depth.At(row, col) / scene.On(expected, row, col), 1,
                0.021)
        << row << " " << col;
  });
}

TEST(Regions, EndWhereTheColourDoes) {
  Scene scene;
  const Plane left = Tilted(-0.6f, 0, 2);
  scene.ForEach([&](int row, int col) {
    if (col < 80) {
      scene.color.At(row, col) = {100, 130, 140};
      scene.depth.At(row, col) =
          scene.On(left, row, col) *
          (scene.textureness.At(row, col) > 0.5f ? 1 : 1.3f);
    }
  });
  scene.Complete();
  scene.ForEach([&](int row, int col) {
    if (std::abs(col - 80) > 5) {
      const Plane& expected = col < 80 ? left : scene.plane;
      ASSERT_NEAR(scene.depth.At(row, col) / scene.On(expected, row, col), 1,
                  0.021)
          << row << " " << col;
    }
  });
}

// A pillar of another plane, whose colour ends at a step between the two
// heights at which regions do: first it is part of the surface around it.
TEST(Regions, EndAtLowStepsInTheEnd) {
  Scene scene;
  const Plane pillar = Tilted(0.2f, -0.3f, 3);
  scene.ForEach([&](int row, int col) {
    if (std::abs(col - 80) < 20) {
      scene.color.At(row, col) = {116, 126, 136};
      scene.depth.At(row, col) =
          scene.On(pillar, row, col) *
          (scene.textureness.At(row, col) > 0.5f ? 1 : 1.2f);
    }
  });
  scene.Complete();
  EXPECT_NEAR(scene.depth.At(50, 80) / scene.On(pillar, 50, 80), 1, 1e-3);
  EXPECT_NEAR(scene.depth.At(50, 30) / scene.On(scene.plane, 50, 30), 1, 1e-3);
  EXPECT_NEAR(scene.depth.At(50, 130) / scene.On(scene.plane, 50, 130), 1,
              1e-3);
}

// Neither do they count among a region's pixels, nor do they connect regions.
TEST(Regions, EndAtMasks) {
  Scene scene;
  const Plane right = Tilted(-0.6f, 0, 2);
  scene.problem.mask = Map<uint8_t>(kWidth, kHeight);
  scene.ForEach([&](int row, int col) {
    if (std::abs(col - 80) < 10) {
      scene.problem.mask.At(row, col) = 1;
      scene.depth.At(row, col) = 0;
    } else if (col > 80) {
      scene.depth.At(row, col) =
          scene.On(right, row, col) *
          (scene.textureness.At(row, col) > 0.5f ? 1 : 1.3f);
    }
  });
  scene.Complete();
  EXPECT_NEAR(scene.depth.At(50, 30) / scene.On(scene.plane, 50, 30), 1, 1e-3);
  EXPECT_EQ(scene.depth.At(50, 80), 0);
  EXPECT_NEAR(scene.depth.At(50, 130) / scene.On(right, 50, 130), 1, 1e-3);
}

TEST(Regions, LeaveMaskedPixelsAlone) {
  Scene scene;
  scene.problem.mask = Map<uint8_t>(kWidth, kHeight);
  scene.problem.mask.At(50, 80) = 1;
  const float masked = scene.depth.At(50, 80);
  scene.Complete();
  EXPECT_EQ(scene.depth.At(50, 80), masked);
  EXPECT_NE(scene.depth.At(50, 81), masked);
}

// The range of depths is the sparse points', which a wall near the camera has
// none of; but a plane ends where it is not known, long before its horizon.
TEST(Regions, MayLeaveTheRangeOfDepths) {
  Scene scene;
  scene.problem.depth_min = scene.problem.depth_max = 4;
  scene.Complete();
  EXPECT_NEAR(scene.depth.At(50, 80) / scene.On(scene.plane, 50, 80), 1, 1e-3);

  Scene floor;
  floor.plane = Tilted(0, 4, 4);
  floor.ForEach([&floor](int row, int col) {
    const bool is_seen = row >= 60;
    const bool has_texture =
        is_seen && (col < kFrame || col >= kWidth - kFrame ||
                    row >= kHeight - kFrame || row < 66);
    floor.textureness.At(row, col) = has_texture ? 0.9f : 0.2f;
    floor.depth.At(row, col) = is_seen ? floor.On(floor.plane, row, col) : 0.0f;
  });
  floor.Complete();
  floor.ForEach([&floor](int row, int col) {
    ASSERT_GE(floor.depth.At(row, col), 0);
    if (row < 20) {
      ASSERT_EQ(floor.depth.At(row, col), 0) << row << " " << col;
    }
  });
}

TEST(Regions, EndWhenTold) {
  Scene scene;
  const Map<float> before = scene.depth;
  Control control;
  control.stopped = [] { return true; };
  scene.Complete(control);
  EXPECT_EQ(scene.depth.At(50, 80), before.At(50, 80));
}

}  // namespace
}  // namespace tapa
