#include "src/mvs/levels.h"

#include <algorithm>
#include <cstdint>

#include "src/base/depth.h"
#include "src/mvs/camera_table.h"

namespace tapa {
namespace {

// Smaller images show too little: windows of 11 pixels cover whole objects.
constexpr int kMinLongestSide = 256;

// The index, of `count`, of the coarse pixel that the centre of a fine one lies
// in. Exact, as integers.
int IndexAt(int fine, int fine_count, int count) {
  return static_cast<int>((2 * static_cast<int64_t>(fine) + 1) * count /
                          (2 * static_cast<int64_t>(fine_count)));
}

}  // namespace

int LongestSideAtLevel(int longest_side, int level) {
  const int reduced =
      level > 30 ? 0 : static_cast<int>(longest_side / (1ll << level));
  return std::min(longest_side, std::max(reduced, kMinLongestSide));
}

int AutomaticNumLevels(int longest_side) {
  int levels = 1;
  while ((longest_side >> levels) >= kMinLongestSide) {
    ++levels;
  }
  return levels;
}

DepthNormalMaps HandUp(const DepthNormalMaps& estimate, const Camera& coarse,
                       const View& fine) {
  const int width = fine.image->width();
  const int height = fine.image->height();
  const RefCamera coarse_rays = MakeRefCamera(coarse);
  const RefCamera fine_rays = MakeRefCamera(fine.camera);
  DepthNormalMaps result = {Map<float>(width, height),
                            Map<Vec3>(width, height)};
  for (int row = 0; row < height; ++row) {
    const int from_row = IndexAt(row, height, estimate.depth.height());
    for (int col = 0; col < width; ++col) {
      const int from_col = IndexAt(col, width, estimate.depth.width());
      const float depth = estimate.depth.At(from_row, from_col);
      const Vec3& normal = estimate.normal.At(from_row, from_col);
      const float distance =
          depth * Dot(normal, coarse_rays.Ray(from_row, from_col));
      const float slope = Dot(normal, fine_rays.Ray(row, col));
      const float fine_depth = distance / slope;
      // A pixel's width away a depth that differs by half is none of the
      // surface that the coarse pixel saw.
      if (IsDepth(depth) && slope < 0 && fine_depth > 0.5f * depth &&
          fine_depth < 2.0f * depth) {
        result.depth.At(row, col) = fine_depth;
        result.normal.At(row, col) = normal;
      }
    }
  }
  return result;
}

Map<float> ReduceDepth(const Map<float>& depth, int width, int height) {
  Map<float> result(width, height);
  for (int row = 0; row < height; ++row) {
    const int from_row = IndexAt(row, height, depth.height());
    for (int col = 0; col < width; ++col) {
      result.At(row, col) =
          depth.At(from_row, IndexAt(col, width, depth.width()));
    }
  }
  return result;
}

}  // namespace tapa
