#include "src/mvs/device_trial.h"

#include <array>
#include <cmath>
#include <vector>

#include "src/mvs/devices.h"
#include "src/mvs/estimate_depth.h"
#include "src/mvs/random.h"

namespace tapa {
namespace {

// A wall with a random texture, which cameras side by side see face to face.
class TrialScene {
 public:
  static constexpr float kDepth = 2;

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
        const double x = offset[0] + kDepth * (col - kWidth / 2) / kFocalLength;
        const double y =
            offset[1] + kDepth * (row - kHeight / 2) / kFocalLength;
        image.At(row, col) = static_cast<uint8_t>(Texture(x, y) + 0.5);
      }
    }
    return image;
  }

  std::vector<Map<uint8_t>> images_;
  Problem problem_;
};

// Percentage of the pixels whose depth is right to one per cent.
int PercentageRight(const Options& options, const Problem& problem) {
  const auto estimate = EstimateDepth(options, problem);
  size_t count = 0;
  for (size_t i = 0; i < estimate->depth.size(); ++i) {
    count +=
        std::abs(estimate->depth.data()[i] / TrialScene::kDepth - 1) < 0.01;
  }
  return static_cast<int>(100 * count / estimate->depth.size());
}

}  // namespace

std::string TryDevice(int device, Options options) {
  // What a GPU computes are the sweeps.
  options.geom_consistency = false;
  options.tapa.enabled = false;
  options.filter = false;
  options.num_iterations = 2;
  const TrialScene scene;
  options.device = -1;
  const int expected = PercentageRight(options, scene.problem());
  options.device = device;
  try {
    const int actual = PercentageRight(options, scene.problem());
    // Rounding makes a difference of about one per cent.
    constexpr int kTolerance = 5;
    if (actual < expected - kTolerance) {
      return "it computes wrongly: of a small test it gets " +
             std::to_string(actual) + " % right, the CPU " +
             std::to_string(expected) + " %";
    }
  } catch (const DeviceError& error) {
    return std::string("it does not work: ") + error.what();
  }
  return "";
}

}  // namespace tapa
