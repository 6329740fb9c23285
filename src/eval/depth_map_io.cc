#include "src/eval/depth_map_io.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <vector>

#include "src/pictures/image_io.h"

// Values are copied as they stand in the file.
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
              "maps are stored in little-endian order");

namespace tapa {
namespace {

// Values of one file, in its own order.
struct RawMap {
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<float> values;
};

RawMap ReadRawMap(const std::string& path, int channels) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream || std::filesystem::is_directory(path)) {
    throw std::runtime_error("cannot open " + path);
  }
  RawMap map;
  for (int* number : {&map.width, &map.height, &map.channels}) {
    constexpr int kMax = 1000000;
    if (!std::isdigit(stream.peek()) || !(stream >> *number) || *number < 1 ||
        *number > kMax || stream.get() != '&') {
      throw std::runtime_error(path + " is not a COLMAP depth or normal map");
    }
  }
  const std::string size = std::to_string(map.width) + "x" +
                           std::to_string(map.height) + "x" +
                           std::to_string(map.channels);
  if (map.channels != channels) {
    throw std::runtime_error(
        path + " has size " + size + " where " + std::to_string(channels) +
        (channels == 1 ? " channel is" : " channels are") + " expected");
  }

  // The length is compared first, lest a wrong header ask for all memory.
  const uint64_t found =
      std::filesystem::file_size(path) - static_cast<uint64_t>(stream.tellg());
  const uint64_t expected =
      sizeof(float) * static_cast<uint64_t>(map.width) * map.height * channels;
  if (found != expected) {
    throw std::runtime_error(
        path + " is " + (found < expected ? "truncated" : "too long") + ": " +
        std::to_string(found) + " bytes of values where size " + size +
        " needs " + std::to_string(expected));
  }
  map.values.resize(expected / sizeof(float));
  stream.read(reinterpret_cast<char*>(map.values.data()),
              static_cast<std::streamsize>(expected));
  if (!stream) throw std::runtime_error("cannot read " + path);
  return map;
}

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

Map<float> ReadDepthMap(const std::string& path) {
  const RawMap raw = ReadRawMap(path, 1);
  Map<float> depth(raw.width, raw.height);
  std::copy(raw.values.begin(), raw.values.end(), depth.data());
  return depth;
}

Map<Vec3> ReadNormalMap(const std::string& path) {
  const RawMap raw = ReadRawMap(path, 3);
  Map<Vec3> normal(raw.width, raw.height);
  const size_t size = normal.size();
  for (size_t i = 0; i < size; ++i) {
    normal.data()[i] = {raw.values[i], raw.values[size + i],
                        raw.values[2 * size + i]};
  }
  return normal;
}

Map<float> ReadGroundTruth(const std::string& path, double depth_scale) {
  if (std::filesystem::path(path).extension() != ".bin") {
    return ReadDepthPng(path, depth_scale);
  }
  Map<float> depth = ReadDepthMap(path);
  for (size_t i = 0; i < depth.size(); ++i) {
    float& value = depth.data()[i];
    if (!std::isfinite(value) || value < 0) value = 0;
  }
  return depth;
}

}  // namespace tapa
