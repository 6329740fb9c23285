#ifndef TAPA_SRC_BASE_ANGLE_H_
#define TAPA_SRC_BASE_ANGLE_H_

namespace tapa {

constexpr double kPi = 3.14159265358979323846;

constexpr double DegToRad(double degrees) { return degrees * (kPi / 180); }

}  // namespace tapa

#endif  // TAPA_SRC_BASE_ANGLE_H_
