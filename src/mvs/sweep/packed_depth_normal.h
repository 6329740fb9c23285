#ifndef TAPA_SRC_MVS_SWEEP_PACKED_DEPTH_NORMAL_H_
#define TAPA_SRC_MVS_SWEEP_PACKED_DEPTH_NORMAL_H_

#include <cmath>
#include <cstdint>

#include "src/mvs/sweep/depth_normal.h"

namespace tapa {

// An estimate or a hypothesis of a pixel in 8 bytes: its depth as it is, its
// unit normal as a point of the octahedron |x| + |y| + |z| = 1 that is unfolded
// into a square (Cigolle et al., "A Survey of Efficient Representations for
// Independent Unit Vectors", JCGT 2014), with 16 bits for either coordinate.
// Normals come back to within 7e-5 radians, a change of depth by 3e-4 pixels at
// the border of an 11x11 window.
struct alignas(8) PackedDepthNormal {
  float depth;
  // No valid normal has the code kNoNormal: it stands for 0, where there is no
  // depth.
  uint32_t normal;
};

constexpr uint32_t kNoNormal = 0xFFFFFFFFu;

TAPA_INLINE uint32_t PackNormal(const Vec3& n) {
  const float scale = 1.0f / (fabsf(n.x) + fabsf(n.y) + fabsf(n.z));
  const float x = n.x * scale;
  const float y = n.y * scale;
  // The lower half is folded outwards.
  const float u = n.z >= 0.0f ? x : (1.0f - fabsf(y)) * (x >= 0.0f ? 1 : -1);
  const float v = n.z >= 0.0f ? y : (1.0f - fabsf(x)) * (y >= 0.0f ? 1 : -1);
  const auto code = [](float value) {
    return static_cast<uint32_t>(
        static_cast<int32_t>((value + 1.0f) * 32767.0f + 0.5f));
  };
  return code(u) | code(v) << 16;
}

TAPA_INLINE Vec3 UnpackNormal(uint32_t code) {
  if (code == kNoNormal) {
    return Vec3();
  }
  const auto decode = [](uint32_t half) {
    return static_cast<float>(static_cast<int32_t>(half & 0xFFFFu)) *
               (1.0f / 32767.0f) -
           1.0f;
  };
  const float u = decode(code);
  const float v = decode(code >> 16);
  const float z = 1.0f - fabsf(u) - fabsf(v);
  const float fold = z < 0.0f ? -z : 0.0f;
  const Vec3 n = {u >= 0.0f ? u - fold : u + fold,
                  v >= 0.0f ? v - fold : v + fold, z};
  return (1.0f / sqrtf(Dot(n, n))) * n;
}

// Of a pixel that has none.
TAPA_INLINE PackedDepthNormal PackNothing() { return {0.0f, kNoNormal}; }

TAPA_INLINE PackedDepthNormal Pack(const DepthNormal& estimate) {
  return {estimate.depth, PackNormal(estimate.normal)};
}

TAPA_INLINE DepthNormal Unpack(const PackedDepthNormal& packed) {
  return {packed.depth, UnpackNormal(packed.normal)};
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_PACKED_DEPTH_NORMAL_H_
