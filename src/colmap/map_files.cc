#include "src/colmap/map_files.h"

#include <sys/stat.h>

#include <boost/filesystem.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "src/base/atomic_file.h"
#include "src/base/failure.h"

// Values are copied as they stand in memory.
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
              "maps are stored in little-endian order");

namespace tapa {
namespace {

struct Header {
  long long width = 0;
  long long height = 0;
  long long channels = 0;
  // Bytes of the header, 0: there is none.
  size_t size = 0;
};

Header ReadHeader(std::istream* file) {
  // Three numbers of up to 19 digits.
  char text[64] = "";
  file->read(text, sizeof(text) - 1);
  file->clear();
  Header header;
  int size = 0;
  if (std::sscanf(text, "%19lld&%19lld&%19lld&%n", &header.width,
                  &header.height, &header.channels, &size) == 3) {
    header.size = size;
  }
  return header;
}

std::string SizeText(long long width, long long height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

// As CheckMapFile; values: number of values, -1: any number.
std::string CheckFile(const std::string& path, int width, int height,
                      int channels, long long values) {
  struct stat info;
  std::ifstream file(path, std::ios::binary);
  if (stat(path.c_str(), &info) != 0 || !file) {
    return std::strerror(errno);
  }
  if (!S_ISREG(info.st_mode)) {
    return "is not a file";
  }
  const Header header = ReadHeader(&file);
  if (header.size == 0) {
    return "is no map (it has no valid header)";
  }
  if (header.width != width || header.height != height ||
      header.channels != channels) {
    return "has the size " + SizeText(header.width, header.height) + "x" +
           std::to_string(header.channels) + ", but " +
           SizeText(width, height) + "x" + std::to_string(channels) +
           " is needed";
  }
  const long long bytes = info.st_size - static_cast<long long>(header.size);
  if (values >= 0 && bytes != 4 * values) {
    return (bytes < 4 * values ? "is truncated (" : "is too long (") +
           std::to_string(bytes) + " bytes of values, but " +
           std::to_string(4 * values) + " are needed)";
  }
  if (bytes % 4 != 0) {
    return "is truncated";
  }
  return "";
}

std::vector<float> ReadValues(const std::string& path, int width, int height,
                              int channels) {
  const std::string error = CheckMapFile(path, width, height, channels);
  if (!error.empty()) {
    throw Failure(path + " " + error);
  }
  std::ifstream file(path, std::ios::binary);
  file.seekg(ReadHeader(&file).size);
  std::vector<float> values(static_cast<size_t>(width) * height * channels);
  if (!file.read(reinterpret_cast<char*>(values.data()),
                 values.size() * sizeof(float))) {
    throw Failure("Cannot read " + path);
  }
  return values;
}

void WriteFile(const std::string& path, int width, int height, int channels,
               const void* values, size_t size) {
  boost::system::error_code ignored;  // Opening the file fails then.
  boost::filesystem::create_directories(
      boost::filesystem::path(path).parent_path(), ignored);
  const std::string header = std::to_string(width) + "&" +
                             std::to_string(height) + "&" +
                             std::to_string(channels) + "&";
  AtomicFile file(path);
  file.Write(header.data(), header.size());
  file.Write(values, size);
  file.Commit();
}

}  // namespace

std::string CheckMapFile(const std::string& path, int width, int height,
                         int channels) {
  return CheckFile(path, width, height, channels,
                   1ll * width * height * channels);
}

std::string CheckGraphFile(const std::string& path, int width, int height) {
  return CheckFile(path, width, height, 1, -1);
}

Map<float> ReadDepthMap(const std::string& path, int width, int height) {
  const std::vector<float> values = ReadValues(path, width, height, 1);
  Map<float> map(width, height);
  std::memcpy(map.data(), values.data(), values.size() * sizeof(float));
  return map;
}

Map<Vec3> ReadNormalMap(const std::string& path, int width, int height) {
  const std::vector<float> values = ReadValues(path, width, height, 3);
  Map<Vec3> map(width, height);
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

void PrepareFolder(const std::string& path, const std::string& contents) {
  boost::system::error_code error;
  boost::filesystem::create_directories(path, error);
  if (!boost::filesystem::is_directory(path)) {
    throw Failure("There is no folder " + path + ", and it cannot be made" +
                  (error ? " (" + error.message() + ")" : "") + "; " +
                  contents + " are written there");
  }
  RemoveStaleTemporaries(path);
  AtomicFile probe(path + "/probe");
}

}  // namespace tapa
