#include "src/eval/pictures.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "src/eval/color_map.h"

namespace tapa {
namespace {

const cv::Scalar kPaper(255, 255, 255);
const cv::Scalar kInk(40, 40, 40);
// Pixels between panels and around them.
constexpr int kGap = 14;
constexpr int kCaptionHeight = 34;
constexpr int kLineHeight = 30;
// Largest panel: three of them and four gaps make 2000 pixels.
constexpr int kMaxPanelSide = (2000 - 4 * kGap) / 3;
// Legend of a smaller panel would not be legible.
constexpr int kMinPanelWidth = 420;
constexpr int kLegendHeight = 300;
// Above this width a legend has its scales beside its text.
constexpr int kWideLegend = 900;

struct Panel {
  std::string caption;
  cv::Mat image;
};

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

// The largest scale up to `scale` at which the text is at most `width` wide.
double FittingScale(const std::string& text, double scale, int width) {
  return std::min(scale, scale * width / std::max(TextWidth(text, scale), 1));
}

cv::Size PanelSize(const cv::Size& photograph) {
  const double width = std::max(photograph.width, kMinPanelWidth);
  const double height = width * photograph.height / photograph.width;
  const double shrink =
      std::min({1.0, kMaxPanelSide / width, kMaxPanelSide / height});
  return {std::max(1, static_cast<int>(std::lround(width * shrink))),
          std::max(1, static_cast<int>(std::lround(height * shrink)))};
}

cv::Mat Resize(const cv::Mat& image, const cv::Size& size, bool smooth) {
  const bool shrinks = size.width < image.cols || size.height < image.rows;
  const int enlarge = smooth ? cv::INTER_CUBIC : cv::INTER_NEAREST;
  cv::Mat resized;
  cv::resize(image, resized, size, 0, 0, shrinks ? cv::INTER_AREA : enlarge);
  return resized;
}

// "0.85", "2.5", "130": three digits, without an exponent.
std::string Number(double value) {
  const int digits =
      std::clamp(2 - static_cast<int>(std::floor(std::log10(value))), 0, 6);
  char text[64];
  std::snprintf(text, sizeof(text), "%.*f", digits, value);
  return text;
}

// A bar of colours from left (0) to right (1) with a heading above it and
// labels below.
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

// A small square of one colour with its meaning. Returns its width.
int DrawSwatch(const cv::Vec3b& color, const std::string& text,
               const cv::Point& corner, cv::Mat* canvas) {
  constexpr int kSide = 16;
  cv::rectangle(*canvas, {corner.x, corner.y, kSide, kSide}, color, cv::FILLED);
  DrawText(text, {corner.x + kSide + 8, corner.y + 14}, 0.5, canvas);
  return kSide + 8 + TextWidth(text, 0.5) + 24;
}

// The colours of all normals that face the camera, as on a ball.
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

// Title, notes and scales of colour, within kLegendHeight pixels.
void DrawLegend(const ViewPicture& view, const DepthRange& range,
                const cv::Rect& area, cv::Mat* canvas) {
  const bool wide = area.width > kWideLegend;
  const int columns = wide ? 2 : 1;
  const int width = (area.width - (columns - 1) * 3 * kGap) / columns;
  const int ball = view.normal != nullptr ? 62 : 0;

  int y = area.y + 22;
  DrawText(view.title, {area.x, y},
           FittingScale(view.title, 0.75, width - 2 * ball - kGap), canvas);
  for (const std::string& note : view.notes) {
    y += kLineHeight - 4;
    DrawText(note, {area.x, y}, FittingScale(note, 0.55, width - 2 * ball),
             canvas);
  }
  if (ball > 0) {
    const int radius = 36;
    const cv::Point center(area.x + width - radius - 4, area.y + radius + 4);
    DrawNormalBall(center, radius, canvas);
    const std::string text = "normals";
    DrawText(text,
             {center.x - TextWidth(text, 0.5) / 2, center.y + radius + 18}, 0.5,
             canvas);
  }

  const cv::Point scales =
      wide ? cv::Point(area.x + width + 3 * kGap, area.y)
           : cv::Point(area.x, std::max(y + 18, area.y + 2 * ball - 16));
  y = scales.y;
  const bool metric = view.ground_truth != nullptr;
  const double near = 1.0 / range.near;
  const double far = 1.0 / range.far;
  DrawColorBar(
      metric ? "depth in metres" : "depth",
      [&](float share) {
        return DepthColor(static_cast<float>(1 / (near + share * (far - near))),
                          range);
      },
      {Number(range.near), Number(2 / (near + far)), Number(range.far)},
      {scales.x, y, width, 0}, canvas);
  y += 74;
  if (view.ground_truth != nullptr) {
    DrawColorBar(
        "error in % of the true depth",
        [](float share) {
          return ErrorColor(kLeastError *
                            std::pow(kMostError / kLeastError, share));
        },
        {"0.1", "0.3", "1", "3", "10"}, {scales.x, y, width, 0}, canvas);
    y += 74;
  }
  int x = scales.x;
  x += DrawSwatch(kNoEstimateColor, "no estimate", {x, y}, canvas);
  if (view.ground_truth != nullptr) {
    DrawSwatch(kNoMeasurementColor, "no measurement", {x, y}, canvas);
  }
}

}  // namespace

cv::Mat DrawView(const ViewPicture& view) {
  if (view.photograph.empty() || view.photograph.type() != CV_8UC3 ||
      view.depth == nullptr || view.depth->empty()) {
    throw std::invalid_argument("a picture needs a photograph and a depth map");
  }
  const cv::Size size = PanelSize(view.photograph.size());
  const DepthRange range = RobustDepthRange(
      view.ground_truth != nullptr ? *view.ground_truth : *view.depth);

  std::vector<Panel> panels;
  panels.push_back({"Photograph", Resize(view.photograph, size, true)});
  panels.push_back(
      {"Depth", Resize(ColorDepth(*view.depth, range), size, false)});
  if (view.normal != nullptr) {
    panels.push_back(
        {"Normals", Resize(ColorNormals(*view.normal), size, false)});
  }
  if (view.ground_truth != nullptr) {
    // Below the estimated depth, so that the eye can compare.
    if (view.normal != nullptr) panels.push_back({"", cv::Mat()});
    panels.push_back(
        {"Ground truth",
         Resize(ColorDepth(*view.ground_truth, range, kNoMeasurementColor),
                size, false)});
    panels.push_back(
        {"Error",
         Resize(ColorError(*view.depth, *view.ground_truth), size, false)});
  }

  const int count = static_cast<int>(panels.size());
  const int columns = count == 2 || count == 4 ? 2 : 3;
  const int rows = (count + columns - 1) / columns;
  // The legend takes the free place where there is one, else a strip below.
  const auto free =
      std::find_if(panels.begin(), panels.end(),
                   [](const Panel& panel) { return panel.image.empty(); });
  const bool strip = free == panels.end() || size.height < kLegendHeight ||
                     size.width < kMinPanelWidth;
  const int panel_height = kCaptionHeight + size.height + kGap;
  const int width =
      std::max(kGap + columns * (size.width + kGap), kMinPanelWidth + 2 * kGap);
  const int panels_height = rows * panel_height;
  int legend_height = 0;
  if (strip) {
    legend_height = width - 2 * kGap <= kWideLegend ? kLegendHeight
                    : view.ground_truth != nullptr  ? 200
                                                    : 130;
  }
  cv::Mat canvas(panels_height + legend_height, width, CV_8UC3, kPaper);

  for (int i = 0; i < count; ++i) {
    const int x = kGap + i % columns * (size.width + kGap);
    const int y = i / columns * panel_height;
    const bool is_free = panels[i].image.empty();
    if (!is_free) {
      DrawText(panels[i].caption, {x, y + 25}, 0.65, &canvas);
      panels[i].image.copyTo(
          canvas({x, y + kCaptionHeight, size.width, size.height}));
    } else if (!strip) {
      DrawLegend(view, range, {x, y + kCaptionHeight, size.width, size.height},
                 &canvas);
    }
  }
  if (strip) {
    DrawLegend(
        view, range,
        {kGap, panels_height + kGap, width - 2 * kGap, legend_height - kGap},
        &canvas);
  }
  return canvas;
}

}  // namespace tapa
