#include "src/colmap/dense_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/pose.h"
#include "src/base/failure.h"

namespace tapa {
namespace {

// How far distortion moves the corners of a photograph, in pixels.
double Distortion(const colmap::Camera& camera) {
  const Eigen::Matrix3d calibration = camera.CalibrationMatrix();
  double largest = 0;
  for (const double x : {0.0, 1.0}) {
    for (const double y : {0.0, 1.0}) {
      const Eigen::Vector2d corner(x * static_cast<double>(camera.Width()),
                                   y * static_cast<double>(camera.Height()));
      const Eigen::Vector2d pinhole =
          (calibration * camera.ImageToWorld(corner).homogeneous()).head<2>();
      const double distance = (pinhole - corner).norm();
      largest =
          std::isfinite(distance) ? std::max(largest, distance) : HUGE_VAL;
    }
  }
  return largest;
}

}  // namespace

Eigen::Vector3d LocalOrigin(const colmap::Reconstruction& model) {
  // Single precision holds about seven digits.
  constexpr double kFar = 10;
  std::vector<Eigen::Vector3d> centers;
  for (const colmap::image_t id : model.RegImageIds()) {
    centers.push_back(model.Image(id).ProjectionCenter());
  }
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& center : centers) {
    middle += center / static_cast<double>(centers.size());
  }
  double spread = 0;
  for (const Eigen::Vector3d& center : centers) {
    spread = std::max(spread, (center - middle).norm());
  }
  if (middle.norm() <= kFar * spread) {
    return Eigen::Vector3d::Zero();
  }
  if (spread == 0) {
    return middle;
  }
  // On a grid, so that it stays when a view is added.
  const double step = std::exp2(std::ceil(std::log2(spread)));
  return (middle / step).array().round().matrix() * step;
}

Eigen::Vector3d PrepareDenseModel(const std::string& path,
                                  colmap::Reconstruction* model) {
  constexpr double kMaxDistortion = 0.5;  // Pixels.
  for (const colmap::image_t id : model->RegImageIds()) {
    const colmap::Image& image = model->Image(id);
    const colmap::Camera& camera = model->Camera(image.CameraId());
    if (Distortion(camera) > kMaxDistortion) {
      throw Failure("In the workspace " + path + " camera " +
                    std::to_string(image.CameraId()) + " of " + image.Name() +
                    " (" + camera.ModelName() +
                    ") has distortion, and dense stereo is for photographs "
                    "without; image_undistorter makes a workspace of such");
    }
  }
  const Eigen::Vector3d origin = LocalOrigin(*model);
  if (origin.isZero(0)) {
    return origin;
  }
  for (const colmap::image_t id : model->RegImageIds()) {
    colmap::Image& image = model->Image(id);
    image.Tvec() += colmap::QuaternionToRotationMatrix(image.Qvec()) * origin;
  }
  for (const auto& point : model->Points3D()) {
    model->Point3D(point.first).XYZ() -= origin;
  }
  return origin;
}

std::vector<int> NeighborsByCameras(const colmap::mvs::Model& model, int view,
                                    size_t max_num) {
  // Beyond that two views have little in common.
  constexpr float kMinCosine = 0.2f;
  const auto center = [&](int index) {
    Eigen::Vector3f position;
    const colmap::mvs::Image& image = model.images.at(index);
    colmap::mvs::ComputeProjectionCenter(image.GetR(), image.GetT(),
                                         position.data());
    return position;
  };
  const auto direction = [&](int index) {
    return Eigen::Vector3f(model.images.at(index).GetR() + 6);
  };
  std::vector<std::pair<float, int>> neighbors;
  for (int other = 0; other < static_cast<int>(model.images.size()); ++other) {
    const float cosine = direction(view).dot(direction(other));
    const float distance = (center(view) - center(other)).norm();
    if (other != view && cosine > kMinCosine && distance > 0) {
      neighbors.emplace_back(distance / (cosine * cosine), other);
    }
  }
  std::sort(neighbors.begin(), neighbors.end());
  std::vector<int> best;
  for (const auto& neighbor : neighbors) {
    if (best.size() == max_num) {
      break;
    }
    best.push_back(neighbor.second);
  }
  return best;
}

}  // namespace tapa
