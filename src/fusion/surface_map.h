#ifndef TAPA_SRC_FUSION_SURFACE_MAP_H_
#define TAPA_SRC_FUSION_SURFACE_MAP_H_

#include <cstdint>

#include "src/base/map.h"

namespace tapa {

// What a view sees at a pixel. Depth and normal are read together, so they lie
// side by side.
struct SurfacePixel {
  // Planar, in scene units; 0 where there is none.
  float depth = 0;
  // In the camera's frame, as PackNormal makes it.
  uint32_t normal = 0;
};

using SurfaceMap = Map<SurfacePixel>;

}  // namespace tapa

#endif  // TAPA_SRC_FUSION_SURFACE_MAP_H_
