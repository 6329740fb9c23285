#ifndef TAPA_SRC_FUSION_FUSED_CLOUD_H_
#define TAPA_SRC_FUSION_FUSED_CLOUD_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/base/map.h"
#include "src/base/vec3.h"

namespace tapa {

// A point of the scene that a pixel of one view and others show; 32 bytes, as
// there are millions.
struct FusedPoint {
  // In scene units, in the world's frame.
  Vec3 position;
  // In the world's frame, as PackNormal makes it.
  uint32_t normal = 0;
  // Of the pixel.
  Rgb color;
  // Agreement less doubt, in views.
  float confidence = 0;
  // Bit n: neighbour n of the pixel's view sees it, too.
  uint64_t visible = 0;
};

// The points of the pixels of one view, in row-major order.
struct FusedView {
  int view = 0;
  // The views that the bits of FusedPoint::visible stand for.
  std::vector<int> neighbors;
  std::vector<FusedPoint> points;
};

struct FusedCloud {
  // In the order in which views were fused.
  std::vector<FusedView> views;

  size_t NumPoints() const {
    size_t count = 0;
    for (const auto& view : views) {
      count += view.points.size();
    }
    return count;
  }
};

}  // namespace tapa

#endif  // TAPA_SRC_FUSION_FUSED_CLOUD_H_
