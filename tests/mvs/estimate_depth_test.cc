#include "src/mvs/estimate_depth.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "src/base/parallel.h"
#include "src/mvs/cpu/aligned.h"
#include "tests/mvs/synthetic.h"

namespace tapa {
namespace {

// Share of the pixels whose depth is within `tolerance` of the truth, leaving
// out a margin that the window does not cover.
double ShareWithin(const Map<float>& depth, const Map<float>& truth,
                   double tolerance, int margin) {
  int num_right = 0;
  int num_pixels = 0;
  for (int row = margin; row < depth.height() - margin; ++row) {
    for (int col = margin; col < depth.width() - margin; ++col) {
      num_right +=
          std::abs(depth.At(row, col) / truth.At(row, col) - 1) < tolerance;
      ++num_pixels;
    }
  }
  return static_cast<double>(num_right) / num_pixels;
}

Options PhotometricOptions() {
  Options options;
  options.geom_consistency = false;
  options.filter = false;
  options.num_iterations = 3;
  return options;
}

TEST(EstimateDepth, FindsAPlaneFromRandomStart) {
  SyntheticOptions scene_options;
  scene_options.baseline = 0.5;
  scene_options.num_sources = 10;
  const SyntheticPlane scene(scene_options);
  Options options = PhotometricOptions();
  options.num_iterations = 5;
  const auto estimate = EstimateDepth(options, scene.problem());
  ASSERT_TRUE(estimate);
  EXPECT_GT(ShareWithin(estimate->depth, scene.depth(), 0.03, 6), 0.9);
  int num_normals = 0;
  for (size_t i = 0; i < estimate->normal.size(); ++i) {
    num_normals += Dot(estimate->normal.data()[i], scene.normal()) > 0.95f;
  }
  EXPECT_GT(num_normals, 0.6 * estimate->normal.size());
}

// Where the first source view sees a pixel that has a depth, by the rule that
// pixel (row, col) has its centre at (col + 0.5, row + 0.5).
Eigen::Vector2d SeenAt(const Problem& problem, int row, int col, double depth) {
  using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const Camera& ref = problem.reference.camera;
  const Camera& source = problem.sources[0].camera;
  const Eigen::Vector3d point(depth * (col + 0.5 - ref.cx) / ref.fx,
                              depth * (row + 0.5 - ref.cy) / ref.fy, depth);
  const Eigen::Vector3d world =
      Eigen::Map<const Matrix>(ref.R.data()).transpose() *
      (point - Eigen::Map<const Eigen::Vector3d>(ref.t.data()));
  const Eigen::Vector3d seen =
      Eigen::Map<const Matrix>(source.R.data()) * world +
      Eigen::Map<const Eigen::Vector3d>(source.t.data());
  return {source.fx * seen(0) / seen(2) + source.cx,
          source.fy * seen(1) / seen(2) + source.cy};
}

// Half a pixel too much or too little in a ray moves what a camera sees that is
// turned by 90 degrees by 0.7 pixels.
TEST(EstimateDepth, FindsTheSamePlaneToATenthOfAPixelAtEverySize) {
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{
           {128, 96}, {64, 48}, {61, 45}, {43, 33}}) {
    SyntheticOptions scene_options;
    scene_options.width = 128;
    scene_options.height = 96;
    scene_options.focal_length = 160;
    scene_options.num_sources = 1;
    scene_options.roll = 0.5 * M_PI;
    scene_options.scaled_width = width;
    scene_options.scaled_height = height;
    const SyntheticPlane scene(scene_options);
    const auto estimate = EstimateDepth(PhotometricOptions(), scene.problem());
    ASSERT_TRUE(estimate);
    constexpr int kMargin = 6;
    std::vector<double> errors;
    Eigen::Vector2d sum(0, 0);
    for (int row = kMargin; row < height - kMargin; ++row) {
      for (int col = kMargin; col < width - kMargin; ++col) {
        const Eigen::Vector2d truth =
            SeenAt(scene.problem(), row, col, scene.depth().At(row, col));
        if (truth(0) < kMargin || truth(1) < kMargin ||
            truth(0) > width - kMargin || truth(1) > height - kMargin) {
          continue;
        }
        const Eigen::Vector2d error =
            SeenAt(scene.problem(), row, col, estimate->depth.At(row, col)) -
            truth;
        errors.push_back(error.norm());
        sum += error;
      }
    }
    ASSERT_GT(errors.size(), 0.2 * width * height);
    const auto worst_of_most = errors.begin() + errors.size() * 9 / 10;
    std::nth_element(errors.begin(), worst_of_most, errors.end());
    EXPECT_LT(*worst_of_most, 0.1) << width << "x" << height;
    EXPECT_LT(sum.norm() / errors.size(), 0.05) << width << "x" << height;
  }
}

TEST(EstimateDepth, GeometricPassRepairsABadStart) {
  const SyntheticPlane scene{SyntheticOptions()};
  Problem problem = scene.GeometricProblem();
  Map<float>& start = problem.depth;
  for (size_t i = 0; i < start.size(); ++i) {
    // Holes, nonsense and wrong depths.
    const float values[] = {0.0f, -1.0f, NAN, 1.3f * start.data()[i],
                            start.data()[i]};
    start.data()[i] = values[i % 5];
  }
  Options options = PhotometricOptions();
  options.geom_consistency = true;
  const auto estimate = EstimateDepth(options, problem);
  ASSERT_TRUE(estimate);
  EXPECT_GT(ShareWithin(estimate->depth, scene.depth(), 0.01, 6), 0.95);
}

TEST(EstimateDepth, ResultDoesNotDependOnThreads) {
  const SyntheticPlane scene{SyntheticOptions()};
  for (const bool geometric : {false, true}) {
    Options options;
    options.num_iterations = 2;
    options.geom_consistency = geometric;
    const Problem problem =
        geometric ? scene.GeometricProblem() : scene.problem();
    options.num_threads = 1;
    const auto one = EstimateDepth(options, problem);
    for (const int num_threads : {2, 3, 7}) {
      options.num_threads = num_threads;
      const auto many = EstimateDepth(options, problem);
      ASSERT_TRUE(one && many);
      EXPECT_TRUE(Same(*one, *many)) << num_threads;
    }
    options.seed = 1;
    EXPECT_FALSE(Same(*one, *EstimateDepth(options, problem)));
  }
}

TEST(EstimateDepth, WorksWithOneSourceAndWithMany) {
  for (const int num_sources : {1, 2, 15, 16, 17, 40}) {
    SyntheticOptions scene_options;
    scene_options.width = 26;
    scene_options.height = 21;
    scene_options.num_sources = num_sources;
    const SyntheticPlane scene(scene_options);
    Options options = PhotometricOptions();
    options.filter = true;
    options.filter_min_num_consistent = 1;
    const auto estimate = EstimateDepth(options, scene.problem());
    ASSERT_TRUE(estimate);
    EXPECT_EQ(estimate->selection_prob.size(), 26u * 21u * num_sources);
    EXPECT_EQ(estimate->consistent.size(), 26u * 21u * ((num_sources + 7) / 8));
    // A single view does not see all of the reference image.
    EXPECT_GT(ShareWithin(estimate->depth, scene.depth(), 0.05, 5),
              num_sources == 1 ? 0.15 : 0.5)
        << num_sources;
  }
}

TEST(EstimateDepth, WorksOnTinyAndFlatImages) {
  for (const int size : {1, 2, 5}) {
    SyntheticOptions scene_options;
    scene_options.width = size;
    scene_options.height = 3;
    const SyntheticPlane scene(scene_options);
    const auto estimate = EstimateDepth(PhotometricOptions(), scene.problem());
    ASSERT_TRUE(estimate);
    for (size_t i = 0; i < estimate->depth.size(); ++i) {
      EXPECT_GT(estimate->depth.data()[i], 0);
    }
  }
  const SyntheticPlane scene{SyntheticOptions()};
  const Map<uint8_t> flat(48, 40, 77);
  Problem problem = scene.problem();
  problem.reference.image = &flat;
  Options options = PhotometricOptions();
  options.filter = true;
  const auto estimate = EstimateDepth(options, problem);
  ASSERT_TRUE(estimate);
  // The window sees nothing but the flat image from 5 pixels off its border on.
  for (int row = 5; row < 35; ++row) {
    for (int col = 5; col < 43; ++col) {
      EXPECT_EQ(estimate->depth.At(row, col), 0);
    }
  }
}

TEST(EstimateDepth, ReportsProgressAndStops) {
  const SyntheticPlane scene{SyntheticOptions()};
  double last = 0;
  int num_calls = 0;
  Control control;
  control.progress = [&](double done) {
    EXPECT_GE(done, last);
    EXPECT_LE(done, 1.0);
    last = done;
    ++num_calls;
  };
  ASSERT_TRUE(EstimateDepth(PhotometricOptions(), scene.problem(), control));
  EXPECT_DOUBLE_EQ(last, 1.0);
  EXPECT_GT(num_calls, 20);

  int num_left = 10;
  control = Control();
  control.stopped = [&] { return --num_left < 0; };
  EXPECT_FALSE(EstimateDepth(PhotometricOptions(), scene.problem(), control));
  // Once in a while after the request at most, not to the end.
  EXPECT_GE(num_left, -10);
}

void ExpectError(const Options& options, const Problem& problem,
                 const std::string& text) {
  try {
    EstimateDepth(options, problem);
    FAIL() << "expected: " << text;
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos)
        << error.what();
  }
}

TEST(EstimateDepth, NamesWhatIsWrongWithTheProblem) {
  const SyntheticPlane scene{SyntheticOptions()};
  const Options photometric = PhotometricOptions();
  Options geometric = photometric;
  geometric.geom_consistency = true;

  Problem problem = scene.problem();
  problem.sources.clear();
  ExpectError(photometric, problem, "no source views");
  problem = scene.problem();
  problem.sources[1].image = nullptr;
  ExpectError(photometric, problem, "source view 1 has no image");
  problem = scene.problem();
  problem.depth_min = 0;
  ExpectError(photometric, problem, "depth range");
  problem = scene.problem();
  problem.depth_max = NAN;
  ExpectError(photometric, problem, "depth range");
  problem = scene.problem();
  problem.reference.camera.fx = 0;
  ExpectError(photometric, problem, "focal length");
  ExpectError(geometric, scene.problem(), "no depth map");
  problem = scene.GeometricProblem();
  const Map<float> small(3, 3);
  problem.sources[2].depth = &small;
  ExpectError(geometric, problem, "source view 2 has a depth map of another");
  problem = scene.GeometricProblem();
  problem.normal = Map<Vec3>(3, 3);
  ExpectError(geometric, problem, "normal map");
}

TEST(Options, CheckNamesTheOption) {
  const auto expect_error = [](auto change, const std::string& name) {
    Options options;
    change(&options);
    try {
      options.Check();
      FAIL() << name;
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(std::string(error.what()).find(name), 0u) << error.what();
    }
  };
  Options().Check();
  expect_error([](Options* o) { o->window_radius = 33; }, "window_radius");
  expect_error([](Options* o) { o->window_radius = 0; }, "window_radius");
  expect_error([](Options* o) { o->window_step = 3; }, "window_step");
  expect_error([](Options* o) { o->sigma_color = 0; }, "sigma_color");
  expect_error([](Options* o) { o->num_samples = 0; }, "num_samples");
  expect_error([](Options* o) { o->search.sigma_textured = 0.1; },
               "sigma_textured");
  expect_error([](Options* o) { o->ncc_sigma = NAN; }, "ncc_sigma");
  expect_error([](Options* o) { o->num_iterations = 0; }, "num_iterations");
  expect_error([](Options* o) { o->num_threads = 0; }, "num_threads");
  expect_error([](Options* o) { o->filter_min_ncc = 1.5; }, "filter_min_ncc");
}

TEST(EstimateDepth, MemoryStaysBelow250BytesPerPixelAt20Sources) {
  SyntheticOptions scene_options;
  scene_options.num_sources = 20;
  scene_options.width = 200;
  scene_options.height = 200;
  const SyntheticPlane scene(scene_options);
  const Problem problem = scene.GeometricProblem();
  // With what the views hold: grey images and, for the sources, depth maps.
  const size_t views = problem.reference.image->size() * (21 + 20 * 4);
  EXPECT_LT(EstimateDepthMemory(Options(), problem) + views,
            250 * problem.reference.image->size());
}

TEST(EstimateDepth, SaysWhenThereIsNoMemory) {
  EXPECT_THROW(MakeAligned<float>(size_t{1} << 60), std::bad_alloc);
}

TEST(ThreadTeam, CoversEveryIndexOnce) {
  ThreadTeam team(3);
  for (const int count : {0, 1, 7, 1000}) {
    std::vector<std::atomic<int>> visits(count);
    double last = 0;
    EXPECT_TRUE(team.For(
        count, 8,
        [&](int thread, int begin, int end, const ContinueCheck&) {
          EXPECT_GE(thread, 0);
          EXPECT_LT(thread, 3);
          for (int i = begin; i < end; ++i) {
            ++visits[i];
          }
        },
        [&](double done) {
          last = done;
          return true;
        }));
    for (const auto& n : visits) {
      EXPECT_EQ(n, 1);
    }
    EXPECT_EQ(last, count > 0 ? 1.0 : 0.0);
  }
}

TEST(ThreadTeam, StopsAndPassesErrorsOn) {
  ThreadTeam team(2);
  std::atomic<int> num_run{0};
  EXPECT_FALSE(team.For(
      1000, 1, [&](int, int, int, const ContinueCheck&) { ++num_run; },
      [&](double) { return false; }));
  EXPECT_LE(num_run, 4);
  EXPECT_THROW(team.For(
                   10, 1,
                   [](int, int, int, const ContinueCheck&) {
                     throw std::runtime_error("broken");
                   },
                   [](double) { return true; }),
               std::runtime_error);
  EXPECT_THROW(team.For(
                   10, 1, [](int, int, int, const ContinueCheck&) {},
                   [](double) -> bool { throw std::runtime_error("broken"); }),
               std::runtime_error);
  // A block that takes long hears of the stop.
  std::atomic<bool> stop{false};
  EXPECT_FALSE(team.For(
      2, 1,
      [&](int thread, int, int, const ContinueCheck& should_continue) {
        while (should_continue()) {
          if (thread == 0) {
            stop = true;
          }
        }
      },
      [&](double) { return !stop.load(); }));
  // The team works on.
  EXPECT_TRUE(team.For(
      5, 1, [](int, int, int, const ContinueCheck&) {},
      [](double) { return true; }));
}

}  // namespace
}  // namespace tapa
