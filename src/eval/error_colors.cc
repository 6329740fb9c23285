#include "src/eval/error_colors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/eval/depth_map_score.h"
#include "src/pictures/color_map.h"

namespace tapa {
namespace {

bool IsDepth(float value) { return std::isfinite(value) && value > 0; }

cv::Vec3b Blend(const cv::Vec3b& a, const cv::Vec3b& b, float share_of_b) {
  cv::Vec3b blend;
  for (int i = 0; i < 3; ++i) {
    blend[i] =
        cv::saturate_cast<uint8_t>(a[i] + share_of_b * (float(b[i]) - a[i]));
  }
  return blend;
}

}  // namespace

cv::Vec3b ErrorColor(float relative_error) {
  static const std::array<cv::Vec3b, 5> colors = {
      cv::Vec3b(75, 115, 5), cv::Vec3b(95, 185, 100), cv::Vec3b(130, 235, 250),
      cv::Vec3b(60, 115, 240), cv::Vec3b(45, 10, 150)};
  const float position =
      std::log(std::max(relative_error, kLeastError) / kLeastError) /
      std::log(kMostError / kLeastError);
  const float scaled = std::clamp(position, 0.0f, 1.0f) * (colors.size() - 1);
  const size_t below = std::min(static_cast<size_t>(scaled), colors.size() - 2);
  return Blend(colors[below], colors[below + 1], scaled - below);
}

cv::Mat ColorError(const Map<float>& depth, const Map<float>& ground_truth) {
  const std::vector<int> rows =
      CorrespondingPixels(ground_truth.height(), depth.height());
  const std::vector<int> cols =
      CorrespondingPixels(ground_truth.width(), depth.width());
  cv::Mat image(ground_truth.height(), ground_truth.width(), CV_8UC3);
  for (int row = 0; row < ground_truth.height(); ++row) {
    for (int col = 0; col < ground_truth.width(); ++col) {
      const float measurement = ground_truth.At(row, col);
      const float estimate = depth.At(rows[row], cols[col]);
      cv::Vec3b color = kNoMeasurementColor;
      if (IsDepth(measurement)) {
        color = IsDepth(estimate)
                    ? ErrorColor(std::abs(estimate - measurement) / measurement)
                    : kNoEstimateColor;
      }
      image.at<cv::Vec3b>(row, col) = color;
    }
  }
  return image;
}

}  // namespace tapa
