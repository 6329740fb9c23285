#ifndef TAPA_SRC_FUSION_FUSED_CLOUD_H_
#define TAPA_SRC_FUSION_FUSED_CLOUD_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "src/base/map.h"
#include "src/base/vec3.h"
#include "src/fusion/point_file.h"

namespace tapa {

// A point of the scene that a pixel of one view and others show; 32 bytes, as
// there are millions.
struct FusedPoint {
  // In scene units, in the world's frame.
  Vec3 position;
  // In the world's frame, as PackNormal makes it.
  uint32_t normal = 0;
  // Of the pixel.
  Rgb color;
  // Agreement less doubt, in views.
  float confidence = 0;
  // Bit n: neighbour n of the pixel's view sees it, too.
  uint64_t visible = 0;
};

// The points of the pixels of one view, in row-major order.
struct FusedView {
  int view = 0;
  // The views that the bits of FusedPoint::visible stand for.
  std::vector<int> neighbors;
  // Those in memory, then those in a file.
  std::vector<FusedPoint> points;
  std::shared_ptr<const PointFile> file;
  size_t begin_in_file = 0;
  size_t num_in_file = 0;

  size_t NumPoints() const { return points.size() + num_in_file; }
  // Calls visit(point) for all of them. Throws Failure if the file cannot be
  // read.
  template <typename Visitor>
  void VisitPoints(const Visitor& visit) const;
};

struct FusedCloud {
  // In the order in which views were fused.
  std::vector<FusedView> views;
  // As many points as take this are in memory, others in a file in the folder,
  // if it can have one.
  size_t max_bytes_in_memory = std::numeric_limits<size_t>::max();
  std::string folder;

  // Throws Failure if there is no room.
  void Add(FusedView view);

  size_t NumPoints() const {
    size_t count = 0;
    for (const auto& view : views) {
      count += view.NumPoints();
    }
    return count;
  }

 private:
  size_t num_in_memory_ = 0;
  std::shared_ptr<PointFile> file_;
};

template <typename Visitor>
void FusedView::VisitPoints(const Visitor& visit) const {
  std::for_each(points.begin(), points.end(), visit);
  constexpr size_t kBlockSize = 1 << 14;
  std::vector<FusedPoint> block(std::min(num_in_file, kBlockSize));
  for (size_t i = 0; i < num_in_file; i += block.size()) {
    block.resize(std::min(num_in_file - i, kBlockSize));
    file->Read(begin_in_file + i, block.size(), block.data());
    std::for_each(block.begin(), block.end(), visit);
  }
}

}  // namespace tapa

#endif  // TAPA_SRC_FUSION_FUSED_CLOUD_H_
