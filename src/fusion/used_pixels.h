#ifndef TAPA_SRC_FUSION_USED_PIXELS_H_
#define TAPA_SRC_FUSION_USED_PIXELS_H_

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tapa {

// A bit per pixel of a view: whether a point of another view shows it already.
// Any number of threads may mark pixels at a time.
class UsedPixels {
 public:
  UsedPixels(int width, int height);

  void Mark(int row, int col);
  bool IsMarked(int row, int col) const;

 private:
  size_t Index(int row, int col) const {
    return static_cast<size_t>(row) * width_ + col;
  }

  const int width_;
  std::vector<std::atomic<uint32_t>> words_;
};

}  // namespace tapa

#endif  // TAPA_SRC_FUSION_USED_PIXELS_H_
