#include "src/colmap/fused_points.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <system_error>

#include "src/base/atomic_file.h"
#include "util/endian.h"

namespace tapa {
namespace {

// Little-endian values on their way to a file.
class Buffer {
 public:
  explicit Buffer(AtomicFile* file) : file_(file) {}

  template <typename Value>
  void Add(Value value) {
    value = colmap::NativeToLittleEndian(value);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
    if (bytes_.size() > kMaxSize) {
      Flush();
    }
  }

  void Flush() {
    file_->Write(bytes_.data(), bytes_.size());
    bytes_.clear();
  }

 private:
  static constexpr size_t kMaxSize = 1 << 20;

  AtomicFile* const file_;
  std::string bytes_;
};

void WriteVisibility(const std::vector<std::vector<int>>& visibility,
                     AtomicFile* file) {
  Buffer buffer(file);
  buffer.Add<uint64_t>(visibility.size());
  for (const std::vector<int>& images : visibility) {
    buffer.Add<uint32_t>(static_cast<uint32_t>(images.size()));
    for (const int image : images) {
      buffer.Add<uint32_t>(static_cast<uint32_t>(image));
    }
  }
  buffer.Flush();
}

template <typename Coordinate>
void WritePoints(const std::vector<colmap::PlyPoint>& points,
                 const Eigen::Vector3d& origin, AtomicFile* file) {
  const std::string type = sizeof(Coordinate) == 8 ? "double" : "float";
  std::ostringstream header;
  header << "ply\nformat binary_little_endian 1.0\nelement vertex "
         << points.size() << "\n";
  for (const char* name : {"x", "y", "z"}) {
    header << "property " << type << " " << name << "\n";
  }
  header << "property float nx\nproperty float ny\nproperty float nz\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\n"
            "end_header\n";
  file->Write(header.str().data(), header.str().size());
  Buffer buffer(file);
  for (const colmap::PlyPoint& point : points) {
    buffer.Add(static_cast<Coordinate>(point.x + origin.x()));
    buffer.Add(static_cast<Coordinate>(point.y + origin.y()));
    buffer.Add(static_cast<Coordinate>(point.z + origin.z()));
    buffer.Add(point.nx);
    buffer.Add(point.ny);
    buffer.Add(point.nz);
    buffer.Add(point.r);
    buffer.Add(point.g);
    buffer.Add(point.b);
  }
  buffer.Flush();
}

}  // namespace

void WriteFusedPoints(const std::string& path,
                      const std::vector<colmap::PlyPoint>& points,
                      const std::vector<std::vector<int>>& visibility,
                      const Eigen::Vector3d& origin) {
  AtomicFile file(path);
  if (origin.isZero(0)) {
    WritePoints<float>(points, origin, &file);
  } else {
    WritePoints<double>(points, origin, &file);
  }
  AtomicFile visibility_file(path + ".vis");
  WriteVisibility(visibility, &visibility_file);
  visibility_file.Commit();
  file.Commit();
}

bool HasWholePoints(const std::string& path) {
  const std::map<std::string, uint64_t> sizes = {
      {"float", 4}, {"double", 8}, {"uchar", 1}};
  std::ifstream file(path, std::ios::binary);
  uint64_t num_points = 0;
  uint64_t point_size = 0;
  std::string line;
  while (std::getline(file, line) && line != "end_header") {
    std::istringstream words(line);
    std::string key;
    std::string type;
    words >> key >> type;
    if (key == "element" && type == "vertex") {
      words >> num_points;
    } else if (key == "property" && sizes.count(type) > 0) {
      point_size += sizes.at(type);
    }
  }
  if (line != "end_header") {
    return false;
  }
  const auto header_size = static_cast<uint64_t>(file.tellg());
  std::error_code error;
  const uint64_t size = std::filesystem::file_size(path, error);
  return !error && size == header_size + num_points * point_size;
}

}  // namespace tapa
