#ifndef TAPA_SRC_MVS_SWEEP_GUIDE_H_
#define TAPA_SRC_MVS_SWEEP_GUIDE_H_

#include <cstddef>
#include <cstdint>

#include "src/mvs/sweep/packed_depth_normal.h"
#include "src/mvs/sweep/plane.h"
#include "src/mvs/sweep/texture_weights.h"

namespace tapa {

// What a pixel brings to the sweep from outside.
struct PixelGuide {
  TextureWeights weights;
  // Further hypotheses; depth 0: none.
  DepthNormal depth_prior;
  DepthNormal fine;
  DepthNormal coarse;
};

// A PlaneSet as sweeps read it.
struct PlaneTable {
  static constexpr uint16_t kNone = 0xFFFF;

  const Plane* planes = nullptr;
  // Which plane each pixel tries, or kNone; nullptr: no pixel tries any.
  const uint16_t* index = nullptr;
};

// What comes to sweeps from outside and changes between them, for all pixels. T
// is the type that textureness is stored in.
template <typename T>
struct SweepGuide {
  // nullptr: costs are not weighted.
  const T* textureness = nullptr;
  float weight_range = 0;
  // Planes outside this range of depths are no hypotheses, in scene units.
  float depth_min = 0;
  float depth_max = 0;
  PlaneTable fine;
  PlaneTable coarse;
  // Depth from elsewhere; nullptr: none of any pixel.
  const PackedDepthNormal* depth_prior = nullptr;

  // with_planes: whether the planes are hypotheses, too.
  TAPA_INLINE PixelGuide At(size_t pixel, const Vec3& ray,
                            bool with_planes) const {
    PixelGuide guide;
    if (textureness != nullptr) {
      guide.weights = TextureWeights::FromTextureness(
          DecodeTextureness(textureness[pixel]), weight_range);
    }
    if (depth_prior != nullptr) {
      guide.depth_prior = Unpack(depth_prior[pixel]);
    }
    if (with_planes) {
      guide.fine = HypothesisOf(fine, pixel, ray);
      guide.coarse = HypothesisOf(coarse, pixel, ray);
    }
    return guide;
  }

 private:
  TAPA_INLINE DepthNormal HypothesisOf(const PlaneTable& table, size_t pixel,
                                       const Vec3& ray) const {
    if (table.index == nullptr || table.index[pixel] == PlaneTable::kNone) {
      return DepthNormal();
    }
    return PlaneHypothesis(table.planes[table.index[pixel]], ray, depth_min,
                           depth_max);
  }
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_GUIDE_H_
