#include "src/mvs/cpu/source_image.h"

namespace tapa {

SourceImage::SourceImage(const Map<uint8_t>& image)
    : width_(image.width()), height_(image.height()) {
  // One more element than rows * stride: the load of the last pair reads two.
  pairs_ =
      MakeAligned<uint16_t>(static_cast<size_t>(height_ + 2) * stride() + 1);
  for (int row = 0; row < height_ + 2; ++row) {
    const uint8_t* top =
        row > 0 && row <= height_ ? image.Row(row - 1) : nullptr;
    const uint8_t* bottom = row < height_ ? image.Row(row) : nullptr;
    uint16_t* pairs = pairs_.get() + static_cast<size_t>(row) * stride() + 1;
    for (int col = 0; col < width_; ++col) {
      pairs[col] = static_cast<uint16_t>((top ? top[col] : 0) |
                                         (bottom ? bottom[col] << 8 : 0));
    }
  }
}

}  // namespace tapa
