#ifndef TAPA_SRC_EVAL_ERROR_HISTOGRAM_H_
#define TAPA_SRC_EVAL_ERROR_HISTOGRAM_H_

#include <cstdint>
#include <vector>

namespace tapa {

// The median of any number of values in 2 MB of memory, to within 0.05 % of the
// true one. Bins are 1/2048 of a power of two wide and know the mean of their
// values, so that the median is exact where a bin holds one value only.
class ErrorHistogram {
 public:
  // Takes a value of 0 or more. What is below 1e-9 counts as 0, what is above
  // 1e9 as one bin.
  void Add(float value);

  // Of an even number of values the mean of the middle two; not a number if
  // there are no values.
  double Median() const;

 private:
  struct Bin {
    int64_t count = 0;
    double sum = 0;
  };

  // Mean of the bin that holds the value of this rank.
  double ValueAt(int64_t rank) const;

  int64_t count_ = 0;
  // Empty until there is a value.
  std::vector<Bin> bins_;
};

}  // namespace tapa

#endif  // TAPA_SRC_EVAL_ERROR_HISTOGRAM_H_
