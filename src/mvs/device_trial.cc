#include "src/mvs/device_trial.h"

#include <array>
#include <cmath>
#include <vector>

#include "src/mvs/device_error.h"
#include "src/mvs/estimate_depth.h"
#include "src/mvs/sweep/random.h"

namespace tapa {
namespace {

// A wall with a random texture, which cameras side by side see face to face.
class TrialScene {
 public:
  TrialScene() {
    for (size_t m = 0; m < kOffsets.size(); ++m) {
      images_.push_back(Render(kOffsets[m]));
    }
    for (size_t m = 0; m < kOffsets.size(); ++m) {
      View view;
      view.camera.fx = view.camera.fy = kFocalLength;
      view.camera.cx = kWidth / 2;
      view.camera.cy = kHeight / 2;
      view.camera.t = {-kOffsets[m][0], -kOffsets[m][1], 0};
      view.image = &images_[m];
      if (m == 0) {
        problem_.reference = view;
      } else {
        problem_.sources.push_back(view);
      }
    }
    problem_.depth_min = 0.5f * kDepth;
    problem_.depth_max = 2.0f * kDepth;
  }

  const Problem& problem() const { return problem_; }

 private:
  static constexpr float kDepth = 2;
  static constexpr int kWidth = 48;
  static constexpr int kHeight = 32;
  static constexpr double kFocalLength = 60;
  // Cells of the texture per unit of length: about 3 pixels each.
  static constexpr double kCellsPerUnit = 10;
  // Of the cameras, in scene units, to the right and down; the first is the
  // reference.
  static constexpr std::array<std::array<double, 2>, 5> kOffsets = {
      {{0, 0}, {0.2, 0}, {-0.21, 0.01}, {0, 0.19}, {0.02, -0.2}}};

  // Grey value of the wall.
  static double Texture(double x, double y) {
    const double u = kCellsPerUnit * x;
    const double v = kCellsPerUnit * y;
    const auto cell = [&](int i, int j) {
      const auto index = [](double place, int step) {
        // The wall lies around the origin.
        return static_cast<uint32_t>(std::floor(place) + step + 1000);
      };
      return 255 * Random(1, index(u, i), index(v, j)).Uniform(0);
    };
    const double a = u - std::floor(u);
    const double b = v - std::floor(v);
    return (1 - b) * ((1 - a) * cell(0, 0) + a * cell(1, 0)) +
           b * ((1 - a) * cell(0, 1) + a * cell(1, 1));
  }

  static Map<uint8_t> Render(const std::array<double, 2>& offset) {
    Map<uint8_t> image(kWidth, kHeight);
    for (int row = 0; row < kHeight; ++row) {
      for (int col = 0; col < kWidth; ++col) {
        const double x =
            offset[0] + kDepth * (col + 0.5 - kWidth / 2) / kFocalLength;
        const double y =
            offset[1] + kDepth * (row + 0.5 - kHeight / 2) / kFocalLength;
        image.At(row, col) = static_cast<uint8_t>(Texture(x, y) + 0.5);
      }
    }
    return image;
  }

  std::vector<Map<uint8_t>> images_;
  Problem problem_;
};

// Percentage of the pixels where two maps are the same to one per cent.
int PercentageSame(const Map<float>& actual, const Map<float>& expected) {
  size_t count = 0;
  for (size_t i = 0; i < expected.size(); ++i) {
    count += std::abs(actual.data()[i] / expected.data()[i] - 1) < 0.01f;
  }
  return static_cast<int>(100 * count / expected.size());
}

// A few sweeps with the kernel that these options take.
Options TrialOptions(const Options& wanted) {
  Options options;
  options.window_radius = wanted.window_radius;
  options.window_step = wanted.window_step;
  options.num_threads = wanted.num_threads;
  options.geom_consistency = false;
  options.filter = false;
  options.num_iterations = 1;
  return options;
}

}  // namespace

std::string TryDevice(int device, const Options& wanted,
                      const std::function<bool()>& stopped) {
  Options options = TrialOptions(wanted);
  const TrialScene scene;
  Control control;
  control.stopped = stopped;
  const auto expected = EstimateDepth(options, scene.problem(), control);
  options.device = device;
  try {
    const auto actual = EstimateDepth(options, scene.problem(), control);
    if (!expected || !actual) {
      return "";
    }
    // Both make the same random draws. Where rounding lets one choose another
    // plane, it spreads to pixels that look at it.
    constexpr int kEnough = 80;
    const int same = PercentageSame(actual->depth, expected->depth);
    if (same < kEnough) {
      return "of a small test it computes " + std::to_string(same) +
             " % of the pixels as the CPU does";
    }
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "";
}

}  // namespace tapa
