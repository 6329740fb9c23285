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

// Anchors of another view, here of the same place, as the view has none.
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
                1e-3)
        << row << " " << col;
  });
}

// Views whose pixels are shifted by some, so that they have other anchors, with
// texture of their own at one spot. Owns what the problem points to.
struct ShiftedViews {
  static constexpr int kNumViews = 20;

  // size: of the spot, in pixels.
  ShiftedViews(const Scene& scene, int size, Problem* problem) {
    std::mt19937 random(3);
    for (int m = 0; m < kNumViews; ++m) {
      const int shift = m % 5;
      images.push_back(Map<uint8_t>(kWidth, kHeight, 128));
      depths.push_back(Map<float>(kWidth, kHeight));
      const Map<uint8_t> noise = RandomImage(kWidth, kHeight, &random);
      scene.ForEach([&](int row, int col) {
        depths[m].At(row, col) = scene.On(scene.plane, row, col - shift);
        if (std::abs(row - 50) < size && std::abs(col - shift - 80) < size) {
          images[m].At(row, col) = noise.At(row, col);
        }
      });
    }
    for (int m = 0; m < kNumViews; ++m) {
      View view;
      view.camera = {200, 200, 80.5 + m % 5, 50.5};
      view.image = &images[m];
      view.depth = &depths[m];
      problem->sources.push_back(view);
    }
    problem->reference = problem->sources[0];
  }

  std::vector<Map<uint8_t>> images;
  std::vector<Map<float>> depths;
};

// However many views see one spot, nothing is known far from it.
TEST(Regions, StayWhereOnlyASpotIsSeenByManyViews) {
  for (const int size : {2, 4}) {
    Scene scene;
    scene.textureness = Map<float>(kWidth, kHeight, 0.2f);
    const ShiftedViews views(scene, size, &scene.problem);
    ASSERT_GE(FindSurfaceAnchors(scene.options, scene.problem, Control(),
                                 scene.camera, scene.depth, scene.textureness)
                  .size(),
              40u);
    const Map<float> before = scene.depth;
    scene.Complete();
    // Of the large one there are enough squares, which say where it is.
    const float on_plane = scene.On(scene.plane, 50, 80);
    EXPECT_NEAR(scene.depth.At(50, 80) / on_plane, size == 2 ? 1.3 : 1, 1e-3);
    scene.ForEach([&](int row, int col) {
      if (std::abs(col - 80) > 25) {
        ASSERT_EQ(scene.depth.At(row, col), before.At(row, col));
      }
    });
  }
}

// As far off as a plane may miss its anchors, and a bit further.
TEST(Regions, KeepWhatLiesOnTheirPlane) {
  Scene scene;
  scene.ForEach([&scene](int row, int col) {
    if (scene.textureness.At(row, col) < 0.5f) {
      scene.depth.At(row, col) =
          scene.On(scene.plane, row, col) * (col < 80 ? 1.009f : 1.012f);
    }
  });
  const Map<float> before = scene.depth;
  scene.Complete();
  EXPECT_EQ(scene.depth.At(50, 40), before.At(50, 40));
  EXPECT_NEAR(scene.depth.At(50, 120) / scene.On(scene.plane, 50, 120), 1,
              1e-3);
}

TEST(Regions, StayWithoutAPlaneThatHalfOfTheAnchorsLieOn) {
  for (const double share : {0.4, 0.6}) {
    Scene scene;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    // By squares of four pixels, of which each has one anchor.
    Map<float> factors(kWidth / 4 + 1, kHeight / 4 + 1);
    for (size_t i = 0; i < factors.size(); ++i) {
      factors.data()[i] = uniform(random) < share
                              ? 1
                              : 1.1f + static_cast<float>(uniform(random));
    }
    scene.ForEach([&](int row, int col) {
      if (scene.textureness.At(row, col) > 0.5f) {
        scene.depth.At(row, col) *= factors.At((row + 3) / 4, (col + 3) / 4);
      }
    });
    const float before = scene.depth.At(50, 80);
    scene.Complete();
    EXPECT_EQ(scene.depth.At(50, 80) == before, share < 0.5) << share;
  }
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
                0.0101)
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
                  0.0101)
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

// At once, too, and wherever they are by then.
TEST(Regions, EndWhenTold) {
  int num_calls = 0;
  Control counts;
  counts.stopped = [&num_calls] { return ++num_calls < 0; };
  Scene all;
  const Map<float> before = all.depth;
  all.Complete(counts);
  ASSERT_GT(num_calls, 20);
  for (int last = 0; last < num_calls; last += num_calls / 20) {
    int calls = 0;
    Control control;
    control.stopped = [&] { return ++calls > last; };
    Scene scene;
    scene.Complete(control);
    // The rest only asks to find out that it need not begin.
    EXPECT_LE(calls, last + 6);
    EXPECT_TRUE(last > 0 || scene.depth.At(50, 80) == before.At(50, 80));
    scene.ForEach([&](int row, int col) {
      const float depth = scene.depth.At(row, col);
      ASSERT_TRUE(depth == before.At(row, col) ||
                  std::abs(depth / scene.On(scene.plane, row, col) - 1) < 1e-3)
          << row << " " << col;
    });
  }
}

}  // namespace
}  // namespace tapa
