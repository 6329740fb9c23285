#include "src/mvs/tapa/completion.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <vector>

#include "src/base/depth.h"
#include "src/mvs/sweep/consistency_mask.h"

namespace tapa {
namespace {

// Rows [top, bottom) and columns [left, right).
struct Box {
  int top = 0;
  int left = 0;
  int bottom = 0;
  int right = 0;

  int width() const { return right - left; }
  int height() const { return bottom - top; }
};

std::vector<Box> BoundingBoxes(const Superpixels& superpixels) {
  const Map<uint16_t>& labels = superpixels.labels;
  std::vector<Box> boxes(superpixels.count(),
                         {labels.height(), labels.width(), 0, 0});
  for (int row = 0; row < labels.height(); ++row) {
    for (int col = 0; col < labels.width(); ++col) {
      Box& box = boxes[labels.At(row, col)];
      box.top = std::min(box.top, row);
      box.left = std::min(box.left, col);
      box.bottom = std::max(box.bottom, row + 1);
      box.right = std::max(box.right, col + 1);
    }
  }
  return boxes;
}

// How many of a superpixel's estimates there are, and lie on its plane, within
// any rectangle: sums over all pixels above and to the left.
class EstimateCounts {
 public:
  EstimateCounts(const RefCamera& camera, const Map<float>& depth,
                 const Segmentation& segmentation, int label, const Box& box)
      : box_(box),
        stride_(box.width() + 1),
        sums_(static_cast<size_t>(stride_) * (box.height() + 1)) {
    const FittedPlane& fitted = segmentation.planes[label];
    for (int row = box.top; row < box.bottom; ++row) {
      Counts line;
      for (int col = box.left; col < box.right; ++col) {
        const float z = depth.At(row, col);
        if (segmentation.superpixels.labels.At(row, col) == label &&
            IsDepth(z)) {
          const Vec3 point = z * camera.Ray(row, col);
          ++line.all;
          line.on_plane +=
              std::abs(Dot(fitted.plane.normal, point) +
                       fitted.plane.distance) <= fitted.max_distance;
        }
        const Counts above = At(row, col + 1);
        At(row + 1, col + 1) = {above.all + line.all,
                                above.on_plane + line.on_plane};
      }
    }
  }

  // As LocalPlanes::agreement.
  float Agreement(int row, int col, int radius) const {
    constexpr float kFarWeight = 0.2f;
    constexpr float kDoubt = 0.005f;
    const float size = 2.0f * radius + 1;
    const Counts near = Around(row, col, radius);
    const Counts& all = sums_.back();
    const float num_on_plane =
        near.on_plane + kFarWeight * (all.on_plane - near.on_plane);
    const float num_all = near.all + kFarWeight * (all.all - near.all);
    return num_on_plane / (num_all + kDoubt * size * size);
  }

 private:
  struct Counts {
    int all = 0;
    int on_plane = 0;
  };

  Counts Around(int row, int col, int radius) const {
    const int top = std::max(row - radius, box_.top);
    const int left = std::max(col - radius, box_.left);
    const int bottom = std::min(row + radius + 1, box_.bottom);
    const int right = std::min(col + radius + 1, box_.right);
    const Counts& a = At(top, left);
    const Counts& b = At(top, right);
    const Counts& c = At(bottom, left);
    const Counts& d = At(bottom, right);
    return {d.all - b.all - c.all + a.all,
            d.on_plane - b.on_plane - c.on_plane + a.on_plane};
  }

  // Sums over the pixels above `row` and to the left of `col`.
  Counts& At(int row, int col) {
    return sums_[static_cast<size_t>(row - box_.top) * stride_ + col -
                 box_.left];
  }
  const Counts& At(int row, int col) const {
    return const_cast<EstimateCounts*>(this)->At(row, col);
  }

  const Box box_;
  const int stride_;
  std::vector<Counts> sums_;
};

}  // namespace

void RemoveInconsistent(const std::vector<uint8_t>& consistent, int num_sources,
                        int min_num_consistent, Map<float>* depth) {
  const size_t mask_bytes = ConsistencyMaskBytes(num_sources);
  for (size_t i = 0; i < depth->size(); ++i) {
    size_t count = 0;
    for (size_t k = 0; k < mask_bytes; ++k) {
      count += std::bitset<8>(consistent[i * mask_bytes + k]).count();
    }
    if (count < static_cast<size_t>(std::max(min_num_consistent, 0))) {
      depth->data()[i] = 0;
    }
  }
}

LocalPlanes FindLocalPlanes(const Problem& problem, const RefCamera& camera,
                            const Map<float>& depth,
                            const Segmentation& segmentation, int radius) {
  const Map<uint16_t>& labels = segmentation.superpixels.labels;
  LocalPlanes result;
  result.depth = Map<float>(labels.width(), labels.height());
  result.normal = Map<Vec3>(labels.width(), labels.height());
  result.agreement = Map<float>(labels.width(), labels.height());
  const std::vector<Box> boxes = BoundingBoxes(segmentation.superpixels);
  for (int label = 0; label < segmentation.superpixels.count(); ++label) {
    const FittedPlane& fitted = segmentation.planes[label];
    if (fitted.inlier_ratio == 0) {
      continue;
    }
    const Box& box = boxes[label];
    const EstimateCounts counts(camera, depth, segmentation, label, box);
    for (int row = box.top; row < box.bottom; ++row) {
      for (int col = box.left; col < box.right; ++col) {
        const size_t pixel = static_cast<size_t>(row) * labels.width() + col;
        if (labels.At(row, col) != label || problem.IsMasked(pixel)) {
          continue;
        }
        const DepthNormal plane = PlaneAt(fitted.plane, camera.Ray(row, col));
        if (plane.depth >= problem.depth_min &&
            plane.depth <= problem.depth_max) {
          result.depth.At(row, col) = plane.depth;
          result.normal.At(row, col) = plane.normal;
          result.agreement.At(row, col) = counts.Agreement(row, col, radius);
        }
      }
    }
  }
  return result;
}

void MergeLocalPlanes(const LocalPlanes& other, LocalPlanes* planes) {
  for (size_t i = 0; i < planes->agreement.size(); ++i) {
    if (other.agreement.data()[i] > planes->agreement.data()[i]) {
      planes->depth.data()[i] = other.depth.data()[i];
      planes->normal.data()[i] = other.normal.data()[i];
      planes->agreement.data()[i] = other.agreement.data()[i];
    }
  }
}

void CompleteWithPlanes(const TapaOptions& options, const LocalPlanes& planes,
                        const Map<float>& textureness,
                        const Map<float>& trusted, Map<float>* depth,
                        Map<Vec3>* normal, Map<uint8_t>* origin) {
  for (size_t i = 0; i < depth->size(); ++i) {
    const bool wanted =
        !(depth->data()[i] > 0) ||
        (!(trusted.data()[i] > 0) &&
         textureness.data()[i] < options.completion_textureness);
    if (wanted && planes.depth.data()[i] > 0 &&
        planes.agreement.data()[i] >= options.completion_agreement) {
      depth->data()[i] = planes.depth.data()[i];
      normal->data()[i] = planes.normal.data()[i];
      origin->data()[i] = kFromPlane;
    }
  }
}

}  // namespace tapa
