#ifndef TAPA_TESTS_MVS_SYNTHETIC_H_
#define TAPA_TESTS_MVS_SYNTHETIC_H_

#include <random>
#include <vector>

#include "src/mvs/problem.h"

namespace tapa {

// Small scenes with known depth for tests.

// What tests on the emulated GPU, which is slow, multiply the width and height
// of their scenes by: TAPA_SCENE_SCALE of the environment, 1 without it.
double SceneScale();

struct SyntheticOptions {
  int width = 48;
  int height = 40;
  int num_sources = 4;
  // Distance of the surface along the reference camera's optical axis.
  double depth = 4.0;
  // Its unnormalized normal in the reference camera's frame.
  double normal[3] = {0.2, -0.1, -1.0};
  double focal_length = 60.0;
  // Spread of the source cameras' centres around the reference camera.
  double baseline = 0.6;
  // Rotation of the source cameras about their optical axes, in radians, on top
  // of a small one at random.
  double roll = 0;
  // Size of the images, in pixels, that photographs of width x height are
  // scaled to; 0: as they are.
  int scaled_width = 0;
  int scaled_height = 0;
  // Half width of a stripe without texture, in scene units: a wall in the
  // middle of the reference image, from its upper to its lower border. 0: none.
  double wall = 0;
  // Noise of every pixel, up to this many steps of intensity up or down.
  int noise = 0;
  unsigned seed = 1;
};

// A textured plane seen by a reference camera and several source cameras that
// are turned, moved and zoomed at random. Owns what `problem` points to.
class SyntheticPlane {
 public:
  explicit SyntheticPlane(const SyntheticOptions& options);

  const Problem& problem() const { return problem_; }
  // True depth of the reference view, and its true normal.
  const Map<float>& depth() const { return depths_[0]; }
  Vec3 normal() const { return normal_; }
  // 1 where the reference view sees the stripe without texture.
  const Map<uint8_t>& wall() const { return wall_; }

  // The problem of the geometric pass with the true maps as input.
  Problem GeometricProblem() const;

 private:
  Problem problem_;
  Vec3 normal_;
  Map<uint8_t> wall_;
  // Of the reference view first, then of the source views.
  std::vector<Map<uint8_t>> images_;
  std::vector<Map<float>> depths_;
};

// Noise, independent from pixel to pixel.
Map<uint8_t> RandomImage(int width, int height, std::mt19937* random);

// Whether all that is known of a view is the same, bit for bit.
bool Same(const Estimate& a, const Estimate& b);

}  // namespace tapa

#endif  // TAPA_TESTS_MVS_SYNTHETIC_H_
