#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

#include "src/mvs/estimate_depth.h"
#include "src/mvs/sweep/hypotheses.h"
#include "src/mvs/tapa/stages.h"
#include "tests/mvs/synthetic.h"

// The whole of TAPA through EstimateDepth.
namespace tapa {
namespace {

Options TapaPass(bool geometric) {
  Options options;
  options.geom_consistency = geometric;
  options.tapa.enabled = true;
  return options;
}

// As the paper has it, before anything is filtered or filled.
Options SweepsOnly(bool geometric) {
  Options options = TapaPass(geometric);
  options.tapa.refinement = false;
  return options;
}

// A textured surface with a large stripe that has no texture at all.
SyntheticOptions WallScene(unsigned seed) {
  SyntheticOptions options;
  options.width = 160;
  options.height = 120;
  options.focal_length = 160;
  options.num_sources = 8;
  options.wall = 0.8;
  options.seed = seed;
  return options;
}

// Share of the wall, or of the rest, with a depth within 3 % of the truth.
double ShareRight(const SyntheticPlane& scene, const Estimate& estimate,
                  bool on_wall) {
  int num_right = 0;
  int num_pixels = 0;
  for (size_t i = 0; i < estimate.depth.size(); ++i) {
    if (scene.wall().data()[i] == on_wall) {
      ++num_pixels;
      num_right += std::abs(estimate.depth.data()[i] / scene.depth().data()[i] -
                            1) < 0.03f;
    }
  }
  return static_cast<double>(num_right) / num_pixels;
}

template <typename T>
bool SameMap(const Map<T>& a, const Map<T>& b) {
  return a.width() == b.width() && a.height() == b.height() &&
         std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

bool SameEstimate(const Estimate& a, const Estimate& b) {
  return SameMap(a.depth, b.depth) && SameMap(a.normal, b.normal) &&
         a.selection_prob == b.selection_prob;
}

bool SameSegmentation(const Segmentation& a, const Segmentation& b) {
  return SameMap(a.superpixels.labels, b.superpixels.labels) &&
         a.planes.size() == b.planes.size() &&
         std::memcmp(a.planes.data(), b.planes.data(),
                     a.planes.size() * sizeof(FittedPlane)) == 0;
}

// Every pixel has a depth and a normal that faces the camera, or neither.
void ExpectSound(const Problem& problem, const Estimate& estimate) {
  const Map<uint8_t>& image = *problem.reference.image;
  ASSERT_EQ(estimate.depth.width(), image.width());
  ASSERT_EQ(estimate.depth.height(), image.height());
  const Camera& camera = problem.reference.camera;
  for (int row = 0; row < image.height(); ++row) {
    for (int col = 0; col < image.width(); ++col) {
      const float depth = estimate.depth.At(row, col);
      const Vec3 normal = estimate.normal.At(row, col);
      ASSERT_TRUE(std::isfinite(depth) && depth >= 0);
      if (depth == 0) {
        EXPECT_EQ(Dot(normal, normal), 0);
      } else {
        const Vec3 ray = {
            static_cast<float>((col + 0.5 - camera.cx) / camera.fx),
            static_cast<float>((row + 0.5 - camera.cy) / camera.fy), 1};
        EXPECT_NEAR(Dot(normal, normal), 1, 1e-4);
        EXPECT_LT(Dot(normal, ray), 1e-6f);
      }
    }
  }
}

TEST(Tapa, RecoversAWallWithoutTexture) {
  for (const unsigned seed : {1u, 2u}) {
    const SyntheticPlane scene(WallScene(seed));
    Options plain;
    plain.geom_consistency = false;
    const auto without = EstimateDepth(plain, scene.problem());
    const auto swept = EstimateDepth(SweepsOnly(false), scene.problem());
    const auto refined = EstimateDepth(TapaPass(false), scene.problem());
    ASSERT_TRUE(without && swept && refined);
    ExpectSound(scene.problem(), *refined);
    // Only its border is measured: 13 % when this was written; with TAPA, 90 %
    // before and 96 % after refinement.
    EXPECT_LT(ShareRight(scene, *without, true), 0.25);
    EXPECT_GT(ShareRight(scene, *swept, true), 0.8);
    EXPECT_GT(ShareRight(scene, *refined, true), 0.85);
    // The rest is not worse.
    const double rest = ShareRight(scene, *without, false);
    EXPECT_GT(ShareRight(scene, *swept, false), rest - 0.02);
    EXPECT_GT(ShareRight(scene, *refined, false), rest - 0.02);
  }
}

TEST(Tapa, EachSegmentationAloneRecoversTheWall) {
  const SyntheticPlane scene(WallScene(1));
  for (const bool fine : {false, true}) {
    Options options = SweepsOnly(false);
    options.tapa.fine_superpixels = fine;
    options.tapa.coarse_superpixels = !fine;
    const auto estimate = EstimateDepth(options, scene.problem());
    ASSERT_TRUE(estimate);
    EXPECT_GT(ShareRight(scene, *estimate, true), 0.6) << fine;
  }
}

TEST(Tapa, KeepsTheWallInTheGeometricPass) {
  const SyntheticPlane scene(WallScene(1));
  const auto photometric = EstimateDepth(TapaPass(false), scene.problem());
  ASSERT_TRUE(photometric);
  // Source views that know the truth, and ones that know nothing of it.
  const Map<float> no_depth(160, 120, 0.0f);
  for (const bool known : {false, true}) {
    Problem problem = scene.GeometricProblem();
    problem.depth = photometric->depth;
    problem.normal = photometric->normal;
    for (View& source : problem.sources) {
      source.depth = known ? source.depth : &no_depth;
    }
    const auto geometric = EstimateDepth(SweepsOnly(true), problem);
    ASSERT_TRUE(geometric);
    EXPECT_GT(ShareRight(scene, *geometric, true), 0.8) << known;
    EXPECT_GT(ShareRight(scene, *geometric, false), 0.88) << known;
  }
}

TEST(Tapa, WithoutItsPartsIsThePlainAlgorithm) {
  const SyntheticPlane scene{SyntheticOptions()};
  for (const bool geometric : {false, true}) {
    const Problem problem =
        geometric ? scene.GeometricProblem() : scene.problem();
    Options options = SweepsOnly(geometric);
    options.num_iterations = 3;
    options.tapa.texture_weighting = false;
    options.tapa.fine_superpixels = false;
    options.tapa.coarse_superpixels = false;
    Options plain = options;
    plain.tapa = TapaOptions();
    plain.filter = false;
    const auto expected = EstimateDepth(plain, problem);
    const auto actual = EstimateDepth(options, problem);
    ASSERT_TRUE(expected && actual);
    EXPECT_TRUE(SameEstimate(*actual, *expected));
    EXPECT_TRUE(expected->chosen.empty());
    // Each part changes something.
    for (bool TapaOptions::*part :
         {&TapaOptions::texture_weighting, &TapaOptions::fine_superpixels,
          &TapaOptions::coarse_superpixels}) {
      Options changed = options;
      changed.tapa.*part = true;
      const auto estimate = EstimateDepth(changed, problem);
      ASSERT_TRUE(estimate);
      EXPECT_FALSE(SameEstimate(*estimate, *expected));
    }
    // Parts do nothing as long as TAPA is off.
    Options off = TapaPass(geometric);
    off.num_iterations = 3;
    off.filter = false;
    off.tapa.enabled = false;
    EXPECT_TRUE(SameEstimate(*EstimateDepth(off, problem), *expected));
  }
}

TEST(Tapa, ResultDoesNotDependOnThreads) {
  SyntheticOptions scene_options = WallScene(3);
  scene_options.width = 100;
  scene_options.height = 75;
  scene_options.focal_length = 100;
  const SyntheticPlane scene(scene_options);
  for (const bool geometric : {false, true}) {
    const Problem problem =
        geometric ? scene.GeometricProblem() : scene.problem();
    Options options = TapaPass(geometric);
    options.num_iterations = 3;
    const auto run = [&](int num_threads, TapaRecord* record) {
      options.num_threads = num_threads;
      Control control;
      control.record = record;
      return EstimateDepth(options, problem, control);
    };
    TapaRecord record_one;
    const auto one = run(1, &record_one);
    ASSERT_TRUE(one);
    for (const int num_threads : {1, 2, 5}) {
      TapaRecord record;
      const auto many = run(num_threads, &record);
      ASSERT_TRUE(many);
      EXPECT_TRUE(SameEstimate(*one, *many)) << num_threads;
      EXPECT_TRUE(one->consistent == many->consistent) << num_threads;
      EXPECT_TRUE(SameMap(record.chosen, record_one.chosen));
      EXPECT_TRUE(SameMap(record.swept_depth, record_one.swept_depth));
      EXPECT_TRUE(SameSegmentation(record.fine, record_one.fine));
      EXPECT_TRUE(SameSegmentation(record.coarse, record_one.coarse));
    }
    options.seed = 1;
    EXPECT_FALSE(SameEstimate(*one, *run(1, nullptr)));
  }
}

// With a step of completion and without: how many pixels differ, whose origin
// says so. The paper's method does not know it.
int CountChanged(const Options& with, const Options& without) {
  const SyntheticPlane scene(WallScene(1));
  TapaRecord record;
  Control control;
  control.record = &record;
  const auto a = EstimateDepth(with, scene.problem(), control);
  const auto b = EstimateDepth(without, scene.problem());
  if (!a || !b) {
    ADD_FAILURE();
    return 0;
  }
  int num_changed = 0;
  for (size_t i = 0; i < a->depth.size(); ++i) {
    if (a->depth.data()[i] != b->depth.data()[i]) {
      ++num_changed;
      EXPECT_EQ(record.origin.data()[i], kFromPlane);
    }
  }
  Options paper_with = with;
  Options paper_without = without;
  paper_with.tapa.completion = paper_without.tapa.completion = false;
  EXPECT_TRUE(SameEstimate(*EstimateDepth(paper_with, scene.problem()),
                           *EstimateDepth(paper_without, scene.problem())));
  return num_changed;
}

TEST(Tapa, MendsSilhouettesUnlessToldNotTo) {
  // What silhouettes change regions may follow.
  Options with = TapaPass(false);
  with.tapa.completion_regions = false;
  Options without = with;
  without.tapa.completion_silhouettes = false;
  const int num_changed = CountChanged(with, without);
  EXPECT_GT(num_changed, 0);
  EXPECT_LT(num_changed, 160 * 120 / 10);
}

TEST(Tapa, CompletesRegionsUnlessToldNotTo) {
  // Without superpixels nothing else knows where the wall is.
  Options with = TapaPass(false);
  with.tapa.fine_superpixels = with.tapa.coarse_superpixels = false;
  Options without = with;
  without.tapa.completion_regions = false;
  EXPECT_GT(CountChanged(with, without), 160 * 120 / 10);

  const SyntheticPlane scene(WallScene(1));
  const double share_without =
      ShareRight(scene, *EstimateDepth(without, scene.problem()), true);
  EXPECT_GT(ShareRight(scene, *EstimateDepth(with, scene.problem()), true),
            share_without + 0.2);
}

TEST(Tapa, RecordsWhatItDid) {
  const SyntheticPlane scene(WallScene(1));
  for (const bool geometric : {false, true}) {
    const Problem problem =
        geometric ? scene.GeometricProblem() : scene.problem();
    Options options = TapaPass(geometric);
    options.num_iterations = 2;
    TapaRecord record;
    Control control;
    control.record = &record;
    const auto estimate = EstimateDepth(options, problem, control);
    ASSERT_TRUE(estimate);
    const auto has_size = [](const auto& map) {
      return map.width() == 160 && map.height() == 120;
    };
    EXPECT_TRUE(has_size(record.textureness));
    EXPECT_TRUE(has_size(record.chosen));
    EXPECT_TRUE(has_size(record.swept_depth));
    EXPECT_TRUE(has_size(record.filtered_depth));
    for (const Segmentation* segmentation : {&record.fine, &record.coarse}) {
      EXPECT_TRUE(has_size(segmentation->superpixels.labels));
      EXPECT_GT(segmentation->superpixels.count(), 1);
      EXPECT_EQ(segmentation->planes.size(),
                segmentation->superpixels.neighbors.size());
      int num_planes = 0;
      for (const FittedPlane& fit : segmentation->planes) {
        EXPECT_TRUE(fit.inlier_ratio >= 0 && fit.inlier_ratio <= 1);
        num_planes += fit.inlier_ratio > 0;
      }
      EXPECT_GT(num_planes, 0);
    }
    int num_planar = 0;
    for (size_t i = 0; i < record.chosen.size(); ++i) {
      ASSERT_LT(record.chosen.data()[i], kNumHypotheses);
      num_planar += record.chosen.data()[i] >= kFinePlane;
      // Refinement begins by removing.
      const float swept = record.swept_depth.data()[i];
      const float filtered = record.filtered_depth.data()[i];
      EXPECT_GT(swept, 0);
      EXPECT_TRUE(filtered == 0 || filtered == swept);
    }
    EXPECT_GT(num_planar, 1000);

    // Parts that are off leave nothing.
    options.tapa.fine_superpixels = false;
    record = TapaRecord();
    ASSERT_TRUE(EstimateDepth(options, problem, control));
    EXPECT_EQ(record.fine.superpixels.count(), 0);
    EXPECT_GT(record.coarse.superpixels.count(), 1);
  }
}

TEST(Tapa, ReportsProgressAndStops) {
  const SyntheticPlane scene{SyntheticOptions()};
  for (const bool geometric : {false, true}) {
    const Problem problem =
        geometric ? scene.GeometricProblem() : scene.problem();
    Options options = TapaPass(geometric);
    options.num_iterations = 2;
    options.num_threads = 1;
    int num_calls = 0;
    double last = 0;
    Control control;
    control.stopped = [&] {
      ++num_calls;
      return false;
    };
    control.progress = [&](double done) {
      EXPECT_GE(done, last);
      EXPECT_LE(done, 1);
      last = done;
    };
    ASSERT_TRUE(EstimateDepth(options, problem, control));
    EXPECT_DOUBLE_EQ(last, 1);

    const int num_all_calls = num_calls;
    for (int call = 1; call < num_all_calls; call += 7) {
      num_calls = 0;
      control = Control();
      control.stopped = [&] { return ++num_calls >= call; };
      EXPECT_FALSE(EstimateDepth(options, problem, control)) << call;
      EXPECT_LT(num_calls, call + 10);
    }
  }
}

TEST(Tapa, SeesThePhotographsColors) {
  const SyntheticPlane scene(WallScene(1));
  Options options = TapaPass(false);
  options.num_iterations = 2;
  Problem problem = scene.problem();
  const auto run = [&](TapaRecord* record) {
    Control control;
    control.record = record;
    return EstimateDepth(options, problem, control);
  };
  TapaRecord grey_record;
  const auto grey = run(&grey_record);
  Map<Rgb> color(160, 120);
  for (size_t i = 0; i < color.size(); ++i) {
    const uint8_t value = problem.reference.image->data()[i];
    color.data()[i] = {value, value, value};
  }
  problem.reference_color = &color;
  TapaRecord same_record;
  EXPECT_TRUE(SameEstimate(*run(&same_record), *grey));
  EXPECT_TRUE(SameSegmentation(same_record.coarse, grey_record.coarse));
  // An edge that only colours show.
  for (int row = 0; row < 120; ++row) {
    for (int col = 0; col < 160; ++col) {
      color.At(row, col) = col < 70 ? Rgb{220, 60, 40} : Rgb{30, 90, 230};
    }
  }
  TapaRecord color_record;
  ASSERT_TRUE(run(&color_record));
  const Map<uint16_t>& labels = color_record.fine.superpixels.labels;
  int num_across = 0;
  for (int row = 0; row < 120; ++row) {
    num_across += labels.At(row, 69) == labels.At(row, 70);
  }
  EXPECT_LT(num_across, 12);
}

TEST(Tapa, WorksOnTinyImages) {
  const struct {
    int width, height;
  } sizes[] = {{1, 1}, {1, 30}, {30, 1}, {5, 5}, {16, 16}, {100, 17}};
  for (const auto& size : sizes) {
    SyntheticOptions scene_options;
    scene_options.width = size.width;
    scene_options.height = size.height;
    const SyntheticPlane scene(scene_options);
    for (const bool geometric : {false, true}) {
      SCOPED_TRACE(testing::Message() << size.width << "x" << size.height
                                      << " geometric " << geometric);
      const Problem problem =
          geometric ? scene.GeometricProblem() : scene.problem();
      Options options = TapaPass(geometric);
      options.num_iterations = 2;
      const auto estimate = EstimateDepth(options, problem);
      ASSERT_TRUE(estimate);
      ExpectSound(problem, *estimate);
    }
  }
}

TEST(Tapa, WorksWhereNothingHasTexture) {
  const SyntheticPlane scene{SyntheticOptions()};
  const Map<uint8_t> flat(48, 40, 77);
  for (const bool geometric : {false, true}) {
    Problem problem = geometric ? scene.GeometricProblem() : scene.problem();
    problem.reference.image = &flat;
    for (View& source : problem.sources) {
      source.image = &flat;
    }
    Options options = TapaPass(geometric);
    options.num_iterations = 3;
    const auto estimate = EstimateDepth(options, problem);
    ASSERT_TRUE(estimate);
    ExpectSound(problem, *estimate);
  }
}

TEST(Tapa, GeometricPassAcceptsABadStart) {
  const SyntheticPlane scene{SyntheticOptions()};
  Problem problem = scene.GeometricProblem();
  for (size_t i = 0; i < problem.depth.size(); ++i) {
    const float values[] = {0.0f,
                            -1.0f,
                            NAN,
                            INFINITY,
                            1.3f * problem.depth.data()[i],
                            problem.depth.data()[i]};
    problem.depth.data()[i] = values[i % 6];
  }
  const auto estimate = EstimateDepth(TapaPass(true), problem);
  ASSERT_TRUE(estimate);
  ExpectSound(problem, *estimate);
  EXPECT_GT(ShareRight(scene, *estimate, false), 0.8);

  // No depth at all.
  problem.depth = Map<float>(48, 40, 0.0f);
  const auto from_nothing = EstimateDepth(TapaPass(true), problem);
  ASSERT_TRUE(from_nothing);
  ExpectSound(problem, *from_nothing);
}

TEST(Tapa, RejectsAPhotographOfAnotherSize) {
  const SyntheticPlane scene{SyntheticOptions()};
  Problem problem = scene.problem();
  for (const Map<Rgb>& color :
       {Map<Rgb>(47, 40), Map<Rgb>(48, 41), Map<Rgb>(40, 48), Map<Rgb>()}) {
    problem.reference_color = &color;
    EXPECT_THROW(EstimateDepth(TapaPass(false), problem),
                 std::invalid_argument);
  }
}

}  // namespace
}  // namespace tapa
