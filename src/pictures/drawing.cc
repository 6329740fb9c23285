#include "src/pictures/drawing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <opencv2/imgproc.hpp>

namespace tapa {

void DrawText(const std::string& text, const cv::Point& baseline, double scale,
              cv::Mat* canvas) {
  cv::putText(*canvas, text, baseline, cv::FONT_HERSHEY_DUPLEX, scale, kInk, 1,
              cv::LINE_AA);
}

int TextWidth(const std::string& text, double scale) {
  int baseline = 0;
  return cv::getTextSize(text, cv::FONT_HERSHEY_DUPLEX, scale, 1, &baseline)
      .width;
}

double FittingScale(const std::string& text, double scale, int width) {
  return std::min(scale, scale * width / std::max(TextWidth(text, scale), 1));
}

std::string Number(double value) {
  const int digits =
      std::clamp(2 - static_cast<int>(std::floor(std::log10(value))), 0, 6);
  char text[64];
  std::snprintf(text, sizeof(text), "%.*f", digits, value);
  return text;
}

void DrawColorBar(const std::string& heading,
                  const std::function<cv::Vec3b(float)>& color,
                  const std::vector<std::string>& labels, const cv::Rect& area,
                  cv::Mat* canvas) {
  constexpr int kBarHeight = 18;
  DrawText(heading, {area.x, area.y + 16}, 0.55, canvas);
  const int top = area.y + 26;
  for (int col = 0; col < area.width; ++col) {
    const cv::Vec3b value =
        color(area.width > 1 ? static_cast<float>(col) / (area.width - 1) : 0);
    cv::line(*canvas, {area.x + col, top}, {area.x + col, top + kBarHeight - 1},
             cv::Scalar(value[0], value[1], value[2]));
  }
  for (size_t i = 0; i < labels.size(); ++i) {
    const double share =
        labels.size() > 1 ? static_cast<double>(i) / (labels.size() - 1) : 0;
    const int width = TextWidth(labels[i], 0.5);
    const int left = static_cast<int>(share * (area.width - width));
    DrawText(labels[i], {area.x + left, top + kBarHeight + 18}, 0.5, canvas);
  }
}

void DrawDepthBar(const std::string& heading, const DepthRange& range,
                  const cv::Rect& area, cv::Mat* canvas) {
  const double near = 1.0 / range.near;
  const double far = 1.0 / range.far;
  DrawColorBar(
      heading,
      [&](float share) {
        return DepthColor(static_cast<float>(1 / (near + share * (far - near))),
                          range);
      },
      {Number(range.near), Number(2 / (near + far)), Number(range.far)}, area,
      canvas);
}

int DrawSwatch(const cv::Vec3b& color, const std::string& text,
               const cv::Point& corner, cv::Mat* canvas) {
  constexpr int kSide = 16;
  cv::rectangle(*canvas, {corner.x, corner.y, kSide, kSide}, color, cv::FILLED);
  DrawText(text, {corner.x + kSide + 8, corner.y + 14}, 0.5, canvas);
  return kSide + 8 + TextWidth(text, 0.5) + 24;
}

void DrawNormalBall(const cv::Point& center, int radius, cv::Mat* canvas) {
  for (int y = -radius; y <= radius; ++y) {
    for (int x = -radius; x <= radius; ++x) {
      const float nx = static_cast<float>(x) / radius;
      const float ny = static_cast<float>(y) / radius;
      const float nz_squared = 1 - nx * nx - ny * ny;
      if (nz_squared < 0) continue;
      canvas->at<cv::Vec3b>(center.y + y, center.x + x) =
          NormalColor({nx, ny, -std::sqrt(nz_squared)});
    }
  }
}

}  // namespace tapa
