#include "src/base/map_files.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "src/base/atomic_file.h"
#include "src/base/failure.h"

// Values are copied as they stand in memory.
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
              "maps are stored in little-endian order");

namespace tapa {
namespace {

// A file whose header has been read.
struct OpenMap {
  std::ifstream file;
  int width = 0;
  int height = 0;
};

// Reads a positive number and the '&' behind it. Returns 0 if there is none.
int ReadHeaderNumber(std::istream* file) {
  constexpr int kMax = 1000000;
  int value = 0;
  int digit = file->get();
  while (digit >= '0' && digit <= '9' && value <= kMax) {
    value = 10 * value + (digit - '0');
    digit = file->get();
  }
  return digit == '&' && value <= kMax ? value : 0;
}

int NumChannels(MapKind kind) { return kind == MapKind::kNormal ? 3 : 1; }

std::string SizeText(int width, int height, int channels) {
  return std::to_string(width) + "x" + std::to_string(height) + "x" +
         std::to_string(channels);
}

[[noreturn]] void Fail(const std::string& path, const std::string& what) {
  throw Failure(path + " " + what);
}

[[noreturn]] void FailToRead(const std::string& path) {
  Fail(path, std::string("cannot be read: ") + std::strerror(errno));
}

// Opens a valid file of any size.
OpenMap Open(const std::string& path, MapKind kind) {
  OpenMap map;
  std::error_code ignored;
  map.file.open(path, std::ios::binary);
  if (!map.file || !std::filesystem::is_regular_file(path, ignored)) {
    throw Failure("cannot open " + path);
  }
  map.width = ReadHeaderNumber(&map.file);
  map.height = ReadHeaderNumber(&map.file);
  const int found_channels = ReadHeaderNumber(&map.file);
  if (map.file.bad()) {
    FailToRead(path);
  }
  if (map.width == 0 || map.height == 0 || found_channels == 0) {
    Fail(path, "is not a COLMAP depth or normal map");
  }
  const int channels = NumChannels(kind);
  const std::string size = SizeText(map.width, map.height, found_channels);
  if (found_channels != channels) {
    Fail(path, "has the size " + size + ", but " + std::to_string(channels) +
                   (channels == 1 ? " channel is" : " channels are") +
                   " expected");
  }
  const std::streamoff begin = map.file.tellg();
  map.file.seekg(0, std::ios::end);
  const uint64_t bytes = static_cast<uint64_t>(map.file.tellg() - begin);
  map.file.seekg(begin);
  const uint64_t needed =
      sizeof(float) * static_cast<uint64_t>(map.width) * map.height * channels;
  if (kind != MapKind::kConsistencyGraph && bytes != needed) {
    Fail(path, (bytes < needed ? "is truncated: " : "is too long: ") +
                   std::to_string(bytes) + " bytes of values where the size " +
                   size + " needs " + std::to_string(needed));
  }
  if (bytes % sizeof(int32_t) != 0) {
    Fail(path, "is truncated");
  }
  return map;
}

// Reads `count` values, in the order of the file.
void ReadValues(const std::string& path, OpenMap* map, float* values,
                size_t count) {
  if (!map->file.read(reinterpret_cast<char*>(values),
                      static_cast<std::streamsize>(count * sizeof(float)))) {
    FailToRead(path);
  }
}

void WriteFile(const std::string& path, int width, int height, int channels,
               const void* values, size_t size) {
  std::error_code ignored;  // Opening the file fails then.
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(),
                                      ignored);
  const std::string header = std::to_string(width) + "&" +
                             std::to_string(height) + "&" +
                             std::to_string(channels) + "&";
  AtomicFile file(path);
  file.Write(header.data(), header.size());
  file.Write(values, size);
  file.Commit();
}

}  // namespace

void CheckMapFile(const std::string& path, MapKind kind) { Open(path, kind); }

void CheckMapFile(const std::string& path, MapKind kind, int width,
                  int height) {
  const OpenMap map = Open(path, kind);
  if (map.width != width || map.height != height) {
    const int channels = NumChannels(kind);
    Fail(path, "has the size " + SizeText(map.width, map.height, channels) +
                   ", but " + SizeText(width, height, channels) + " is needed");
  }
}

std::pair<int, int> ReadMapSize(const std::string& path, MapKind kind) {
  const OpenMap map = Open(path, kind);
  return {map.width, map.height};
}

Map<float> ReadDepthMap(const std::string& path) {
  OpenMap file = Open(path, MapKind::kDepth);
  Map<float> map(file.width, file.height);
  ReadValues(path, &file, map.data(), map.size());
  return map;
}

Map<Vec3> ReadNormalMap(const std::string& path) {
  OpenMap file = Open(path, MapKind::kNormal);
  Map<Vec3> map(file.width, file.height);
  std::vector<float> values(3 * map.size());
  ReadValues(path, &file, values.data(), values.size());
  for (size_t i = 0; i < map.size(); ++i) {
    map.data()[i] = {values[i], values[map.size() + i],
                     values[2 * map.size() + i]};
  }
  return map;
}

void WriteDepthMap(const std::string& path, const Map<float>& map) {
  WriteFile(path, map.width(), map.height(), 1, map.data(),
            map.size() * sizeof(float));
}

void WriteNormalMap(const std::string& path, const Map<Vec3>& map) {
  std::vector<float> values(3 * map.size());
  for (size_t i = 0; i < map.size(); ++i) {
    values[i] = map.data()[i].x;
    values[map.size() + i] = map.data()[i].y;
    values[2 * map.size() + i] = map.data()[i].z;
  }
  WriteFile(path, map.width(), map.height(), 3, values.data(),
            values.size() * sizeof(float));
}

void WriteGraph(const std::string& path, int width, int height,
                const std::vector<int32_t>& graph) {
  WriteFile(path, width, height, 1, graph.data(),
            graph.size() * sizeof(int32_t));
}

}  // namespace tapa
