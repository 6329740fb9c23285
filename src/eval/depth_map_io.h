#ifndef TAPA_SRC_EVAL_DEPTH_MAP_IO_H_
#define TAPA_SRC_EVAL_DEPTH_MAP_IO_H_

#include <string>

#include "src/base/map.h"

namespace tapa {

// Ground-truth depth in metres, 0 where nothing was measured: a 16-bit grey PNG
// of which `depth_scale` steps are one metre, or, by the extension ".bin", one
// of COLMAP's maps. What is no positive number in the latter becomes 0.
// Throws std::runtime_error with the path in the message if the file cannot be
// read or is no such map.
Map<float> ReadGroundTruth(const std::string& path, double depth_scale);

}  // namespace tapa

#endif  // TAPA_SRC_EVAL_DEPTH_MAP_IO_H_
