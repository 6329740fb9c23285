#include "tests/mvs/synthetic.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace tapa {
namespace {

// Smooth texture with detail at several scales, 0 to 255.
uint8_t Texture(double x, double y) {
  double value = 0;
  for (int octave = 0; octave < 4; ++octave) {
    const double f = 1.7 * std::pow(1.9, octave);
    value += std::sin(f * x + 1.3 * octave) * std::cos(f * y - 0.7 * octave) +
             0.5 * std::sin(f * (x + y) * 0.8 + octave);
  }
  return static_cast<uint8_t>(std::clamp(128.0 + 28.0 * value, 0.0, 255.0));
}

void AddNoise(int amplitude, std::mt19937* random, Map<uint8_t>* image) {
  std::uniform_int_distribution<int> noise(-amplitude, amplitude);
  for (size_t i = 0; i < image->size(); ++i) {
    image->data()[i] = static_cast<uint8_t>(
        std::clamp(image->data()[i] + noise(*random), 0, 255));
  }
}

Camera RandomCamera(const SyntheticOptions& options, bool reference,
                    std::mt19937* random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  Camera camera;
  const double zoom = reference ? 1 : 1 + 0.1 * uniform(*random);
  camera.fx = options.focal_length * zoom;
  camera.fy = 1.02 * options.focal_length * zoom;
  camera.cx = 0.5 * options.width + 1.5;
  camera.cy = 0.5 * options.height - 0.5;
  // The world is the reference camera's frame, moved and turned a bit.
  const double angle = reference ? 0 : 0.08;
  const double roll = reference ? 0 : options.roll;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()) *
      (Eigen::AngleAxisd(angle * uniform(*random), Eigen::Vector3d::UnitX()) *
       Eigen::AngleAxisd(angle * uniform(*random), Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(angle * uniform(*random), Eigen::Vector3d::UnitZ()))
          .toRotationMatrix();
  const Eigen::Matrix3d world =
      Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized())
          .toRotationMatrix();
  const Eigen::Vector3d origin(0.5, -0.3, 0.2);
  const Eigen::Vector3d center =
      reference ? Eigen::Vector3d::Zero().eval()
                : (options.baseline * Eigen::Vector3d(uniform(*random),
                                                      uniform(*random),
                                                      0.3 * uniform(*random)))
                      .eval();
  const Eigen::Matrix3d R = turn * world;
  const Eigen::Vector3d t = turn * (origin - center);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      camera.R[3 * i + j] = R(i, j);
    }
    camera.t[i] = t(i);
  }
  if (reference) {
    for (int i = 0; i < 3; ++i) {
      camera.t[i] = origin(i);
    }
  }
  return camera;
}

// The camera of a photograph that is scaled.
Camera Scaled(Camera camera, double scale_x, double scale_y) {
  camera.fx *= scale_x;
  camera.cx *= scale_x;
  camera.fy *= scale_y;
  camera.cy *= scale_y;
  return camera;
}

}  // namespace

double SceneScale() {
  const char* scale = std::getenv("TAPA_SCENE_SCALE");
  return scale == nullptr ? 1 : std::atof(scale);
}

SyntheticPlane::SyntheticPlane(const SyntheticOptions& options) {
  std::mt19937 random(options.seed);
  const int num_views = options.num_sources + 1;
  const int width =
      options.scaled_width > 0 ? options.scaled_width : options.width;
  const int height =
      options.scaled_height > 0 ? options.scaled_height : options.height;
  std::vector<Camera> cameras;
  for (int i = 0; i < num_views; ++i) {
    cameras.push_back(Scaled(RandomCamera(options, i == 0, &random),
                             static_cast<double>(width) / options.width,
                             static_cast<double>(height) / options.height));
  }

  using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const Eigen::Vector3d n =
      Eigen::Vector3d(options.normal[0], options.normal[1], options.normal[2])
          .normalized();
  const Eigen::Vector3d anchor(0, 0, options.depth);
  normal_ = {static_cast<float>(n(0)), static_cast<float>(n(1)),
             static_cast<float>(n(2))};
  const Eigen::Map<const Matrix> R_ref(cameras[0].R.data());
  const Eigen::Map<const Eigen::Vector3d> t_ref(cameras[0].t.data());

  constexpr uint8_t kWallIntensity = 150;
  wall_ = Map<uint8_t>(width, height, 0);
  for (const Camera& camera : cameras) {
    const Eigen::Map<const Matrix> R(camera.R.data());
    const Eigen::Map<const Eigen::Vector3d> t(camera.t.data());
    // From this camera's frame to the reference camera's.
    const Eigen::Matrix3d to_ref = R_ref * R.transpose();
    const Eigen::Vector3d center = t_ref - to_ref * t;
    Map<uint8_t> image(width, height);
    Map<float> depth(width, height);
    for (int row = 0; row < height; ++row) {
      for (int col = 0; col < width; ++col) {
        const Eigen::Vector3d ray =
            to_ref * Eigen::Vector3d((col + 0.5 - camera.cx) / camera.fx,
                                     (row + 0.5 - camera.cy) / camera.fy, 1);
        const double d = n.dot(anchor - center) / n.dot(ray);
        const Eigen::Vector3d point = center + d * ray;
        depth.At(row, col) = static_cast<float>(d);
        const bool on_wall = std::abs(point(0)) < options.wall;
        image.At(row, col) =
            on_wall ? kWallIntensity : Texture(1.6 * point(0), 1.6 * point(1));
        if (images_.empty()) {
          wall_.At(row, col) = on_wall;
        }
      }
    }
    if (options.noise > 0) {
      AddNoise(options.noise, &random, &image);
    }
    images_.push_back(std::move(image));
    depths_.push_back(std::move(depth));
  }

  problem_.reference = {cameras[0], &images_[0], nullptr};
  for (int i = 1; i < num_views; ++i) {
    problem_.sources.push_back({cameras[i], &images_[i], nullptr});
  }
  problem_.depth_min = static_cast<float>(0.5 * options.depth);
  problem_.depth_max = static_cast<float>(2.0 * options.depth);
}

Problem SyntheticPlane::GeometricProblem() const {
  Problem problem = problem_;
  for (size_t m = 0; m < problem.sources.size(); ++m) {
    problem.sources[m].depth = &depths_[m + 1];
  }
  problem.depth = depths_[0];
  problem.normal = Map<Vec3>(depths_[0].width(), depths_[0].height(), normal_);
  return problem;
}

Map<uint8_t> RandomImage(int width, int height, std::mt19937* random) {
  std::uniform_int_distribution<int> uniform(0, 255);
  Map<uint8_t> image(width, height);
  std::generate_n(image.data(), image.size(), [&] { return uniform(*random); });
  return image;
}

bool Same(const Estimate& a, const Estimate& b) {
  return std::memcmp(a.depth.data(), b.depth.data(),
                     a.depth.size() * sizeof(float)) == 0 &&
         std::memcmp(a.normal.data(), b.normal.data(),
                     a.normal.size() * sizeof(Vec3)) == 0 &&
         a.selection_prob == b.selection_prob && a.consistent == b.consistent;
}

}  // namespace tapa
