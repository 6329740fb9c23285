#include "src/fusion/used_pixels.h"

namespace tapa {

UsedPixels::UsedPixels(int width, int height)
    : width_(width), words_((static_cast<size_t>(width) * height + 31) / 32) {
  for (auto& word : words_) {
    word.store(0, std::memory_order_relaxed);
  }
}

void UsedPixels::Mark(int row, int col) {
  const size_t index = Index(row, col);
  const uint32_t bit = uint32_t{1} << (index % 32);
  auto& word = words_[index / 32];
  if ((word.load(std::memory_order_relaxed) & bit) == 0) {
    word.fetch_or(bit, std::memory_order_relaxed);
  }
}

bool UsedPixels::IsMarked(int row, int col) const {
  const size_t index = Index(row, col);
  return (words_[index / 32].load(std::memory_order_relaxed) >> (index % 32)) &
         1;
}

}  // namespace tapa
