#ifndef TAPA_SRC_BASE_MAP_FILES_H_
#define TAPA_SRC_BASE_MAP_FILES_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "src/base/map.h"
#include "src/base/vec3.h"

namespace tapa {

// Files in COLMAP's format of dense maps: the header "WIDTH&HEIGHT&CHANNELS&"
// in text, then 32-bit little-endian values, one channel after the other, each
// in row-major order. Depth is that along the camera's axis, in scene units;
// normals have unit length and are in the camera's frame (x right, y down, z
// forward); both are 0 where there is no estimate. Consistency graphs have one
// channel, by their header, and a list of integers of any length.
//
// A file is valid if its header is and if it has exactly the length that this
// asks for.
enum class MapKind { kDepth, kNormal, kConsistencyGraph };

// Throw Failure that names the file and what is wrong with it, unless it is a
// valid one of this kind, and of this size.
void CheckMapFile(const std::string& path, MapKind kind);
void CheckMapFile(const std::string& path, MapKind kind, int width, int height);

// Width and height of a valid file. Throws Failure as CheckMapFile does.
std::pair<int, int> ReadMapSize(const std::string& path, MapKind kind);

// A valid file whose rows are read when they are asked for, so that a large map
// needs no memory as a whole.
class MapRows {
 public:
  // Throws Failure as CheckMapFile does.
  MapRows(const std::string& path, MapKind kind);
  ~MapRows();
  MapRows(const MapRows&) = delete;
  MapRows& operator=(const MapRows&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }

  // The values of a row in one channel, as they stand in the file; `values` has
  // room for `width()`. Threads may read at the same time. Throws Failure if
  // the file cannot be read.
  void Read(int channel, int row, float* values) const;

  // All of a consistency graph. Throws Failure as above.
  std::vector<int32_t> ReadList() const;

 private:
  // Reads the header and compares it with the length of the file.
  void Check(MapKind kind, uint64_t file_size);
  // Reads up to `size` bytes; fewer where the file ends. Returns how many.
  size_t ReadBytes(void* bytes, size_t size, uint64_t at) const;

  const std::string path_;
  int file_ = -1;
  int width_ = 0;
  int height_ = 0;
  // Where the values begin.
  uint64_t begin_ = 0;
  // How many bytes of them there are.
  uint64_t num_bytes_ = 0;
};

// Read a valid file of any size. Throw Failure as CheckMapFile does. Values are
// returned as they stand in the file.
Map<float> ReadDepthMap(const std::string& path);
Map<Vec3> ReadNormalMap(const std::string& path);

// The same of a consistency graph, as it is written below.
std::vector<int32_t> ReadGraph(const std::string& path);

// Write a file such that it is there under its name only when it is complete:
// beside it first, then renamed. Folders are made as needed. Throw Failure,
// and leave nothing behind, if that is impossible.
void WriteDepthMap(const std::string& path, const Map<float>& map);
void WriteNormalMap(const std::string& path, const Map<Vec3>& map);
// graph: for each pixel that some source views support: column, row, number
// of views, indices of the views.
void WriteGraph(const std::string& path, int width, int height,
                const std::vector<int32_t>& graph);

}  // namespace tapa

#endif  // TAPA_SRC_BASE_MAP_FILES_H_
