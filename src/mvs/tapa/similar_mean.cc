#include "src/mvs/tapa/similar_mean.h"

#include <opencv2/core.hpp>
#include <opencv2/ximgproc/edge_filter.hpp>

namespace tapa {
namespace {

// OpenCV does not write to what it filters.
template <typename T>
cv::Mat MatOf(const Map<T>& map, int type) {
  return cv::Mat(map.height(), map.width(), type, const_cast<T*>(map.data()));
}

}  // namespace

Map<float> MeanOverSimilarPixels(const Map<uint8_t>& image,
                                 const Map<float>& values,
                                 const Map<float>& weights, int radius,
                                 double variance) {
  // Of what a filter's sum of weights may be taken for; its edges ring.
  constexpr float kMinWeight = 0.05f;
  cv::Mat guide;
  MatOf(image, CV_8U).convertTo(guide, CV_32F, 1 / 255.0);
  const cv::Ptr<cv::ximgproc::GuidedFilter> filter =
      cv::ximgproc::createGuidedFilter(guide, radius, variance);
  cv::Mat sums;
  cv::Mat counts;
  filter->filter(MatOf(values, CV_32F), sums);
  filter->filter(MatOf(weights, CV_32F), counts);
  Map<float> means = values;
  for (int row = 0; row < means.height(); ++row) {
    for (int col = 0; col < means.width(); ++col) {
      const float count = counts.at<float>(row, col);
      if (count > kMinWeight) {
        means.At(row, col) = sums.at<float>(row, col) / count;
      }
    }
  }
  return means;
}

}  // namespace tapa
