#include "src/fusion/view_pair.h"

#include "src/base/angle.h"

namespace tapa {
namespace {

using Matrix = std::array<double, 9>;
using Vector = std::array<double, 3>;

Matrix Multiply(const Matrix& a, const Matrix& b) {
  Matrix product;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      product[3 * i + j] =
          a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
    }
  }
  return product;
}

Vector Multiply(const Matrix& a, const Vector& b) {
  return {a[0] * b[0] + a[1] * b[1] + a[2] * b[2],
          a[3] * b[0] + a[4] * b[1] + a[5] * b[2],
          a[6] * b[0] + a[7] * b[1] + a[8] * b[2]};
}

Matrix RelativeRotation(const Camera& from, const Camera& to) {
  const auto& R = from.R;
  return Multiply(to.R, {R[0], R[3], R[6], R[1], R[4], R[7], R[2], R[5], R[8]});
}

// How obliquely a surface may be seen: cosine times the length of the ray.
constexpr float kMinCosine = 0.05f;
// By how much the depth of a surface may change within a pixel.
constexpr float kMaxSlope = 0.1f;

}  // namespace

IndexCamera::IndexCamera(const Camera& camera)
    : inv_fx(1 / camera.fx),
      inv_fy(1 / camera.fy),
      cx(camera.cx - 0.5),
      cy(camera.cy - 0.5) {}

PixelTransfer::PixelTransfer(const Camera& from, const Camera& to) {
  const Matrix rotation = RelativeRotation(from, to);
  const Vector turned = Multiply(rotation, from.t);
  const Matrix K = {to.fx, 0, to.cx - 0.5, 0, to.fy, to.cy - 0.5, 0, 0, 1};
  const Matrix inverse_K = {
      1 / from.fx, 0,           -(from.cx - 0.5) / from.fx,
      0,           1 / from.fy, -(from.cy - 0.5) / from.fy,
      0,           0,           1};
  const Matrix a = Multiply(K, Multiply(rotation, inverse_K));
  const Vector c = Multiply(
      K, Vector{to.t[0] - turned[0], to.t[1] - turned[1], to.t[2] - turned[2]});
  std::copy(a.begin(), a.end(), A.begin());
  std::copy(c.begin(), c.end(), b.begin());
}

AgreementLimits::AgreementLimits(const FusionOptions& options) {
  const double depth = options.depth_error;
  const double reproj = options.reproj_error;
  const double normal = DegToRad(options.normal_error);
  depth_weight = 1 / (depth * depth);
  reproj_weight = 1 / (reproj * reproj);
  normal_weight = 1 / (normal * normal);
  max_depth_error = 3 * depth;
  doubt_depth = 3 * depth;
  doubt_squared_reproj = 1.5 * 1.5 * reproj * reproj;
  same_depth = 6 * depth;
  same_squared_reproj = 4 * 4 * reproj * reproj;
}

std::array<float, 9> ViewPair::Rotation(const Camera& from, const Camera& to) {
  const Matrix rotation = RelativeRotation(from, to);
  std::array<float, 9> result;
  std::copy(rotation.begin(), rotation.end(), result.begin());
  return result;
}

Opinion ViewPair::Ask(int row, int col, float depth, const Vec3& normal,
                      const SurfaceMap& other) const {
  Opinion opinion;
  int other_row, other_col;
  Vec3 seen;
  if (!Find(row, col, depth, other.width(), other.height(), &other_row,
            &other_col, &seen)) {
    return opinion;
  }
  const float other_depth = other.At(other_row, other_col).depth;
  // Something else stands before the point.
  if (!(other_depth > (1 - kMaxSlope - limits_.same_depth) * seen.z)) {
    return opinion;
  }

  // The other surface as a plane, met by the ray to the point and by the
  // pixel's.
  const Vec3 other_normal = UnpackNormal(other.At(other_row, other_col).normal);
  const Vec3 other_ray = other_camera_.Ray(other_col, other_row);
  const Vec3 ray = other_camera_.Ray(seen.x, seen.y);
  const float distance = Dot(other_normal, other_ray);
  const float slant = Dot(other_normal, ray);
  float ratio = 1;
  if (distance < -kMinCosine && slant < -kMinCosine &&
      std::abs(distance - slant) < -kMaxSlope * slant) {
    ratio = distance / slant;
  }
  const float met_depth = other_depth * ratio;
  const float behind = met_depth / seen.z - 1;
  const Vec3 back = from_other_.Apply(seen.x, seen.y, met_depth);
  const float inv_z = 1 / back.z;
  const float dx = back.x * inv_z - col;
  const float dy = back.y * inv_z - row;
  const float squared_reproj = dx * dx + dy * dy;
  opinion.doubts = behind > limits_.doubt_depth &&
                   !(squared_reproj < limits_.doubt_squared_reproj);
  if (!(squared_reproj < limits_.same_squared_reproj)) {
    return opinion;
  }

  const float cosine = Dot(other_normal, Rotate(camera_.Ray(col, row)));
  if (!(cosine < -kMinCosine)) {
    return opinion;
  }
  const float gap = other_depth * distance - seen.z * slant;
  const float offset = gap / (cosine * depth);
  opinion.is_same = std::abs(offset) < limits_.same_depth;
  if (!(std::abs(offset) < limits_.max_depth_error)) {
    return opinion;
  }
  opinion.normal = RotateBack(other_normal);
  // |a - b|^2 of two directions, close to the angle's square.
  const float squared_angle = 2 * (1 - Dot(opinion.normal, normal));
  const float errors = offset * offset * limits_.depth_weight +
                       squared_reproj * limits_.reproj_weight +
                       squared_angle * limits_.normal_weight;
  opinion.agreement = std::exp(-0.5f * errors);
  opinion.depth_offset = offset;
  const float detail = focal_ratio_ * depth / seen.z;
  opinion.precision = detail * detail;
  return opinion;
}

}  // namespace tapa
