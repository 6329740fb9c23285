#include "src/mvs/camera_table.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>

namespace tapa {
namespace {

using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

// Intrinsics that take rays to (col, row) rather than to (x, y) = (col + 0.5,
// row + 0.5). The only place that knows of the half pixel: all that sweeps and
// TAPA compute with indices of pixels follows from here.
Matrix3 IndexIntrinsics(const Camera& camera) {
  Matrix3 K;
  K << camera.fx, 0, camera.cx - 0.5, 0, camera.fy, camera.cy - 0.5, 0, 0, 1;
  return K;
}

Eigen::Map<const Matrix3> Rotation(const Camera& camera) {
  return Eigen::Map<const Matrix3>(camera.R.data());
}

Eigen::Map<const Eigen::Vector3d> Translation(const Camera& camera) {
  return Eigen::Map<const Eigen::Vector3d>(camera.t.data());
}

}  // namespace

RefCamera MakeRefCamera(const Camera& camera) {
  const Matrix3 inverse_K = IndexIntrinsics(camera).inverse();
  RefCamera result;
  result.inv_fx = static_cast<float>(inverse_K(0, 0));
  result.inv_fy = static_cast<float>(inverse_K(1, 1));
  result.offset_x = static_cast<float>(inverse_K(0, 2));
  result.offset_y = static_cast<float>(inverse_K(1, 2));
  return result;
}

CameraTable::CameraTable(const Problem& problem)
    : reference_(MakeRefCamera(problem.reference.camera)) {
  const Camera& ref = problem.reference.camera;
  const Matrix3 K = IndexIntrinsics(ref);
  const Matrix3 inverse_K = K.inverse();

  count_ = static_cast<int>(problem.sources.size());
  padded_count_ = (count_ + SourceCameras::kPadding - 1) /
                  SourceCameras::kPadding * SourceCameras::kPadding;
  coefficients_.resize(static_cast<size_t>(SourceCameras::kNumCoefficients) *
                       padded_count_);

  for (int m = 0; m < padded_count_; ++m) {
    const View& view = problem.sources[m < count_ ? m : 0];
    const Matrix3 K_m = IndexIntrinsics(view.camera);
    const Matrix3 R = Rotation(view.camera) * Rotation(ref).transpose();
    const Eigen::Vector3d t = Translation(view.camera) - R * Translation(ref);
    const Eigen::Vector3d C = -R.transpose() * t;
    const Matrix3 A = K_m * R * inverse_K;
    const Matrix3 B = K * R.transpose() * K_m.inverse();
    const Eigen::Vector3d b = K_m * t;
    const Eigen::Vector3d g = K * C;

    float* to = coefficients_.data() + m;
    const auto put = [&](double value) {
      *to = static_cast<float>(value);
      to += padded_count_;
    };
    std::for_each(A.data(), A.data() + 9, put);
    std::for_each(b.data(), b.data() + 3, put);
    std::for_each(B.data(), B.data() + 9, put);
    std::for_each(g.data(), g.data() + 3, put);
    std::for_each(C.data(), C.data() + 3, put);
    put(m < count_ ? 1 : 0);
  }
}

SourceCameras CameraTable::sources() const {
  return ArrangeCameras(coefficients_.data(), padded_count_, count_,
                        padded_count_);
}

}  // namespace tapa
