#ifndef TAPA_SRC_COLMAP_MAP_FILES_H_
#define TAPA_SRC_COLMAP_MAP_FILES_H_

#include <cstdint>
#include <string>
#include <vector>

#include "src/base/map.h"
#include "src/base/vec3.h"

namespace tapa {

// Files in COLMAP's format of dense maps: the header "WIDTH&HEIGHT&CHANNELS&"
// in text, then 32-bit little-endian values, one channel after the other, each
// in row-major order. Consistency graphs have the same header with CHANNELS 1,
// then a list of integers of any length.

// Checks header and length of a file against what it has to be. Returns an
// empty string if they fit, otherwise what is wrong with the file, without its
// name. channels: 1 for depth, 3 for normals.
std::string CheckMapFile(const std::string& path, int width, int height,
                         int channels);
std::string CheckGraphFile(const std::string& path, int width, int height);

// Read a file of the given size. Throw Failure if it is not whole.
Map<float> ReadDepthMap(const std::string& path, int width, int height);
Map<Vec3> ReadNormalMap(const std::string& path, int width, int height);

// Write a file such that it is there under its name only when it is complete:
// beside it first, then renamed. Folders are made as needed. Throw Failure,
// and leave nothing behind, if that is impossible.
void WriteDepthMap(const std::string& path, const Map<float>& map);
void WriteNormalMap(const std::string& path, const Map<Vec3>& map);
// graph: for each pixel that some source views support: column, row, number
// of views, indices of the views.
void WriteGraph(const std::string& path, int width, int height,
                const std::vector<int32_t>& graph);

// Throws Failure if files cannot be made in the folder. Makes it if it is not
// there. Removes the unfinished files of this machine's dead processes.
// contents: what is written there, for the message.
void PrepareFolder(const std::string& path, const std::string& contents);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_MAP_FILES_H_
