#ifndef TAPA_SRC_BASE_VEC3_H_
#define TAPA_SRC_BASE_VEC3_H_

#include "src/base/inline.h"

namespace tapa {

struct Vec3 {
  float x = 0;
  float y = 0;
  float z = 0;
};

TAPA_INLINE float Dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

TAPA_INLINE Vec3 Cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

TAPA_INLINE Vec3 operator*(float s, const Vec3& a) {
  return {s * a.x, s * a.y, s * a.z};
}

TAPA_INLINE Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

TAPA_INLINE Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

TAPA_INLINE Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }

}  // namespace tapa

#endif  // TAPA_SRC_BASE_VEC3_H_
