#ifndef TAPA_SRC_EVAL_POINT_CLOUD_H_
#define TAPA_SRC_EVAL_POINT_CLOUD_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "src/base/map.h"
#include "src/base/vec3.h"

namespace tapa {

// Points of a PLY file, in the unit and the frame of the file.
struct PointCloud {
  std::vector<Vec3> points;
  // Points that were left out, as one of their coordinates was infinite or not
  // a number.
  int64_t num_not_finite = 0;
};

// Reads x, y and z of the element "vertex" from a PLY file: ascii or binary of
// either byte order, coordinates of any type, properties in any order, lists
// and other elements among them. Coordinates are rounded to single precision.
// Throws std::runtime_error, with the path in the message, if the file cannot
// be opened, is no PLY, has no such vertices or ends before the last of them.
//
// The reader is our own, as Debian 12 has no library for PLY but CGAL's reader,
// which takes seconds for a million points, takes no NaN in ascii files and no
// coordinates of mixed types, and reads a missing z as 0.
PointCloud ReadPointCloud(const std::string& path);

// Writes a binary PLY of positions and colours, color(i) being that of point i.
// The file appears under its name when it is complete, as AtomicFile. Throws
// Failure if it cannot be written.
void WriteColoredPoints(const std::string& path,
                        const std::vector<Vec3>& points,
                        const std::function<Rgb(size_t)>& color);

}  // namespace tapa

#endif  // TAPA_SRC_EVAL_POINT_CLOUD_H_
