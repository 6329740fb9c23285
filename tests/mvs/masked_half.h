#ifndef TAPA_TESTS_MVS_MASKED_HALF_H_
#define TAPA_TESTS_MVS_MASKED_HALF_H_

#include <string>

#include "src/mvs/problem.h"
#include "tests/mvs/synthetic.h"

namespace tapa {

// A scene whose reference image is black in its lower half: once with that half
// masked, once without it, so that the border of the image is in its place.
// What is estimated above must be the same, bit for bit: nothing comes across.
class MaskedHalf {
 public:
  // geometric: with what the geometric pass needs.
  MaskedHalf(const SyntheticPlane& scene, bool geometric);
  MaskedHalf(const MaskedHalf&) = delete;
  MaskedHalf& operator=(const MaskedHalf&) = delete;

  const Problem& masked() const { return masked_; }
  const Problem& cut() const { return cut_; }

  // Names what of the two results is not so; empty: nothing.
  static std::string Difference(const Estimate& masked, const Estimate& cut);

 private:
  Map<uint8_t> image_;
  Map<uint8_t> cut_image_;
  Problem masked_;
  Problem cut_;
};

}  // namespace tapa

#endif  // TAPA_TESTS_MVS_MASKED_HALF_H_
