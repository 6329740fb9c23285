#ifndef TAPA_SRC_PICTURES_DRAWING_H_
#define TAPA_SRC_PICTURES_DRAWING_H_

#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "src/pictures/color_map.h"

namespace tapa {

// Parts of legends. All draw on a picture of 8 bits per channel.

inline const cv::Scalar kPaper(255, 255, 255);
inline const cv::Scalar kInk(40, 40, 40);

void DrawText(const std::string& text, const cv::Point& baseline, double scale,
              cv::Mat* canvas);

int TextWidth(const std::string& text, double scale);

// The largest scale up to `scale` at which the text is at most `width` wide.
double FittingScale(const std::string& text, double scale, int width);

// "0.85", "2.5", "130": three digits, without an exponent.
std::string Number(double value);

// A bar of colours from left (0) to right (1) with a heading above it and
// labels below. 62 pixels high; the area's own height does not count.
void DrawColorBar(const std::string& heading,
                  const std::function<cv::Vec3b(float)>& color,
                  const std::vector<std::string>& labels, const cv::Rect& area,
                  cv::Mat* canvas);

// DrawColorBar of the colours of depths, with the numbers of the range.
void DrawDepthBar(const std::string& heading, const DepthRange& range,
                  const cv::Rect& area, cv::Mat* canvas);

// A small square of one colour with its meaning. Returns its width.
int DrawSwatch(const cv::Vec3b& color, const std::string& text,
               const cv::Point& corner, cv::Mat* canvas);

// The colours of all normals that face the camera, as on a ball.
void DrawNormalBall(const cv::Point& center, int radius, cv::Mat* canvas);

}  // namespace tapa

#endif  // TAPA_SRC_PICTURES_DRAWING_H_
