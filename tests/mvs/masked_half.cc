#include "tests/mvs/masked_half.h"

#include <algorithm>
#include <cstring>

namespace tapa {
namespace {

// The upper rows of a map.
template <typename T>
Map<T> Cut(const Map<T>& map, int height) {
  Map<T> result(map.width(), map.empty() ? 0 : height);
  std::copy_n(map.data(), result.size(), result.data());
  return result;
}

// Whether elements [0, count) are the same bit for bit.
template <typename Values>
bool StartsWith(const Values& values, const Values& start) {
  return values.size() >= start.size() &&
         std::memcmp(values.data(), start.data(),
                     start.size() * sizeof(start.data()[0])) == 0;
}

// Whether all elements from `begin` on are 0.
template <typename Values>
bool IsZeroFrom(const Values& values, size_t begin) {
  const auto* bytes = reinterpret_cast<const char*>(values.data() + begin);
  const size_t count = (values.size() - begin) * sizeof(values.data()[0]);
  return std::all_of(bytes, bytes + count, [](char c) { return c == 0; });
}

}  // namespace

MaskedHalf::MaskedHalf(const SyntheticPlane& scene, bool geometric)
    : image_(*scene.problem().reference.image),
      masked_(geometric ? scene.GeometricProblem() : scene.problem()) {
  const int height = image_.height() / 2;
  cut_image_ = Cut(image_, height);
  std::fill(image_.data() + cut_image_.size(), image_.data() + image_.size(),
            0);
  cut_ = masked_;
  cut_.reference.image = &cut_image_;
  cut_.depth = Cut(masked_.depth, height);
  cut_.normal = Cut(masked_.normal, height);
  masked_.reference.image = &image_;
  masked_.mask = Map<uint8_t>(image_.width(), image_.height(), 1);
  std::fill_n(masked_.mask.data(), cut_image_.size(), 0);
}

std::string MaskedHalf::Difference(const Estimate& masked,
                                   const Estimate& cut) {
  std::string names;
  const auto compare = [&names](const auto& actual, const auto& expected,
                                const char* name) {
    if (!StartsWith(actual, expected) || !IsZeroFrom(actual, expected.size())) {
      names += std::string(name) + " ";
    }
  };
  compare(masked.depth, cut.depth, "depth");
  compare(masked.normal, cut.normal, "normal");
  compare(masked.selection_prob, cut.selection_prob, "selection_prob");
  compare(masked.consistent, cut.consistent, "consistent");
  return names;
}

}  // namespace tapa
