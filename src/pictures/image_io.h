#ifndef TAPA_SRC_PICTURES_IMAGE_IO_H_
#define TAPA_SRC_PICTURES_IMAGE_IO_H_

#include <opencv2/core.hpp>
#include <vector>

namespace tapa {

// The bytes of a PNG file. Throws std::runtime_error if the picture cannot be
// encoded.
std::vector<unsigned char> EncodePng(const cv::Mat& image);

}  // namespace tapa

#endif  // TAPA_SRC_PICTURES_IMAGE_IO_H_
