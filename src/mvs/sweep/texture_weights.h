#ifndef TAPA_SRC_MVS_SWEEP_TEXTURE_WEIGHTS_H_
#define TAPA_SRC_MVS_SWEEP_TEXTURE_WEIGHTS_H_

#include <cstdint>

#include "src/mvs/sweep/host_device.h"

namespace tapa {

// Textureness (0 to 1) in 16 bits such that one half, at which the weights of
// all hypotheses are the same number, comes back exactly.
constexpr float kTexturenessScale = 65534.0f;
TAPA_INLINE uint16_t EncodeTextureness(float t) {
  return static_cast<uint16_t>(
      static_cast<int32_t>(t * kTexturenessScale + 0.5f));
}
TAPA_INLINE float DecodeTextureness(uint16_t code) {
  // A product: GPUs divide without rounding exactly.
  constexpr float kInverse = 1.0f / kTexturenessScale;
  return static_cast<float>(static_cast<int32_t>(code)) * kInverse;
}
// Where it is stored as it is.
TAPA_INLINE float DecodeTextureness(float t) { return t; }

// Factors of the two terms of a hypothesis' cost.
struct CostWeights {
  float photometric = 1;
  float geometric = 1;
};

// How textureness t moves the choice from the sweep's own hypotheses to those
// of planes (Romanoni and Matteucci, section 4.2):
//
//   w+ = 0.8 + 0.2 t,   w- = 1.0 - 0.2 t
//
// and costs w- photo + w+ geom for the sweep's own hypotheses against
// w+ photo + w- geom for planes. Planes are favoured where t < 0.5. Written
// such that both weights are the same number where t = 0.5, which is the
// paper's t of a flat patch: that has the same costs for all hypotheses, and
// ties go to the planes, which are tried last.
struct TextureWeights {
  CostWeights own;
  CostWeights planar;

  // range: 0.2 in the equations above.
  static TAPA_INLINE TextureWeights FromTextureness(float t, float range) {
    const float plus = 1.0f - range * (1.0f - t);
    const float minus = 1.0f - range * t;
    return {{minus, plus}, {plus, minus}};
  }
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_TEXTURE_WEIGHTS_H_
