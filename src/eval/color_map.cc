#include "src/eval/color_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "src/eval/depth_map_score.h"

namespace tapa {
namespace {

bool IsDepth(float value) { return std::isfinite(value) && value > 0; }

// The 256 colours of the TURBO scale, blue to red.
std::vector<cv::Vec3b> TurboColors() {
  cv::Mat levels(1, 256, CV_8UC1);
  for (int i = 0; i < 256; ++i)
    levels.at<uint8_t>(0, i) = static_cast<uint8_t>(i);
  cv::Mat colors;
  cv::applyColorMap(levels, colors, cv::COLORMAP_TURBO);
  return std::vector<cv::Vec3b>(colors.begin<cv::Vec3b>(),
                                colors.end<cv::Vec3b>());
}

cv::Vec3b Blend(const cv::Vec3b& a, const cv::Vec3b& b, float share_of_b) {
  cv::Vec3b blend;
  for (int i = 0; i < 3; ++i) {
    blend[i] =
        cv::saturate_cast<uint8_t>(a[i] + share_of_b * (float(b[i]) - a[i]));
  }
  return blend;
}

}  // namespace

DepthRange RobustDepthRange(const Map<float>& depth) {
  std::vector<float> values;
  for (size_t i = 0; i < depth.size(); ++i) {
    if (IsDepth(depth.data()[i])) values.push_back(depth.data()[i]);
  }
  if (values.empty()) return {};
  const auto percentile = [&values](int percent) {
    const auto nth = values.begin() + (values.size() - 1) * percent / 100;
    std::nth_element(values.begin(), nth, values.end());
    return *nth;
  };
  return {percentile(2), percentile(98)};
}

cv::Vec3b DepthColor(float depth, const DepthRange& range) {
  static const std::vector<cv::Vec3b> colors = TurboColors();
  // In double, where no depth of a float has an infinite inverse.
  const double far = 1.0 / range.far;
  const double near = 1.0 / range.near;
  const double nearness =
      near > far ? std::clamp((1.0 / depth - far) / (near - far), 0.0, 1.0)
                 : 0.5;
  // The darkest ends of the scale would look like missing estimates.
  return colors[static_cast<size_t>(std::lround(10 + 235 * nearness))];
}

cv::Mat ColorDepth(const Map<float>& depth, const DepthRange& range,
                   const cv::Vec3b& missing) {
  cv::Mat image(depth.height(), depth.width(), CV_8UC3);
  for (int row = 0; row < depth.height(); ++row) {
    for (int col = 0; col < depth.width(); ++col) {
      const float value = depth.At(row, col);
      image.at<cv::Vec3b>(row, col) =
          IsDepth(value) ? DepthColor(value, range) : missing;
    }
  }
  return image;
}

cv::Vec3b NormalColor(const Vec3& normal) {
  const float squared_norm = Dot(normal, normal);
  if (!(squared_norm > 0)) return kNoEstimateColor;
  const auto channel = [](float value) {
    return cv::saturate_cast<uint8_t>(127.5f * (1 + value));
  };
  return {channel(-normal.z), channel(-normal.y), channel(normal.x)};
}

cv::Mat ColorNormals(const Map<Vec3>& normal) {
  cv::Mat image(normal.height(), normal.width(), CV_8UC3);
  for (int row = 0; row < normal.height(); ++row) {
    for (int col = 0; col < normal.width(); ++col) {
      image.at<cv::Vec3b>(row, col) = NormalColor(normal.At(row, col));
    }
  }
  return image;
}

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
