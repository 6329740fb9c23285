#ifndef TAPA_SRC_COLMAP_PRIOR_FIT_H_
#define TAPA_SRC_COLMAP_PRIOR_FIT_H_

#include <vector>

#include "src/base/map.h"

namespace tapa {

// Depth maps from elsewhere are in a unit of their own, and networks that see a
// single photograph know neither scale nor shift, of depth or of its inverse.
// Sparse points of a view say both. What is wrong with the rest changes slowly
// across the image, so that near such points they say that, too.

// What a prior (in its own unit) and a sparse point (in scene units) say of the
// same place, (x, y) in shares of the image's width and height.
struct PriorSample {
  double prior = 0;
  double depth = 0;
  double x = 0;
  double y = 0;
};

// depth = scale * prior + shift, or 1 / depth if it is inverse, times a factor
// for the place.
struct PriorFit {
  bool is_inverse = false;
  double scale = 0;
  double shift = 0;
  // Share of the samples that fit without such factors, 0 to 1.
  double share = 0;
  // Logarithms of the factors: from corner to corner, evenly spaced. Empty: no
  // factors.
  Map<float> correction;

  // Whether it is one of this view. Maps of other photographs of the scene fit
  // up to three quarters of the points (docs/results.md), and cost more than a
  // poor one brings.
  bool IsGood() const { return share >= kMinShare; }
  static constexpr double kMinShare = 0.8;

  // Both in scene units; 0 where it is none.
  float UncorrectedDepth(double prior) const;
  float Depth(double prior, double x, double y) const;
};

// The smallest number of samples that something is fitted to.
constexpr int kMinPriorSamples = 20;

// Of all fits that grow with the prior, the one that most samples fit: to 10 %
// of their depth, and to half of the median error that one depth for all of
// them would have; with the factors that correct it. All values are positive
// and finite. The result depends on nothing but the samples and their order.
PriorFit FitPrior(const std::vector<PriorSample>& samples);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_PRIOR_FIT_H_
