#ifndef TAPA_SRC_BASE_MAP_H_
#define TAPA_SRC_BASE_MAP_H_

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tapa {

// Dense two-dimensional array in row-major order; one element per pixel.
template <typename T>
class Map {
 public:
  Map() = default;
  Map(int width, int height, const T& value = T())
      : width_(width),
        height_(height),
        data_(static_cast<size_t>(width) * height, value) {}

  int width() const { return width_; }
  int height() const { return height_; }
  size_t size() const { return data_.size(); }
  bool empty() const { return data_.empty(); }

  T& At(int row, int col) { return data_[Index(row, col)]; }
  const T& At(int row, int col) const { return data_[Index(row, col)]; }

  T* data() { return data_.data(); }
  const T* data() const { return data_.data(); }
  T* Row(int row) { return data_.data() + Index(row, 0); }
  const T* Row(int row) const { return data_.data() + Index(row, 0); }

 private:
  size_t Index(int row, int col) const {
    return static_cast<size_t>(row) * width_ + col;
  }

  int width_ = 0;
  int height_ = 0;
  std::vector<T> data_;
};

// Colour of a pixel, 0 to 255.
struct Rgb {
  uint8_t r = 0;
  uint8_t g = 0;
  uint8_t b = 0;
};

}  // namespace tapa

#endif  // TAPA_SRC_BASE_MAP_H_
