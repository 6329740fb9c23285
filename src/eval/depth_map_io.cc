#include "src/eval/depth_map_io.h"

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <stdexcept>

#include "src/base/depth.h"
#include "src/base/map_files.h"
#include "src/pictures/image_io.h"

namespace tapa {
namespace {

Map<float> ReadDepthPng(const std::string& path, double depth_scale) {
  const cv::Mat image = ReadUnchanged(path);
  if (image.type() != CV_16UC1) {
    throw std::runtime_error(path + " is not a 16-bit grey image");
  }
  Map<float> depth(image.cols, image.rows);
  for (int row = 0; row < image.rows; ++row) {
    for (int col = 0; col < image.cols; ++col) {
      depth.At(row, col) =
          static_cast<float>(image.at<uint16_t>(row, col) / depth_scale);
    }
  }
  return depth;
}

}  // namespace

Map<float> ReadGroundTruth(const std::string& path, double depth_scale) {
  if (std::filesystem::path(path).extension() != ".bin") {
    return ReadDepthPng(path, depth_scale);
  }
  Map<float> depth = ReadDepthMap(path);
  for (size_t i = 0; i < depth.size(); ++i) {
    float& value = depth.data()[i];
    if (!IsDepth(value)) value = 0;
  }
  return depth;
}

}  // namespace tapa
