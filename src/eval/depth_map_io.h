#ifndef TAPA_SRC_EVAL_DEPTH_MAP_IO_H_
#define TAPA_SRC_EVAL_DEPTH_MAP_IO_H_

#include <string>

#include "src/base/map.h"
#include "src/base/vec3.h"

namespace tapa {

// Reading of depth and normal maps. COLMAP's map files begin with the text
// "width&height&channels&"; little-endian 32-bit floats follow, channel by
// channel, each in row-major order. All functions throw std::runtime_error with
// the path in the message if a file cannot be opened, is no such map, or does
// not have exactly the size that its header says.

// Depth is planar (z in the camera frame), in scene units. Values are returned
// as they stand in the file; COLMAP writes 0 where there is no estimate.
Map<float> ReadDepthMap(const std::string& path);

// Unit normals in the camera frame (x right, y down, z forward), 0 where there
// is no estimate.
Map<Vec3> ReadNormalMap(const std::string& path);

// Ground-truth depth in metres, 0 where nothing was measured: a 16-bit grey PNG
// of which `depth_scale` steps are one metre, or, by the extension ".bin", one
// of COLMAP's maps. What is no positive number in the latter becomes 0.
Map<float> ReadGroundTruth(const std::string& path, double depth_scale);

}  // namespace tapa

#endif  // TAPA_SRC_EVAL_DEPTH_MAP_IO_H_
