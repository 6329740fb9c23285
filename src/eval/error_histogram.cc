#include "src/eval/error_histogram.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace tapa {
namespace {

// Of the 23 bits of a float's fraction, those that choose no bin.
constexpr int kShift = 23 - 11;
constexpr float kLeast = 1e-9f;
constexpr float kMost = 1e9f;

// Order of the bits of positive floats is that of their values.
uint32_t BinOf(float value) {
  uint32_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  return bits >> kShift;
}

}  // namespace

void ErrorHistogram::Add(float value) {
  // The first bin is that of 0.
  static const uint32_t offset = BinOf(kLeast) - 1;
  if (bins_.empty()) bins_.resize(BinOf(kMost) - offset + 1);
  const bool zero = value < kLeast;
  Bin& bin = bins_[zero ? 0 : BinOf(std::min(value, kMost)) - offset];
  ++bin.count;
  if (!zero) bin.sum += value;
  ++count_;
}

double ErrorHistogram::Median() const {
  if (count_ == 0) return std::numeric_limits<double>::quiet_NaN();
  return 0.5 * (ValueAt((count_ - 1) / 2) + ValueAt(count_ / 2));
}

double ErrorHistogram::ValueAt(int64_t rank) const {
  for (const Bin& bin : bins_) {
    if (rank < bin.count) return bin.sum / static_cast<double>(bin.count);
    rank -= bin.count;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace tapa
