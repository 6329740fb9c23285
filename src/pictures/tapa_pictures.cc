#include "src/pictures/tapa_pictures.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "src/base/depth.h"
#include "src/mvs/sweep/hypotheses.h"
#include "src/pictures/color_map.h"
#include "src/pictures/drawing.h"

namespace tapa {
namespace {

// The order of TapaPictureNames.
enum Picture {
  kLegend,
  kPhotograph,
  kTextureness,
  kFineSuperpixels,
  kCoarseSuperpixels,
  kFinePlanes,
  kCoarsePlanes,
  kChosenHypotheses,
  kSweptDepth,
  kFilteredDepth,
  kPlaneAgreement,
  kOriginOfDepth,
  kFinalDepth,
  kFinalNormals,
};

// Between planes: also seen where there is none.
const cv::Vec3b kPlaneBorderColor(96, 96, 96);

struct Category {
  const char* name;
  // Blue, green, red. All can be told apart by the colour-blind (Okabe and Ito,
  // "Color Universal Design").
  cv::Vec3b color;
};

// By Hypothesis.
const Category kHypotheses[] = {
    {"kept", {90, 90, 90}},
    {"from the pixel before", {200, 200, 200}},
    {"random", {0, 94, 213}},
    {"random normal", {167, 121, 204}},
    {"random depth", {66, 228, 240}},
    {"prior", {178, 114, 0}},
    {"fine plane", {233, 180, 86}},
    {"coarse plane", {115, 158, 0}},
};
static_assert(std::size(kHypotheses) == kNumHypotheses, "one colour for each");

// By Origin.
const Category kOrigins[] = {
    {"no estimate", {0, 0, 0}},
    {"swept", {200, 200, 200}},
    {"plane", {233, 180, 86}},
    {"filled", {0, 159, 230}},
};
constexpr int kNumOrigins = kFilled + 1;
static_assert(std::size(kOrigins) == kNumOrigins, "one colour for each");

cv::Vec3b Grey(float share) {
  const uint8_t value = cv::saturate_cast<uint8_t>(255 * share);
  return {value, value, value};
}

// A picture with color(value) for every value of a map.
template <typename T, typename Color>
cv::Mat Paint(const Map<T>& map, const Color& color) {
  cv::Mat image(map.height(), map.width(), CV_8UC3);
  for (int row = 0; row < map.height(); ++row) {
    for (int col = 0; col < map.width(); ++col) {
      image.at<cv::Vec3b>(row, col) = color(map.At(row, col));
    }
  }
  return image;
}

cv::Mat PaintPhotograph(const Map<Rgb>& photograph) {
  return Paint(photograph, [](const Rgb& color) {
    return cv::Vec3b(color.b, color.g, color.r);
  });
}

// Not 0 at the pixels whose right or lower neighbour has another label, on both
// sides of the border in large photographs.
cv::Mat Borders(const Map<uint16_t>& labels) {
  cv::Mat borders(labels.height(), labels.width(), CV_8UC1, cv::Scalar(0));
  for (int row = 0; row < labels.height(); ++row) {
    for (int col = 0; col < labels.width(); ++col) {
      const uint16_t label = labels.At(row, col);
      const bool is_border =
          (col + 1 < labels.width() && labels.At(row, col + 1) != label) ||
          (row + 1 < labels.height() && labels.At(row + 1, col) != label);
      borders.at<uint8_t>(row, col) = is_border ? 255 : 0;
    }
  }
  constexpr int kLarge = 1200;
  if (std::max(labels.width(), labels.height()) > kLarge) {
    cv::dilate(borders, borders, cv::Mat::ones(2, 2, CV_8UC1));
  }
  return borders;
}

// Writes down the inlier ratios, each where its superpixel has most room.
void WriteInlierRatios(const Segmentation& segmentation, const cv::Mat& borders,
                       cv::Mat* image) {
  constexpr double kMinScale = 0.3;
  constexpr double kMaxScale = 1;
  const Map<uint16_t>& labels = segmentation.superpixels.labels;
  // The edge of the picture is a border, too.
  cv::Mat inside;
  cv::copyMakeBorder(255 - borders, inside, 1, 1, 1, 1, cv::BORDER_CONSTANT,
                     cv::Scalar(0));
  cv::Mat room;
  cv::distanceTransform(inside, room, cv::DIST_L2, 3);

  std::vector<float> most(segmentation.planes.size(), 0);
  std::vector<cv::Point> at(segmentation.planes.size());
  for (int row = 0; row < labels.height(); ++row) {
    for (int col = 0; col < labels.width(); ++col) {
      const uint16_t label = labels.At(row, col);
      const float distance = room.at<float>(row + 1, col + 1);
      if (distance > most[label]) {
        most[label] = distance;
        at[label] = {col, row};
      }
    }
  }
  for (size_t i = 0; i < segmentation.planes.size(); ++i) {
    const float ratio = segmentation.planes[i].inlier_ratio;
    if (!(ratio > 0)) {
      continue;
    }
    const std::string text = std::to_string(std::lround(100 * ratio));
    int baseline = 0;
    const cv::Size size =
        cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, 1, 1, &baseline);
    const double scale =
        std::min(kMaxScale, most[i] / std::hypot(size.width, size.height));
    if (scale < kMinScale) {
      continue;
    }
    const cv::Vec3b& below = image->at<cv::Vec3b>(at[i]);
    const bool is_bright =
        0.1 * below[0] + 0.6 * below[1] + 0.3 * below[2] > 90;
    cv::putText(*image, text,
                at[i] + cv::Point(cv::Point2d(-0.5 * scale * size.width,
                                              0.5 * scale * size.height)),
                cv::FONT_HERSHEY_SIMPLEX, scale,
                cv::Scalar::all(is_bright ? 0 : 255), 1, cv::LINE_AA);
  }
}

cv::Mat PaintPlanes(const Segmentation& segmentation) {
  std::vector<cv::Vec3b> colors;
  for (const FittedPlane& plane : segmentation.planes) {
    const bool is_there = plane.inlier_ratio > 0;
    colors.push_back(is_there ? NormalColor(plane.plane.normal) *
                                    std::min(plane.inlier_ratio, 1.0f)
                              : kNoEstimateColor);
  }
  const Map<uint16_t>& labels = segmentation.superpixels.labels;
  cv::Mat image =
      Paint(labels, [&colors](uint16_t label) { return colors[label]; });
  const cv::Mat borders = Borders(labels);
  WriteInlierRatios(segmentation, borders, &image);
  image.setTo(kPlaneBorderColor, borders);
  return image;
}

// "12 %", "0.4 %".
std::string Percent(double share) {
  char text[32];
  std::snprintf(text, sizeof(text), share < 0.0995 ? "%.1f %%" : "%.0f %%",
                100 * share);
  return text;
}

// Swatches of the categories with their shares of the map, in rows. Returns
// their height.
int DrawCategories(const Category* categories, int count,
                   const Map<uint8_t>& map, const cv::Rect& area,
                   cv::Mat* canvas) {
  constexpr int kRowHeight = 26;
  constexpr int kColumns = 3;
  std::vector<size_t> pixels(count, 0);
  for (size_t i = 0; i < map.size(); ++i) {
    if (map.data()[i] < count) {
      ++pixels[map.data()[i]];
    }
  }
  for (int i = 0; i < count; ++i) {
    const cv::Point corner(area.x + i % kColumns * area.width / kColumns,
                           area.y + i / kColumns * kRowHeight);
    DrawSwatch(categories[i].color,
               categories[i].name + std::string(", ") +
                   Percent(1.0 * pixels[i] / map.size()),
               corner, canvas);
  }
  return (count + kColumns - 1) / kColumns * kRowHeight;
}

// Draws only what some picture shows.
cv::Mat DrawLegend(const TapaView& view, const DepthRange& range) {
  constexpr int kWidth = 860;
  constexpr int kMargin = 20;
  constexpr int kTextHeight = 30;
  constexpr int kBarHeight = 78;
  constexpr int kBallRadius = 34;
  constexpr int kInnerWidth = kWidth - 2 * kMargin;
  const TapaRecord& record = *view.record;

  // Room for everything; what is left over is cut off.
  cv::Mat canvas(1000, kWidth, CV_8UC3, kPaper);
  int y = kMargin;
  const auto heading = [&](const std::string& text, double scale) {
    DrawText(text, {kMargin, y + 16}, FittingScale(text, scale, kInnerWidth),
             &canvas);
    y += kTextHeight;
  };
  heading(view.title + ", " + std::to_string(view.photograph->width()) + " x " +
              std::to_string(view.photograph->height()) + " pixels",
          0.7);
  y += 6;
  const bool has_agreement = !record.agreement.empty();
  const int bar_width = (kInnerWidth - 2 * kMargin) / 2;
  if (!record.textureness.empty()) {
    char least[32];
    std::snprintf(least, sizeof(least), "%.2g", view.min_textureness);
    DrawColorBar("textureness", Grey, {least, "1"}, {kMargin, y, bar_width, 0},
                 &canvas);
  }
  if (has_agreement) {
    DrawColorBar("agreement of planes", Grey, {"0", "0.5", "1"},
                 {kWidth - kMargin - bar_width, y, bar_width, 0}, &canvas);
  }
  if (!record.textureness.empty() || has_agreement) {
    y += kBarHeight;
  }
  DrawDepthBar("depth, in units of the scene; black: no estimate", range,
               {kMargin, y, kInnerWidth, 0}, &canvas);
  y += kBarHeight;

  DrawNormalBall({kMargin + kBallRadius, y + kBallRadius}, kBallRadius,
                 &canvas);
  const int text_x = kMargin + 2 * kBallRadius + kMargin;
  DrawText("normals, as on a ball seen from the camera", {text_x, y + 28}, 0.55,
           &canvas);
  DrawText(
      "planes: as bright as their inlier ratio; numbers: inlier ratio in %",
      {text_x, y + 54}, 0.55, &canvas);
  y += 2 * kBallRadius + kMargin;

  const cv::Rect area(kMargin, 0, kInnerWidth, 0);
  if (!record.chosen.empty()) {
    heading("hypotheses chosen in the last sweep, share of pixels", 0.55);
    y += DrawCategories(kHypotheses, kNumHypotheses, record.chosen,
                        area + cv::Point(0, y), &canvas) +
         kMargin / 2;
  }
  if (!record.origin.empty()) {
    heading("where the final depth comes from, share of pixels", 0.55);
    y += DrawCategories(kOrigins, kNumOrigins, record.origin,
                        area + cv::Point(0, y), &canvas);
  }
  return canvas.rowRange(0, y + kMargin / 2).clone();
}

cv::Vec3b ColorOf(const Category* categories, int count, int index) {
  return index >= 0 && index < count ? categories[index].color
                                     : kNoEstimateColor;
}

}  // namespace

const std::vector<std::string>& TapaPictureNames() {
  static const std::vector<std::string> names = {
      "00_legend",           "01_photograph",         "02_textureness",
      "03_fine_superpixels", "04_coarse_superpixels", "05_fine_planes",
      "06_coarse_planes",    "07_chosen_hypotheses",  "08_swept_depth",
      "09_filtered_depth",   "10_plane_agreement",    "11_origin",
      "12_final_depth",      "13_final_normals"};
  return names;
}

cv::Vec3b HypothesisColor(int hypothesis) {
  return ColorOf(kHypotheses, kNumHypotheses, hypothesis);
}

cv::Vec3b OriginColor(int origin) {
  return ColorOf(kOrigins, kNumOrigins, origin);
}

std::vector<NamedPicture> DrawTapaPictures(const TapaView& view) {
  if (view.photograph == nullptr || view.record == nullptr ||
      view.depth == nullptr || view.normal == nullptr ||
      view.photograph->empty()) {
    throw std::invalid_argument(
        "pictures need a photograph, a record and an estimate");
  }
  const Map<Rgb>& photograph = *view.photograph;
  const TapaRecord& record = *view.record;
  // Whether a part of the record is there.
  const auto has = [&photograph](const auto& map) {
    if (!map.empty() && (map.width() != photograph.width() ||
                         map.height() != photograph.height())) {
      throw std::invalid_argument(
          "photograph, record and estimate must have the same size");
    }
    return !map.empty();
  };
  if (!has(*view.depth) || !has(*view.normal)) {
    throw std::invalid_argument("an estimate is empty");
  }
  // Where nothing is left, its range would say nothing.
  DepthRange range = RobustDepthRange(*view.depth);
  const bool is_empty = std::none_of(
      view.depth->data(), view.depth->data() + view.depth->size(), IsDepth);
  if (is_empty && has(record.swept_depth)) {
    range = RobustDepthRange(record.swept_depth);
  }

  std::vector<NamedPicture> pictures;
  const auto add = [&pictures](Picture picture, const cv::Mat& image) {
    pictures.push_back({TapaPictureNames()[picture], image});
  };
  const cv::Mat photo = PaintPhotograph(photograph);
  add(kLegend, DrawLegend(view, range));
  add(kPhotograph, photo);
  if (has(record.textureness)) {
    const float least = std::min(view.min_textureness, 0.999f);
    add(kTextureness, Paint(record.textureness, [least](float textureness) {
          return Grey((textureness - least) / (1 - least));
        }));
  }
  const struct {
    const Segmentation* segmentation;
    Picture superpixels;
    Picture planes;
  } segmentations[] = {{&record.fine, kFineSuperpixels, kFinePlanes},
                       {&record.coarse, kCoarseSuperpixels, kCoarsePlanes}};
  for (const auto& each : segmentations) {
    if (has(each.segmentation->superpixels.labels)) {
      cv::Mat image = photo.clone();
      image.setTo(kBorderColor, Borders(each.segmentation->superpixels.labels));
      add(each.superpixels, image);
    }
  }
  for (const auto& each : segmentations) {
    const Segmentation& segmentation = *each.segmentation;
    // Planes are fitted between iterations: there may have been one only.
    if (has(segmentation.superpixels.labels) && !segmentation.planes.empty()) {
      if (static_cast<int>(segmentation.planes.size()) !=
          segmentation.superpixels.count()) {
        throw std::invalid_argument("there must be a plane per superpixel");
      }
      add(each.planes, PaintPlanes(segmentation));
    }
  }
  if (has(record.chosen)) {
    add(kChosenHypotheses, Paint(record.chosen, HypothesisColor));
  }
  if (has(record.swept_depth)) {
    add(kSweptDepth, ColorDepth(record.swept_depth, range));
  }
  if (has(record.filtered_depth)) {
    add(kFilteredDepth, ColorDepth(record.filtered_depth, range));
  }
  if (has(record.agreement)) {
    add(kPlaneAgreement, Paint(record.agreement, Grey));
  }
  if (has(record.origin)) {
    add(kOriginOfDepth, Paint(record.origin, OriginColor));
  }
  add(kFinalDepth, ColorDepth(*view.depth, range));
  add(kFinalNormals, ColorNormals(*view.normal));
  return pictures;
}

std::vector<NamedPicture> DrawFinalPictures(const Map<float>& before,
                                            const Map<float>& depth,
                                            const Map<Vec3>& normal) {
  const std::vector<std::string>& names = TapaPictureNames();
  return {{names[kFinalDepth], ColorDepth(depth, RobustDepthRange(before))},
          {names[kFinalNormals], ColorNormals(normal)}};
}

}  // namespace tapa
