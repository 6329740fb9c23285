#ifndef TAPA_SRC_PICTURES_IMAGE_IO_H_
#define TAPA_SRC_PICTURES_IMAGE_IO_H_

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "src/base/map.h"

namespace tapa {

// Reading and writing of pictures. All functions throw std::runtime_error when
// they fail, those for files with the path in the message. Pictures are taken
// as they are stored: a camera's note on its orientation is ignored, as COLMAP
// does.

// Any number of channels and bits.
cv::Mat ReadUnchanged(const std::string& path);

// Blue, green, red; 8 bits each.
cv::Mat ReadColor(const std::string& path);

// Grey, 0 to 255, resized to the given size in pixels if it has another one.
Map<uint8_t> ReadGrey(const std::string& path, int width, int height);

// The bytes of a PNG file.
std::vector<unsigned char> EncodePng(const cv::Mat& image);

// Writes a PNG, and the folders above it where they are missing.
void WritePng(const std::string& path, const cv::Mat& image);

}  // namespace tapa

#endif  // TAPA_SRC_PICTURES_IMAGE_IO_H_
