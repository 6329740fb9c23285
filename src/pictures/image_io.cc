#include "src/pictures/image_io.h"

#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

namespace tapa {

std::vector<unsigned char> EncodePng(const cv::Mat& image) {
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".png", image, bytes)) {
    throw std::runtime_error("a picture cannot be encoded");
  }
  return bytes;
}

}  // namespace tapa
