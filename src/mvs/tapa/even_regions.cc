#include "src/mvs/tapa/even_regions.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "src/mvs/tapa/textureness.h"

namespace tapa {
namespace {

constexpr double kSmoothing = 2;
constexpr int kBridge = 2;
constexpr float kReach = 8;
constexpr double kMinShare = 0.002;

cv::Mat Channel(const Map<Rgb>& color, int channel) {
  // OpenCV does not write to what it reads.
  const cv::Mat all(color.height(), color.width(), CV_8UC3,
                    const_cast<Rgb*>(color.data()));
  cv::Mat one;
  cv::extractChannel(all, one, channel);
  return one;
}

// 255 where a region may be.
cv::Mat FindEven(const Map<float>& steps, const Map<float>& textureness,
                 float max_step) {
  cv::Mat even(steps.height(), steps.width(), CV_8U);
  for (int row = 0; row < even.rows; ++row) {
    for (int col = 0; col < even.cols; ++col) {
      const bool is_even =
          textureness.At(row, col) < kTextured && steps.At(row, col) < max_step;
      even.at<uint8_t>(row, col) = is_even ? 255 : 0;
    }
  }
  const int size = 2 * kBridge + 1;
  cv::erode(even, even,
            cv::getStructuringElement(cv::MORPH_ELLIPSE, {size, size}));
  return even;
}

// Connected pixels by numbers from 1 on, without small ones; changes `even` to
// what is left. Returns how many.
int LabelLargeOnes(cv::Mat* even, cv::Mat* labels) {
  cv::Mat stats;
  cv::Mat centroids;
  const int num_components =
      cv::connectedComponentsWithStats(*even, *labels, stats, centroids, 4);
  const double min_size = kMinShare * static_cast<double>(even->total());
  std::vector<int> numbers(std::max(num_components, 1), EvenRegions::kNone);
  int count = 0;
  for (int k = 1; k < num_components; ++k) {
    if (stats.at<int>(k, cv::CC_STAT_AREA) >= min_size) {
      numbers[k] = ++count;
    }
  }
  for (int row = 0; row < even->rows; ++row) {
    for (int col = 0; col < even->cols; ++col) {
      int& label = labels->at<int>(row, col);
      label = numbers[label];
      even->at<uint8_t>(row, col) = label == EvenRegions::kNone ? 0 : 255;
    }
  }
  return count;
}

}  // namespace

Map<float> MeasureSteps(const Map<Rgb>& color) {
  // Sobel's sum over a gradient of 1, and the gradient of a smoothed step of 1.
  const double scale = std::sqrt(2 * CV_PI) * kSmoothing / 8;
  Map<float> steps(color.width(), color.height());
  cv::Mat highest(steps.height(), steps.width(), CV_32F, steps.data());
  for (int channel = 0; channel < 3 && !color.empty(); ++channel) {
    cv::Mat smooth;
    Channel(color, channel).convertTo(smooth, CV_32F);
    cv::GaussianBlur(smooth, smooth, cv::Size(), kSmoothing);
    cv::Mat x;
    cv::Mat y;
    cv::Sobel(smooth, x, CV_32F, 1, 0, 3, scale);
    cv::Sobel(smooth, y, CV_32F, 0, 1, 3, scale);
    cv::magnitude(x, y, x);
    cv::max(highest, x, highest);
  }
  return steps;
}

EvenRegions FindEvenRegions(const Map<float>& steps,
                            const Map<float>& textureness, float max_step) {
  EvenRegions regions;
  regions.labels =
      Map<int32_t>(steps.width(), steps.height(), EvenRegions::kNone);
  if (steps.empty()) {
    return regions;
  }
  cv::Mat even = FindEven(steps, textureness, max_step);
  cv::Mat labels;
  regions.count = LabelLargeOnes(&even, &labels);
  if (regions.count == 0) {
    return regions;
  }
  // Of the nearest pixel of a region: its distance and a number of its own.
  cv::Mat distance;
  cv::Mat nearest;
  cv::distanceTransform(255 - even, distance, nearest, cv::DIST_L2, 5,
                        cv::DIST_LABEL_PIXEL);
  std::vector<int32_t> label_of(steps.size() + 1, EvenRegions::kNone);
  for (int row = 0; row < even.rows; ++row) {
    for (int col = 0; col < even.cols; ++col) {
      if (even.at<uint8_t>(row, col) != 0) {
        label_of[nearest.at<int>(row, col)] = labels.at<int>(row, col);
      }
    }
  }
  for (int row = 0; row < even.rows; ++row) {
    for (int col = 0; col < even.cols; ++col) {
      if (distance.at<float>(row, col) <= kReach) {
        regions.labels.At(row, col) = label_of[nearest.at<int>(row, col)];
      }
    }
  }
  return regions;
}

}  // namespace tapa
