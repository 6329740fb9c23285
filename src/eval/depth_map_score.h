#ifndef TAPA_SRC_EVAL_DEPTH_MAP_SCORE_H_
#define TAPA_SRC_EVAL_DEPTH_MAP_SCORE_H_

#include <cstdint>
#include <limits>
#include <vector>

#include "src/base/map.h"
#include "src/eval/error_histogram.h"
#include "src/eval/tolerance.h"

namespace tapa {

// Agreement of depth maps with measured depth.
//
// An estimate is a pixel of the depth map with a positive, finite depth; a
// measurement is such a pixel of the ground truth. The two may differ in size:
// a pixel corresponds to that one of the other map in which its centre lies.
// An estimate d is within a tolerance of a measurement g if |d - g| <= tolerance,
// where a relative tolerance is taken of g.
//
// Shares are 0 to 1, and not a number where there is nothing to share.
struct DepthMapScore {
  // Number of depth maps.
  int64_t num_maps = 0;
  // Pixels of the depth maps, and those with an estimate.
  int64_t num_pixels = 0;
  int64_t num_estimates = 0;
  // Pixels whose depth is negative, infinite or not a number. They count as
  // pixels without an estimate.
  int64_t num_invalid = 0;
  // Measurements, and those whose corresponding pixel has an estimate.
  int64_t num_measurements = 0;
  int64_t num_measurements_covered = 0;
  // Estimates whose corresponding pixel has a measurement.
  int64_t num_estimates_measured = 0;
  // For each tolerance: measurements within it of their estimate ...
  std::vector<int64_t> num_complete;
  // ... and estimates within it of their measurement.
  std::vector<int64_t> num_accurate;
  // Median error of the estimates with a measurement: |d - g| in metres and
  // |d - g| / g. Of an even number, the mean of the middle two. Exact for one
  // map, to within 0.05 % for several.
  double median_absolute_error = std::numeric_limits<double>::quiet_NaN();
  double median_relative_error = std::numeric_limits<double>::quiet_NaN();

  // Share of all pixels that have an estimate.
  double Coverage() const;
  // Share of the measurements that have an estimate.
  double MeasurementCoverage() const;
  // Share of the measurements that are complete, at tolerance i.
  double Completeness(int i) const;
  // Share of the estimates with a measurement that are accurate, at tolerance i.
  double Accuracy(int i) const;
  // Harmonic mean of the two, 0 if completeness is 0.
  double F1(int i) const;
};

// Scores depth maps one after the other (scene units are metres) and all of
// them together, where every pixel counts the same. Takes 4 MB, however many
// maps there are.
class DepthMapScorer {
 public:
  explicit DepthMapScorer(std::vector<Tolerance> tolerances);

  // Scores one depth map and adds it to the overall score. If a mask is given,
  // which has the size of the ground truth, only pixels with a mask other than
  // 0 count, in the depth map those that correspond to one. Throws
  // std::invalid_argument if a map is empty, if one map cannot be the other one
  // scaled and rounded to whole pixels, or if the mask has another size.
  DepthMapScore Add(const Map<float>& depth, const Map<float>& ground_truth,
                    const Map<uint8_t>* mask = nullptr);

  // Score of all maps that were added.
  DepthMapScore Overall() const;

 private:
  std::vector<Tolerance> tolerances_;
  DepthMapScore overall_;
  ErrorHistogram absolute_errors_;
  ErrorHistogram relative_errors_;
};

// Where the pixel centres of a row of `size` pixels lie in a row of
// `other_size` pixels that covers the same length.
std::vector<int> CorrespondingPixels(int size, int other_size);

}  // namespace tapa

#endif  // TAPA_SRC_EVAL_DEPTH_MAP_SCORE_H_
