#include "src/pictures/image_io.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

namespace tapa {
namespace {

std::vector<unsigned char> ReadBytes(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream || std::filesystem::is_directory(path)) {
    throw std::runtime_error("cannot open " + path);
  }
  return std::vector<unsigned char>(std::istreambuf_iterator<char>(stream), {});
}

// Keeps the standard error stream silent during its life: libpng and libjpeg
// write there on their own when a file is damaged, which Read() reports.
class Silence {
 public:
  Silence() : stderr_(dup(STDERR_FILENO)) {
    const int null = open("/dev/null", O_WRONLY);
    if (stderr_ >= 0 && null >= 0) dup2(null, STDERR_FILENO);
    if (null >= 0) close(null);
  }
  ~Silence() {
    if (stderr_ < 0) return;
    dup2(stderr_, STDERR_FILENO);
    close(stderr_);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  int stderr_;
};

cv::Mat Read(const std::string& path, int mode) {
  const std::vector<unsigned char> bytes = ReadBytes(path);
  cv::Mat image;
  try {
    const Silence silence;
    if (!bytes.empty()) image = cv::imdecode(bytes, mode);
  } catch (const cv::Exception&) {
    // An image too large for OpenCV; reported below like any other.
  }
  if (image.empty()) {
    throw std::runtime_error(path + " is not a readable image");
  }
  return image;
}

}  // namespace

cv::Mat ReadUnchanged(const std::string& path) {
  return Read(path, cv::IMREAD_UNCHANGED);
}

cv::Mat ReadColor(const std::string& path) {
  return Read(path, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
}

Map<uint8_t> ReadGrey(const std::string& path, int width, int height) {
  cv::Mat image =
      Read(path, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
  const cv::Size size(width, height);
  if (image.size() != size) {
    cv::resize(image, image, size, 0, 0, cv::INTER_AREA);
  }
  Map<uint8_t> grey(width, height);
  for (int row = 0; row < height; ++row) {
    std::memcpy(grey.Row(row), image.ptr(row), width);
  }
  return grey;
}

std::vector<unsigned char> EncodePng(const cv::Mat& image) {
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".png", image, bytes)) {
    throw std::runtime_error("a picture cannot be encoded");
  }
  return bytes;
}

void WritePng(const std::string& path, const cv::Mat& image) {
  std::error_code error;
  const std::filesystem::path folder =
      std::filesystem::path(path).parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  const std::vector<unsigned char> bytes = EncodePng(image);
  std::ofstream stream(path, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) throw std::runtime_error("cannot write " + path);
}

}  // namespace tapa
