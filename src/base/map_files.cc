#include "src/base/map_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "src/base/atomic_file.h"
#include "src/base/failure.h"
#include "src/base/read_at.h"

// Values are copied as they stand in memory.
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
              "maps are stored in little-endian order");

namespace tapa {
namespace {

// Longer headers are not valid: three numbers of up to seven digits.
constexpr size_t kMaxHeaderSize = 24;

// Takes a positive number and the '&' behind it off the front of a header.
// Returns 0 if there is none.
int TakeNumber(std::string_view* header) {
  constexpr int kMax = 1000000;
  int value = 0;
  const auto [end, error] =
      std::from_chars(header->data(), header->data() + header->size(), value);
  const size_t length = static_cast<size_t>(end - header->data());
  if (error != std::errc() || length == header->size() || *end != '&' ||
      value <= 0 || value > kMax) {
    return 0;
  }
  header->remove_prefix(length + 1);
  return value;
}

int NumChannels(MapKind kind) { return kind == MapKind::kNormal ? 3 : 1; }

std::string SizeText(int width, int height, int channels) {
  return std::to_string(width) + "x" + std::to_string(height) + "x" +
         std::to_string(channels);
}

[[noreturn]] void Fail(const std::string& path, const std::string& what) {
  throw Failure(path + " " + what);
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

MapRows::MapRows(const std::string& path, MapKind kind)
    : path_(path), file_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
  struct stat status;
  if (file_ < 0 || fstat(file_, &status) != 0 || !S_ISREG(status.st_mode)) {
    close(file_);
    throw Failure("cannot open " + path);
  }
  try {
    Check(kind, static_cast<uint64_t>(status.st_size));
  } catch (...) {
    close(file_);
    throw;
  }
}

MapRows::~MapRows() { close(file_); }

void MapRows::Check(MapKind kind, uint64_t file_size) {
  char first[kMaxHeaderSize];
  std::string_view header(first, ReadBytes(first, kMaxHeaderSize, 0));
  const size_t num_read = header.size();
  width_ = TakeNumber(&header);
  height_ = TakeNumber(&header);
  const int found_channels = TakeNumber(&header);
  if (width_ == 0 || height_ == 0 || found_channels == 0) {
    Fail(path_, "is not a COLMAP depth or normal map");
  }
  const int channels = NumChannels(kind);
  const std::string size = SizeText(width_, height_, found_channels);
  if (found_channels != channels) {
    Fail(path_, "has the size " + size + ", but " + std::to_string(channels) +
                    (channels == 1 ? " channel is" : " channels are") +
                    " expected");
  }
  begin_ = num_read - header.size();
  const uint64_t bytes = file_size - begin_;
  const uint64_t needed =
      sizeof(float) * static_cast<uint64_t>(width_) * height_ * channels;
  if (kind != MapKind::kConsistencyGraph && bytes != needed) {
    Fail(path_, (bytes < needed ? "is truncated: " : "is too long: ") +
                    std::to_string(bytes) + " bytes of values where the size " +
                    size + " needs " + std::to_string(needed));
  }
  if (bytes % sizeof(int32_t) != 0) {
    Fail(path_, "is truncated");
  }
  num_bytes_ = bytes;
}

size_t MapRows::ReadBytes(void* bytes, size_t size, uint64_t at) const {
  const int64_t num_read = ReadAt(file_, bytes, size, at);
  if (num_read < 0) {
    Fail(path_, std::string("cannot be read: ") + std::strerror(errno));
  }
  return static_cast<size_t>(num_read);
}

void MapRows::Read(int channel, int row, float* values) const {
  const uint64_t index =
      (static_cast<uint64_t>(channel) * height_ + row) * width_;
  const size_t size = sizeof(float) * static_cast<size_t>(width_);
  if (ReadBytes(values, size, begin_ + sizeof(float) * index) != size) {
    Fail(path_, "was cut off while it was read");
  }
}

std::vector<int32_t> MapRows::ReadList() const {
  std::vector<int32_t> values(num_bytes_ / sizeof(int32_t));
  if (ReadBytes(values.data(), num_bytes_, begin_) != num_bytes_) {
    Fail(path_, "was cut off while it was read");
  }
  return values;
}

void CheckMapFile(const std::string& path, MapKind kind) {
  MapRows(path, kind);
}

void CheckMapFile(const std::string& path, MapKind kind, int width,
                  int height) {
  const MapRows rows(path, kind);
  if (rows.width() != width || rows.height() != height) {
    const int channels = NumChannels(kind);
    Fail(path, "has the size " +
                   SizeText(rows.width(), rows.height(), channels) + ", but " +
                   SizeText(width, height, channels) + " is needed");
  }
}

std::pair<int, int> ReadMapSize(const std::string& path, MapKind kind) {
  const MapRows rows(path, kind);
  return {rows.width(), rows.height()};
}

Map<float> ReadDepthMap(const std::string& path) {
  const MapRows rows(path, MapKind::kDepth);
  Map<float> map(rows.width(), rows.height());
  for (int row = 0; row < map.height(); ++row) {
    rows.Read(0, row, map.Row(row));
  }
  return map;
}

Map<Vec3> ReadNormalMap(const std::string& path) {
  const MapRows rows(path, MapKind::kNormal);
  Map<Vec3> map(rows.width(), rows.height());
  std::vector<float> x(map.width()), y(map.width()), z(map.width());
  for (int row = 0; row < map.height(); ++row) {
    rows.Read(0, row, x.data());
    rows.Read(1, row, y.data());
    rows.Read(2, row, z.data());
    for (int col = 0; col < map.width(); ++col) {
      map.At(row, col) = {x[col], y[col], z[col]};
    }
  }
  return map;
}

std::vector<int32_t> ReadGraph(const std::string& path) {
  const MapRows rows(path, MapKind::kConsistencyGraph);
  std::vector<int32_t> graph = rows.ReadList();
  size_t at = 0;
  while (at < graph.size()) {
    const size_t left = graph.size() - at;
    const int32_t count = left < 3 ? 0 : graph[at + 2];
    if (count <= 0 || static_cast<size_t>(count) > left - 3 || graph[at] < 0 ||
        graph[at] >= rows.width() || graph[at + 1] < 0 ||
        graph[at + 1] >= rows.height()) {
      Fail(path, "is damaged; remove it to have it computed again");
    }
    at += 3 + count;
  }
  return graph;
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
