#ifndef TAPA_SRC_BASE_DEPTH_H_
#define TAPA_SRC_BASE_DEPTH_H_

#include <cmath>

namespace tapa {

// Whether an element of a depth map is a depth: finite and greater than 0.
inline bool IsDepth(float value) { return std::isfinite(value) && value > 0; }

}  // namespace tapa

#endif  // TAPA_SRC_BASE_DEPTH_H_
