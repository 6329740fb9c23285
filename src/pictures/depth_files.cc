#include "src/pictures/depth_files.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <regex>
#include <vector>

#include "src/base/failure.h"

namespace tapa {
namespace {

using Bytes = std::vector<char>;

[[noreturn]] void Fail(const std::string& path, const std::string& what) {
  throw Failure("The depth map " + path + " " + what);
}

Bytes ReadBytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  Bytes bytes{std::istreambuf_iterator<char>(file),
              std::istreambuf_iterator<char>()};
  if (!file || bytes.empty()) {
    Fail(path, "cannot be read, or is empty");
  }
  return bytes;
}

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() &&
         text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// OpenCV knows a channel called Y, and makes zeros of a depth called Z: an only
// channel of one letter is renamed.
void RenameExrChannel(Bytes* bytes) {
  constexpr char kList[] = "channels\0chlist";
  // The name and its 0, type and sampling, the 0 at the end of the list.
  constexpr size_t kChannelSize = 2 + 16;
  // No header begins its list of channels behind this.
  constexpr size_t kMaxBegin = 1 << 16;
  const auto end = bytes->begin() + std::min(bytes->size(), kMaxBegin);
  const auto found =
      std::search(bytes->begin(), end, std::begin(kList), std::end(kList));
  const size_t name = found - bytes->begin() + sizeof(kList) + 4;
  if (found != end && name + kChannelSize < bytes->size() &&
      (*bytes)[name] != 0 && (*bytes)[name + 1] == 0 &&
      (*bytes)[name + kChannelSize] == 0) {
    (*bytes)[name] = 'Y';
  }
}

cv::Mat Decode(const Bytes& bytes) {
  // OpenCV of Debian reads EXR, but wants to be asked, before the first one.
  static const bool asked [[maybe_unused]] =
      setenv("OPENCV_IO_ENABLE_OPENEXR", "1", /* overwrite */ 0) == 0;
  try {
    return cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    return {};  // Damaged, or too large for OpenCV.
  }
}

// Points into the bytes.
cv::Mat DecodeNpy(const std::string& path, const Bytes& bytes) {
  constexpr char kMagic[] = "\x93NUMPY";
  constexpr size_t kMagicSize = sizeof(kMagic) - 1;
  constexpr size_t kMinSize = 12;
  if (bytes.size() < kMinSize ||
      std::memcmp(bytes.data(), kMagic, kMagicSize) != 0) {
    Fail(path, "is not an NPY file");
  }
  // Behind the version: the size of the header in 2 or, from version 2, in 4
  // bytes.
  const auto byte = [&bytes](size_t i) {
    return static_cast<size_t>(static_cast<uint8_t>(bytes[i]));
  };
  const size_t begin = byte(6) == 1 ? 10 : 12;
  size_t size = byte(8) | byte(9) << 8;
  if (begin == 12) {
    size |= byte(10) << 16 | byte(11) << 24;
  }
  const size_t data = begin + size;
  if (data > bytes.size()) {
    Fail(path, "is cut off");
  }
  const std::string header(bytes.data() + begin, size);
  std::smatch type, shape;
  const std::regex any_type("'descr': *'<f([248])'");
  const std::regex any_shape("'shape': *\\((\\d{1,6}), *(\\d{1,6}),?\\)");
  if (!std::regex_search(header, type, any_type) ||
      !std::regex_search(header, shape, any_shape) ||
      header.find("'fortran_order': False") == std::string::npos) {
    Fail(path,
         "should hold floating-point numbers of shape (height, width), "
         "little-endian and row by row");
  }
  const int height = std::stoi(shape[1]);
  const int width = std::stoi(shape[2]);
  const size_t value_size = std::stoi(type[1]);
  const size_t expected = value_size * height * width;
  if (expected == 0 || bytes.size() - data != expected) {
    Fail(path, "has " + std::to_string(bytes.size() - data) +
                   " bytes of values, where its shape needs " +
                   std::to_string(expected));
  }
  const int kind = value_size == 2 ? CV_16F : value_size == 4 ? CV_32F : CV_64F;
  return cv::Mat(height, width, kind, const_cast<char*>(bytes.data() + data));
}

}  // namespace

Map<float> ReadDepthFile(const std::string& path) {
  Bytes bytes = ReadBytes(path);
  if (EndsWith(path, ".exr")) {
    RenameExrChannel(&bytes);
  }
  const cv::Mat image =
      EndsWith(path, ".npy") ? DecodeNpy(path, bytes) : Decode(bytes);
  if (image.empty()) {
    Fail(path, "is damaged, or not of the format that its name says");
  }
  if (image.channels() != 1 || image.depth() == CV_8U) {
    Fail(path,
         "should have one channel, of 16 bits in a PNG and of floating-point "
         "numbers in other files");
  }
  cv::Mat values;
  image.convertTo(values, CV_32F);
  Map<float> map(values.cols, values.rows);
  for (int row = 0; row < values.rows; ++row) {
    std::copy_n(values.ptr<float>(row), values.cols, map.Row(row));
  }
  return map;
}

}  // namespace tapa
