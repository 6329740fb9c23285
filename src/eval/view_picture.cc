#include "src/eval/view_picture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "src/eval/error_colors.h"
#include "src/pictures/color_map.h"
#include "src/pictures/drawing.h"

namespace tapa {
namespace {

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
  DrawDepthBar(metric ? "depth in metres" : "depth", range,
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
