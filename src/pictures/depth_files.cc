#include "src/pictures/depth_files.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "src/base/failure.h"

namespace tapa {
namespace {

using Bytes = std::vector<char>;

[[noreturn]] void Fail(const std::string& path, const std::string& what) {
  throw Failure("The depth map " + path + " " + what);
}

[[noreturn]] void FailAsDamaged(const std::string& path) {
  Fail(path, "is damaged, or not of the format that its name says");
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

// What the header of a file says; 0 if it makes no sense.
struct HeaderSize {
  int64_t width = 0;
  int64_t height = 0;
};

HeaderSize PngSize(const Bytes& bytes) {
  constexpr char kBegin[] = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR";
  constexpr size_t kBeginSize = sizeof(kBegin) - 1;
  if (bytes.size() < kBeginSize + 8 ||
      std::memcmp(bytes.data(), kBegin, kBeginSize) != 0) {
    return {};
  }
  const auto number = [&bytes](size_t at) {
    int64_t value = 0;
    for (size_t i = at; i < at + 4; ++i) {
      value = 256 * value + static_cast<uint8_t>(bytes[i]);
    }
    return value;
  };
  return {number(kBeginSize), number(kBeginSize + 4)};
}

HeaderSize PfmSize(const Bytes& bytes) {
  constexpr size_t kMaxHeader = 100;
  const std::string begin(bytes.data(), std::min(bytes.size(), kMaxHeader));
  std::smatch size;
  if (!std::regex_search(begin, size,
                         std::regex("^P[fF]\\s+(\\d{1,9})\\s+(\\d{1,9})\\s"))) {
    return {};
  }
  return {std::stoi(size[1]), std::stoi(size[2])};
}

// The text that a 0 ends, in [at, end); without a 0, all of it.
std::string TextAt(const Bytes& bytes, size_t at, size_t end) {
  const auto first = bytes.begin() + std::min(at, end);
  const auto last = bytes.begin() + end;
  return std::string(first, std::find(first, last, '\0'));
}

// Whether [at, end) is a list of channels, each with its name, type and
// sampling, that an empty name ends.
bool IsChannelList(const Bytes& bytes, size_t at, size_t end) {
  constexpr size_t kTypeAndSampling = 16;
  while (at < end) {
    const std::string name = TextAt(bytes, at, end);
    if (name.empty()) {
      return at + 1 == end;
    }
    at += name.size() + 1 + kTypeAndSampling;
  }
  return false;
}

// Whether the library takes as many bytes for an attribute of this type as are
// said to be there, [at, end). Where it takes others, what it goes on with is
// no attribute, and of a size that nobody has looked at.
bool HasSizeOfType(const Bytes& bytes, const std::string& type, size_t at,
                   size_t end) {
  static const std::map<std::string, size_t> kSizes = {{"box2f", 16},
                                                       {"box2i", 16},
                                                       {"chromaticities", 32},
                                                       {"compression", 1},
                                                       {"deepImageState", 1},
                                                       {"double", 8},
                                                       {"envmap", 1},
                                                       {"float", 4},
                                                       {"int", 4},
                                                       {"keycode", 28},
                                                       {"lineOrder", 1},
                                                       {"m33d", 72},
                                                       {"m33f", 36},
                                                       {"m44d", 128},
                                                       {"m44f", 64},
                                                       {"rational", 8},
                                                       {"tiledesc", 9},
                                                       {"timecode", 8},
                                                       {"v2d", 16},
                                                       {"v2f", 8},
                                                       {"v2i", 8},
                                                       {"v3d", 24},
                                                       {"v3f", 12},
                                                       {"v3i", 12}};
  const auto size = kSizes.find(type);
  return size != kSizes.end()
             ? end - at == size->second
             : type != "chlist" || IsChannelList(bytes, at, end);
}

// The library takes memory for what is said inside of these; no depth map needs
// them.
void CheckExrType(const std::string& path, const std::string& type) {
  static const std::set<std::string> kUnread = {"floatvector", "idmanifest",
                                                "preview", "stringvector"};
  if (kUnread.count(type) != 0) {
    Fail(path, "has an attribute of type " + type +
                   " in its header, which is not read; save it without");
  }
}

// Of the attributes of the header, each with its name, its type and the number
// of its bytes, the one that says where there are pixels. The last one counts.
HeaderSize ExrSize(const std::string& path, const Bytes& bytes) {
  constexpr size_t kBegin = 8;  // Behind magic number and version.
  // OpenCV goes by these, not by names, and looks for medical images, whose
  // library ends the program where they are damaged, before it looks for EXR.
  constexpr char kMagic[] = "\x76\x2f\x31\x01";
  constexpr char kMedicalMagic[] = "DICM";
  constexpr size_t kMedicalBegin = 128;
  if (bytes.size() < kBegin || std::memcmp(bytes.data(), kMagic, 4) != 0 ||
      (bytes.size() >= kMedicalBegin + 4 &&
       std::memcmp(bytes.data() + kMedicalBegin, kMedicalMagic, 4) == 0)) {
    return {};
  }
  HeaderSize size;
  for (size_t at = kBegin;;) {
    const std::string name = TextAt(bytes, at, bytes.size());
    at += name.size() + 1;
    const std::string type = TextAt(bytes, at, bytes.size());
    at += type.size() + 1;
    if (name.empty()) {
      return size;
    }
    CheckExrType(path, type);
    uint32_t num_bytes = 0;
    if (at + sizeof(num_bytes) > bytes.size()) {
      return {};
    }
    std::memcpy(&num_bytes, bytes.data() + at, sizeof(num_bytes));
    at += sizeof(num_bytes);
    // The library would take so many bytes before it reads them.
    if (num_bytes > bytes.size() - at ||
        !HasSizeOfType(bytes, type, at, at + num_bytes)) {
      return {};
    }
    int32_t box[4];  // Smallest x and y, largest x and y.
    if (name == "dataWindow" && num_bytes == sizeof(box)) {
      std::memcpy(box, bytes.data() + at, sizeof(box));
      size = {int64_t{box[2]} - box[0] + 1, int64_t{box[3]} - box[1] + 1};
    }
    at += num_bytes;
  }
}

HeaderSize SizeInHeader(const std::string& path, const Bytes& bytes) {
  return EndsWith(path, ".png")   ? PngSize(bytes)
         : EndsWith(path, ".pfm") ? PfmSize(bytes)
                                  : ExrSize(path, bytes);
}

void CheckHeader(const std::string& path, const HeaderSize& size,
                 const SizeCheck& check_size) {
  constexpr int kMaxSide = 1000000;
  if (size.width < 1 || size.height < 1 || size.width > kMaxSide ||
      size.height > kMaxSide) {
    FailAsDamaged(path);
  }
  check_size(static_cast<int>(size.width), static_cast<int>(size.height));
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
  // As NumPy does: a search takes stack for what it passes over.
  constexpr size_t kMaxHeader = 10000;
  if (size > kMaxHeader) {
    Fail(path, "has a header of " + std::to_string(size) +
                   " bytes, and at most " + std::to_string(kMaxHeader) +
                   " are for numbers alone");
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

Map<float> ReadDepthFile(const std::string& path, const SizeCheck& check_size) {
  Bytes bytes = ReadBytes(path);
  cv::Mat image;
  if (EndsWith(path, ".npy")) {
    image = DecodeNpy(path, bytes);  // No larger than the file.
    check_size(image.cols, image.rows);
  } else {
    const HeaderSize size = SizeInHeader(path, bytes);
    CheckHeader(path, size, check_size);
    if (EndsWith(path, ".exr")) {
      RenameExrChannel(&bytes);
    }
    image = Decode(bytes);
    if (image.cols != size.width || image.rows != size.height) {
      FailAsDamaged(path);
    }
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
