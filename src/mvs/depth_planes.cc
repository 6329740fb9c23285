#include "src/mvs/depth_planes.h"

#include <algorithm>
#include <cmath>

#include "src/base/depth.h"

namespace tapa {
namespace {

// Of the window that a plane is fitted in, in samples.
constexpr int kRadius = 2;
// Tangent of the angle between a normal and its ray up to which a slope is none
// of the edges between surfaces.
constexpr double kSteepest = 10;
// Little next to the square of the distance of two samples; what has one
// solution keeps it.
constexpr double kRidge = 1e-3;

}  // namespace

DepthPlanes::Axis::Axis(int image_size, int depth_size)
    : size(depth_size),
      scale(static_cast<double>(depth_size) / image_size),
      step(std::max(1, static_cast<int>(std::lround(scale)))) {}

int DepthPlanes::Axis::ToDepth(int index) const {
  return std::min(size - 1, static_cast<int>((index + 0.5) * scale));
}

// Least squares of w = a + b x + c y.
class DepthPlanes::SlopeFit {
 public:
  void Add(double x, double y, double w) {
    n_ += 1;
    x_ += x;
    y_ += y;
    w_ += w;
    xx_ += x * x;
    xy_ += x * y;
    yy_ += y * y;
    xw_ += x * w;
    yw_ += y * w;
  }

  // ridge: what is added to the squares, so that samples in a line have no
  // slope to either side of it.
  void Solve(double ridge, double* a, double* b, double* c) const {
    const double xx = xx_ - x_ * x_ / n_ + ridge;
    const double xy = xy_ - x_ * y_ / n_;
    const double yy = yy_ - y_ * y_ / n_ + ridge;
    const double xw = xw_ - x_ * w_ / n_;
    const double yw = yw_ - y_ * w_ / n_;
    const double determinant = xx * yy - xy * xy;
    *b = (yy * xw - xy * yw) / determinant;
    *c = (xx * yw - xy * xw) / determinant;
    *a = (w_ - *b * x_ - *c * y_) / n_;
  }

 private:
  double n_ = 0, x_ = 0, y_ = 0, w_ = 0;
  double xx_ = 0, xy_ = 0, yy_ = 0, xw_ = 0, yw_ = 0;
};

DepthPlanes::DepthPlanes(const Map<float>& depth, const RefCamera& camera,
                         int width, int height)
    : depth_(depth),
      camera_(camera),
      rows_(height, depth.height()),
      cols_(width, depth.width()) {}

// On a plane the inverse of the depth is linear in the pixel's position, so
// that is what is fitted.
DepthNormal DepthPlanes::At(int row, int col) const {
  const int depth_row = rows_.ToDepth(row);
  const int depth_col = cols_.ToDepth(col);
  if (!IsDepth(depth_.At(depth_row, depth_col))) {
    return DepthNormal();
  }
  double a, b, c;
  FitAround(depth_row, depth_col, row, col)
      .Solve(kRidge / (rows_.scale * cols_.scale), &a, &b, &c);
  const Vec3 ray = camera_.Ray(row, col);
  // w = across u + down v + forward at the ray (u, v, 1).
  const double across = b / camera_.inv_fx;
  const double down = c / camera_.inv_fy;
  const double forward = a - across * ray.x - down * ray.y;
  const double length =
      std::sqrt(across * across + down * down + forward * forward);
  const auto component = [length](double value) {
    return static_cast<float>(-value / length);
  };
  return {static_cast<float>(1 / a),
          {component(across), component(down), component(forward)}};
}

// Inverse depths, with positions relative to pixel (row, col) of the image.
DepthPlanes::SlopeFit DepthPlanes::FitAround(int depth_row, int depth_col,
                                             int row, int col) const {
  const double center = 1.0 / depth_.At(depth_row, depth_col);
  const double x0 = cols_.ToImage(depth_col);
  const double y0 = rows_.ToImage(depth_row);
  SlopeFit fit;
  for (int i = -kRadius; i <= kRadius; ++i) {
    const int other_row = depth_row + i * rows_.step;
    if (other_row < 0 || other_row >= rows_.size) {
      continue;
    }
    const double y = rows_.ToImage(other_row);
    for (int j = -kRadius; j <= kRadius; ++j) {
      const int other_col = depth_col + j * cols_.step;
      if (other_col < 0 || other_col >= cols_.size ||
          !IsDepth(depth_.At(other_row, other_col))) {
        continue;
      }
      const double x = cols_.ToImage(other_col);
      const double w = 1.0 / depth_.At(other_row, other_col);
      const double angle =
          std::hypot((x - x0) * camera_.inv_fx, (y - y0) * camera_.inv_fy);
      if (std::abs(w - center) <= kSteepest * angle * center) {
        fit.Add(x - col, y - row, w);
      }
    }
  }
  return fit;
}

}  // namespace tapa
