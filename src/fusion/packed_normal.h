#ifndef TAPA_SRC_FUSION_PACKED_NORMAL_H_
#define TAPA_SRC_FUSION_PACKED_NORMAL_H_

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "src/base/vec3.h"

namespace tapa {

// A direction in 32 bits: its point on the octahedron |x| + |y| + |z| = 1,
// whose lower half is folded outwards, with 16 bits for each of x and y. The
// error is at most 7e-5 radians. (Cigolle et al., "A Survey of Efficient
// Representations for Independent Unit Vectors", JCGT 2014.)

// normal: of any length but 0; what has none becomes (0, 0, 1).
inline uint32_t PackNormal(const Vec3& normal) {
  const float sum =
      std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
  if (!(sum > 0) || !std::isfinite(sum)) {
    return PackNormal({0, 0, 1});
  }
  float x = normal.x / sum;
  float y = normal.y / sum;
  if (normal.z < 0) {
    const float folded = (1 - std::abs(y)) * (x < 0 ? -1 : 1);
    y = (1 - std::abs(x)) * (y < 0 ? -1 : 1);
    x = folded;
  }
  const auto quantize = [](float value) {
    return static_cast<uint32_t>(
        std::min(std::max((value + 1) * 32767.5f + 0.5f, 0.0f), 65535.0f));
  };
  return quantize(x) | quantize(y) << 16;
}

// Of unit length.
inline Vec3 UnpackNormal(uint32_t packed) {
  const auto value = [](uint32_t bits) {
    return static_cast<float>(bits) * (1 / 32767.5f) - 1;
  };
  Vec3 n{value(packed & 0xffff), value(packed >> 16), 0};
  n.z = 1 - std::abs(n.x) - std::abs(n.y);
  const float fold = std::max(-n.z, 0.0f);
  n.x += n.x < 0 ? fold : -fold;
  n.y += n.y < 0 ? fold : -fold;
  return 1 / std::sqrt(Dot(n, n)) * n;
}

}  // namespace tapa

#endif  // TAPA_SRC_FUSION_PACKED_NORMAL_H_
