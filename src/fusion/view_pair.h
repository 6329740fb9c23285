#ifndef TAPA_SRC_FUSION_VIEW_PAIR_H_
#define TAPA_SRC_FUSION_VIEW_PAIR_H_

#include <algorithm>
#include <array>
#include <cmath>

#include "src/base/depth.h"
#include "src/base/vec3.h"
#include "src/fusion/options.h"
#include "src/fusion/packed_normal.h"
#include "src/fusion/surface_map.h"
#include "src/mvs/view.h"

namespace tapa {

// Camera for indices of pixels: the ray of pixel (row, col) is that of x = col,
// y = row, so the principal point is half a pixel less than in Camera.
struct IndexCamera {
  explicit IndexCamera(const Camera& camera);

  // Direction in the camera's frame, with z = 1.
  Vec3 Ray(float x, float y) const {
    return {(x - cx) * inv_fx, (y - cy) * inv_fy, 1};
  }

  float inv_fx, inv_fy, cx, cy;
};

// (x, y, depth) of one view, in pixels and scene units, to those of another:
// (depth' x', depth' y', depth') = depth A (x, y, 1) + b.
struct PixelTransfer {
  PixelTransfer(const Camera& from, const Camera& to);

  // Returns (depth' x', depth' y', depth').
  Vec3 Apply(float x, float y, float depth) const {
    return {depth * (A[0] * x + A[1] * y + A[2]) + b[0],
            depth * (A[3] * x + A[4] * y + A[5]) + b[1],
            depth * (A[6] * x + A[7] * y + A[8]) + b[2]};
  }

  std::array<float, 9> A;
  std::array<float, 3> b;
};

// The errors at which views agree, see through a point, and see the same point.
struct AgreementLimits {
  explicit AgreementLimits(const FusionOptions& options);

  // 1 / standard deviation^2 of relative depth, pixels, radians.
  float depth_weight, reproj_weight, normal_weight;
  // Relative depth at which agreement ends.
  float max_depth_error;
  // Relative depth and pixels, squared, from which a view sees through.
  float doubt_depth, doubt_squared_reproj;
  // Relative depth and pixels, squared, up to which it is the same point that
  // is seen, if with errors.
  float same_depth, same_squared_reproj;
};

// What a view says of a pixel of another.
struct Opinion {
  // 0: none, to 1.
  float agreement = 0;
  // Where the surface of that view meets the pixel's ray: relative to the
  // pixel's depth, less 1. Set where there is agreement.
  float depth_offset = 0;
  // How precise that view is, relative to the pixel's: 1 / variance of its
  // depth there, which grows with the square of what a pixel covers.
  float precision = 1;
  // Its normal in the frame of the pixel's view. Set where there is agreement.
  Vec3 normal;
  // It sees through the pixel's point.
  bool doubts = false;
  // Its own pixel shows no other point.
  bool is_same = false;
};

// A view whose pixels are judged, and one that is asked.
class ViewPair {
 public:
  ViewPair(const Camera& view, const Camera& other,
           const AgreementLimits& limits)
      : camera_(view),
        other_camera_(other),
        to_other_(view, other),
        from_other_(other, view),
        rotation_(Rotation(view, other)),
        focal_ratio_(static_cast<float>(other.fx / view.fx)),
        limits_(limits) {}

  // The pixel of the other view that sees the point at a depth. Returns whether
  // there is one. seen: (x, y, depth) there.
  bool Find(int row, int col, float depth, int width, int height,
            int* other_row, int* other_col, Vec3* seen) const {
    const Vec3 p = to_other_.Apply(col, row, depth);
    if (!(p.z > 0)) {
      return false;
    }
    const float inv_z = 1 / p.z;
    *seen = {p.x * inv_z, p.y * inv_z, p.z};
    if (!(seen->x >= -0.5f && seen->y >= -0.5f && seen->x < width - 0.5f &&
          seen->y < height - 0.5f)) {
      return false;
    }
    *other_col = std::min(static_cast<int>(seen->x + 0.5f), width - 1);
    *other_row = std::min(static_cast<int>(seen->y + 0.5f), height - 1);
    return true;
  }

  // depth, normal: of the pixel, in its view's frame.
  Opinion Ask(int row, int col, float depth, const Vec3& normal,
              const SurfaceMap& other) const;

 private:
  static std::array<float, 9> Rotation(const Camera& from, const Camera& to);

  Vec3 Rotate(const Vec3& v) const {
    const auto& R = rotation_;
    return {R[0] * v.x + R[1] * v.y + R[2] * v.z,
            R[3] * v.x + R[4] * v.y + R[5] * v.z,
            R[6] * v.x + R[7] * v.y + R[8] * v.z};
  }
  Vec3 RotateBack(const Vec3& v) const {
    const auto& R = rotation_;
    return {R[0] * v.x + R[3] * v.y + R[6] * v.z,
            R[1] * v.x + R[4] * v.y + R[7] * v.z,
            R[2] * v.x + R[5] * v.y + R[8] * v.z};
  }

  const IndexCamera camera_;
  const IndexCamera other_camera_;
  const PixelTransfer to_other_;
  const PixelTransfer from_other_;
  // From the view's frame to the other's.
  const std::array<float, 9> rotation_;
  // Focal length in pixels of the other view by that of the view.
  const float focal_ratio_;
  const AgreementLimits limits_;
};

}  // namespace tapa

#endif  // TAPA_SRC_FUSION_VIEW_PAIR_H_
