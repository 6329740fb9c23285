#ifndef TAPA_SRC_MVS_CUDA_DEVICE_TEXTURES_H_
#define TAPA_SRC_MVS_CUDA_DEVICE_TEXTURES_H_

#include <cuda_runtime.h>

#include "src/mvs/cuda/bilinear.h"
#include "src/mvs/cuda/kernels.h"

namespace tapa {

// Textures (see patch.h) of a device. Only for its code: on the host they are
// black.
template <bool kPrecise>
class DeviceTextures {
 public:
  TAPA_INLINE explicit DeviceTextures(const TextureObjects& objects)
      : objects_(objects) {}

  TAPA_INLINE float Reference(int col, int row) const {
#if defined(TAPA_ON_DEVICE)
    return tex2D<unsigned char>(objects_.reference, col + 0.5f, row + 0.5f);
#else
    return 0.0f;
#endif
  }

  TAPA_INLINE float Source(int m, float x, float y) const {
#if defined(TAPA_ON_DEVICE)
    if (kPrecise) {
      return BilinearSample<true>(x, y, [&](int col, int row) -> float {
        return tex2DLayered<unsigned char>(objects_.exact_sources, col + 0.5f,
                                           row + 0.5f, m);
      });
    }
    return 255.0f * tex2DLayered<float>(objects_.sources, x, y, m);
#else
    return 0.0f;
#endif
  }

  // Rounded here: the texture units round places to fractions of a pixel.
  TAPA_INLINE float SourceDepth(int m, float x, float y) const {
#if defined(TAPA_ON_DEVICE)
    return tex2DLayered<float>(objects_.source_depths, floorf(x) + 0.5f,
                               floorf(y) + 0.5f, m);
#else
    return 0.0f;
#endif
  }

 private:
  const TextureObjects& objects_;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CUDA_DEVICE_TEXTURES_H_
