#include "src/pictures/color_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "src/base/depth.h"

namespace tapa {
namespace {

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

}  // namespace tapa
