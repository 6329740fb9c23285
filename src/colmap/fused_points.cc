#include "src/colmap/fused_points.h"

#include <cstdint>
#include <cstdio>
#include <iostream>
#include <sstream>

#include "mvs/fusion.h"
#include "src/base/atomic_file.h"
#include "src/base/peak_memory.h"
#include "src/fusion/packed_normal.h"
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

// The points of COLMAP's rule.
struct CountedPoints {
  static constexpr bool kHasConfidence = false;
  const std::vector<colmap::PlyPoint>& points;
  const std::vector<std::vector<int>>& visibility;

  size_t NumPoints() const { return points.size(); }
  size_t NumVisible() const { return visibility.size(); }

  // Calls visit(point, confidence) for all.
  template <typename Visitor>
  void VisitPoints(const Visitor& visit) const {
    for (const colmap::PlyPoint& point : points) {
      visit(point, 0.0f);
    }
  }

  // Calls visit(indices of the images that see it) for all.
  template <typename Visitor>
  void VisitVisible(const Visitor& visit) const {
    for (const std::vector<int>& images : visibility) {
      visit(images);
    }
  }
};

// The points of the rule that weighs agreement.
struct WeighedPoints {
  static constexpr bool kHasConfidence = true;
  const FusedCloud& cloud;

  size_t NumPoints() const { return cloud.NumPoints(); }
  size_t NumVisible() const { return cloud.NumPoints(); }

  template <typename Visitor>
  void VisitPoints(const Visitor& visit) const {
    for (const FusedView& view : cloud.views) {
      view.VisitPoints([&](const FusedPoint& fused) {
        const Vec3 normal = UnpackNormal(fused.normal);
        colmap::PlyPoint point;
        point.x = fused.position.x;
        point.y = fused.position.y;
        point.z = fused.position.z;
        point.nx = normal.x;
        point.ny = normal.y;
        point.nz = normal.z;
        point.r = fused.color.r;
        point.g = fused.color.g;
        point.b = fused.color.b;
        visit(point, fused.confidence);
      });
    }
  }

  template <typename Visitor>
  void VisitVisible(const Visitor& visit) const {
    std::vector<int> images;
    for (const FusedView& view : cloud.views) {
      view.VisitPoints([&](const FusedPoint& point) {
        images = {view.view};
        for (size_t n = 0; n < view.neighbors.size(); ++n) {
          if ((point.visible >> n) & 1) {
            images.push_back(view.neighbors[n]);
          }
        }
        visit(images);
      });
    }
  }
};

template <typename Points>
void WriteVisibility(const Points& points, AtomicFile* file) {
  Buffer buffer(file);
  buffer.Add<uint64_t>(points.NumVisible());
  points.VisitVisible([&](const std::vector<int>& images) {
    buffer.Add<uint32_t>(static_cast<uint32_t>(images.size()));
    for (const int image : images) {
      buffer.Add<uint32_t>(static_cast<uint32_t>(image));
    }
  });
  buffer.Flush();
}

template <typename Coordinate, typename Points>
void WritePoints(const Points& points, const Eigen::Vector3d& origin,
                 AtomicFile* file) {
  const std::string type = sizeof(Coordinate) == 8 ? "double" : "float";
  std::ostringstream header;
  header << "ply\nformat binary_little_endian 1.0\nelement vertex "
         << points.NumPoints() << "\n";
  for (const char* name : {"x", "y", "z"}) {
    header << "property " << type << " " << name << "\n";
  }
  header << "property float nx\nproperty float ny\nproperty float nz\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\n"
         << (Points::kHasConfidence ? "property float confidence\n" : "")
         << "end_header\n";
  file->Write(header.str().data(), header.str().size());
  Buffer buffer(file);
  points.VisitPoints([&](const colmap::PlyPoint& point, float confidence) {
    buffer.Add(static_cast<Coordinate>(point.x + origin.x()));
    buffer.Add(static_cast<Coordinate>(point.y + origin.y()));
    buffer.Add(static_cast<Coordinate>(point.z + origin.z()));
    buffer.Add(point.nx);
    buffer.Add(point.ny);
    buffer.Add(point.nz);
    buffer.Add(point.r);
    buffer.Add(point.g);
    buffer.Add(point.b);
    if (Points::kHasConfidence) {
      buffer.Add(confidence);
    }
  });
  buffer.Flush();
}

template <typename Points>
void WriteFiles(const std::string& path, const Points& points,
                const Eigen::Vector3d& origin) {
  AtomicFile file(path);
  if (origin.isZero(0)) {
    WritePoints<float>(points, origin, &file);
  } else {
    WritePoints<double>(points, origin, &file);
  }
  AtomicFile visibility_file(path + ".vis");
  WriteVisibility(points, &visibility_file);
  file.Finish();
  visibility_file.Finish();
  std::remove(path.c_str());
  visibility_file.Commit();
  file.Commit();
}

}  // namespace

void WriteFusedPoints(const std::string& path,
                      const std::vector<colmap::PlyPoint>& points,
                      const std::vector<std::vector<int>>& visibility,
                      const Eigen::Vector3d& origin) {
  WriteFiles(path, CountedPoints{points, visibility}, origin);
}

void WriteFusedPoints(const std::string& path, const FusedCloud& cloud,
                      const Eigen::Vector3d& origin) {
  WriteFiles(path, WeighedPoints{cloud}, origin);
}

void WriteFusedPoints(const std::string& path,
                      const colmap::mvs::StereoFusion& fusion) {
  if (fusion.GetFusedCloud() != nullptr) {
    WriteFusedPoints(path, *fusion.GetFusedCloud(), fusion.GetOrigin());
  } else {
    WriteFusedPoints(path, fusion.GetFusedPoints(),
                     fusion.GetFusedPointsVisibility(), fusion.GetOrigin());
  }
  std::cout << DescribePeakMemory() << std::endl;
}

std::vector<colmap::PlyPoint> PlyPoints(const FusedCloud& cloud) {
  std::vector<colmap::PlyPoint> points;
  points.reserve(cloud.NumPoints());
  WeighedPoints{cloud}.VisitPoints(
      [&](const colmap::PlyPoint& point, float) { points.push_back(point); });
  return points;
}

}  // namespace tapa
