#include "src/mvs/tapa/speckles.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "src/base/depth.h"

namespace tapa {
namespace {

// Disjoint sets of pixels, with path halving.
class Regions {
 public:
  explicit Regions(int num_pixels) : parent_(num_pixels), size_(num_pixels, 1) {
    for (int i = 0; i < num_pixels; ++i) {
      parent_[i] = i;
    }
  }

  void Unite(int a, int b) {
    a = Root(a);
    b = Root(b);
    if (a == b) {
      return;
    }
    if (size_[a] < size_[b]) {
      std::swap(a, b);
    }
    parent_[b] = a;
    size_[a] += size_[b];
  }

  int Size(int pixel) { return size_[Root(pixel)]; }

 private:
  int Root(int i) {
    while (parent_[i] != i) {
      parent_[i] = parent_[parent_[i]];
      i = parent_[i];
    }
    return i;
  }

  std::vector<int> parent_;
  std::vector<int> size_;
};

bool AreContinuous(const Continuity& continuity, float a, float b) {
  const float limit =
      std::max(continuity.step, continuity.share * std::min(a, b));
  return std::abs(a - b) <= limit;
}

}  // namespace

void RemoveSpeckles(const Continuity& continuity, int max_size,
                    Map<float>* depth) {
  const int width = depth->width();
  const int num_pixels = static_cast<int>(depth->size());
  float* depths = depth->data();
  Regions regions(num_pixels);
  const auto connect = [&](int pixel, int other) {
    if (IsDepth(depths[other]) &&
        AreContinuous(continuity, depths[pixel], depths[other])) {
      regions.Unite(pixel, other);
    }
  };
  for (int i = 0; i < num_pixels; ++i) {
    if (IsDepth(depths[i])) {
      if (i % width > 0) connect(i, i - 1);
      if (i >= width) connect(i, i - width);
    }
  }
  for (int i = 0; i < num_pixels; ++i) {
    if (!IsDepth(depths[i]) || regions.Size(i) <= max_size) {
      depths[i] = 0;
    }
  }
}

}  // namespace tapa
