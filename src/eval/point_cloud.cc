#include "src/eval/point_cloud.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "src/base/atomic_file.h"
#include "src/eval/ply_header.h"

namespace tapa {
namespace {

// Which of a vertex' properties its coordinates are.
using CoordinateIndices = std::array<size_t, 3>;

template <typename T>
double As(const unsigned char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(value));
  return static_cast<double>(value);
}

// A value in the byte order of this machine.
double Decode(PlyType type, const unsigned char* bytes) {
  switch (type) {
    case PlyType::kInt8:
      return As<int8_t>(bytes);
    case PlyType::kUint8:
      return As<uint8_t>(bytes);
    case PlyType::kInt16:
      return As<int16_t>(bytes);
    case PlyType::kUint16:
      return As<uint16_t>(bytes);
    case PlyType::kInt32:
      return As<int32_t>(bytes);
    case PlyType::kUint32:
      return As<uint32_t>(bytes);
    case PlyType::kFloat:
      return As<float>(bytes);
    case PlyType::kDouble:
      break;
  }
  return As<double>(bytes);
}

double Decode(PlyType type, const unsigned char* bytes, bool swap) {
  if (!swap) return Decode(type, bytes);
  unsigned char swapped[8];
  std::reverse_copy(bytes, bytes + SizeOf(type), swapped);
  return Decode(type, swapped);
}

bool IsBigEndianMachine() {
  const uint16_t one = 1;
  unsigned char first;
  std::memcpy(&first, &one, 1);
  return first == 0;
}

// Reads the points of one file.
class PointReader {
 public:
  explicit PointReader(const std::string& path)
      : path_(path), stream_(path, std::ios::binary) {
    if (!stream_ || std::filesystem::is_directory(path)) {
      throw std::runtime_error("cannot open " + path);
    }
    header_ = ReadPlyHeader(path, &stream_);
    line_ = header_.num_lines;
    swap_ = (header_.format == PlyFormat::kBigEndian) != IsBigEndianMachine();
  }

  PointCloud Read() {
    for (const PlyElement& element : header_.elements) {
      element_ = &element;
      if (element.name == "vertex") {
        ReadVertices();
        return std::move(cloud_);
      }
      Skip();
    }
    throw std::runtime_error(path_ + " has no vertices");
  }

 private:
  void ReadVertices() {
    FindCoordinates();
    cloud_.points.reserve(std::min(element_->count, MostThatFit()));
    if (header_.format == PlyFormat::kAscii) {
      ReadAscii();
    } else if (element_->HasLists()) {
      ReadBinaryWithLists();
    } else {
      ReadBinary();
    }
  }

  void FindCoordinates() {
    const std::array<std::string, 3> names = {"x", "y", "z"};
    for (size_t axis = 0; axis < names.size(); ++axis) {
      const std::vector<PlyProperty>& properties = element_->properties;
      const auto found = std::find_if(
          properties.begin(), properties.end(), [&](const PlyProperty& p) {
            return p.name == names[axis] && !p.list_size_type.has_value();
          });
      if (found == properties.end()) {
        throw std::runtime_error(path_ + " has no property " + names[axis] +
                                 " of its vertices");
      }
      coordinates_[axis] = static_cast<size_t>(found - properties.begin());
    }
  }

  // No more elements than this are in the rest of the file, lest a wrong header
  // ask for all memory.
  uint64_t MostThatFit() {
    uint64_t least_size = 0;
    for (const PlyProperty& property : element_->properties) {
      least_size +=
          header_.format == PlyFormat::kAscii
              ? 2
              : SizeOf(property.list_size_type.value_or(property.type));
    }
    // The last value of an ascii file may have no character behind it.
    return (NumBytesLeft() + 1) / std::max<uint64_t>(1, least_size);
  }

  uint64_t NumBytesLeft() {
    const std::streamoff here = stream_.tellg();
    stream_.seekg(0, std::ios::end);
    const std::streamoff end = stream_.tellg();
    stream_.seekg(here);
    return static_cast<uint64_t>(end - here);
  }

  [[noreturn]] void FailTruncated(uint64_t num_read) const {
    throw std::runtime_error(
        path_ + " is truncated: of " + std::to_string(element_->count) +
        " elements " + element_->name + " it has " + std::to_string(num_read));
  }

  void Add(double x, double y, double z) {
    const Vec3 point = {static_cast<float>(x), static_cast<float>(y),
                        static_cast<float>(z)};
    if (std::isfinite(point.x) && std::isfinite(point.y) &&
        std::isfinite(point.z)) {
      cloud_.points.push_back(point);
    } else {
      ++cloud_.num_not_finite;
    }
  }

  // Moves past all of an element.
  void Skip() {
    if (header_.format == PlyFormat::kAscii) {
      for (uint64_t i = 0; i < element_->count; ++i) NextRow(i);
    } else if (element_->HasLists()) {
      for (uint64_t i = 0; i < element_->count; ++i) {
        for (const PlyProperty& property : element_->properties) {
          ReadBinaryProperty(property, i);
        }
      }
    } else {
      if (MostThatFit() < element_->count) FailTruncated(MostThatFit());
      stream_.seekg(
          static_cast<std::streamoff>(element_->count * element_->Stride()),
          std::ios::cur);
    }
  }

  void ReadBinary() {
    const size_t stride = element_->Stride();
    std::array<size_t, 3> offsets = {0, 0, 0};
    std::array<PlyType, 3> types;
    for (size_t axis = 0; axis < 3; ++axis) {
      for (size_t i = 0; i < coordinates_[axis]; ++i) {
        offsets[axis] += SizeOf(element_->properties[i].type);
      }
      types[axis] = element_->properties[coordinates_[axis]].type;
    }
    constexpr uint64_t kBlock = 16384;
    std::vector<unsigned char> bytes(kBlock * stride);
    for (uint64_t begin = 0; begin < element_->count; begin += kBlock) {
      const uint64_t size = std::min(kBlock, element_->count - begin);
      stream_.read(reinterpret_cast<char*>(bytes.data()),
                   static_cast<std::streamsize>(size * stride));
      const uint64_t num_read =
          static_cast<uint64_t>(stream_.gcount()) / stride;
      if (num_read < size) FailTruncated(begin + num_read);
      for (uint64_t i = 0; i < size; ++i) {
        const unsigned char* row = &bytes[i * stride];
        Add(Decode(types[0], row + offsets[0], swap_),
            Decode(types[1], row + offsets[1], swap_),
            Decode(types[2], row + offsets[2], swap_));
      }
    }
  }

  double ReadBinaryValue(PlyType type, uint64_t index) {
    unsigned char bytes[8];
    if (!stream_.read(reinterpret_cast<char*>(bytes),
                      static_cast<std::streamsize>(SizeOf(type)))) {
      FailTruncated(index);
    }
    return Decode(type, bytes, swap_);
  }

  // Value of a property of element `index`, 0 for a list.
  double ReadBinaryProperty(const PlyProperty& property, uint64_t index) {
    if (!property.list_size_type.has_value()) {
      return ReadBinaryValue(property.type, index);
    }
    const double size = ReadBinaryValue(*property.list_size_type, index);
    if (size < 0) {
      throw std::runtime_error(path_ + " is damaged: " + element_->name + " " +
                               std::to_string(index) +
                               " has a list of negative length");
    }
    const auto num_bytes = static_cast<std::streamsize>(
        size * static_cast<double>(SizeOf(property.type)));
    stream_.ignore(num_bytes);
    if (stream_.gcount() != num_bytes) FailTruncated(index);
    return 0;
  }

  void ReadBinaryWithLists() {
    std::vector<double> row(element_->properties.size());
    for (uint64_t i = 0; i < element_->count; ++i) {
      for (size_t j = 0; j < row.size(); ++j) {
        row[j] = ReadBinaryProperty(element_->properties[j], i);
      }
      Add(row[coordinates_[0]], row[coordinates_[1]], row[coordinates_[2]]);
    }
  }

  // The next line that is not empty, which holds element `index`.
  std::string_view NextRow(uint64_t index) {
    do {
      if (!std::getline(stream_, text_)) FailTruncated(index);
      ++line_;
    } while (text_.find_first_not_of(" \t\r") == std::string::npos);
    return text_;
  }

  [[noreturn]] void FailAtLine(const std::string& what) const {
    throw std::runtime_error(path_ + ", line " + std::to_string(line_) + ": " +
                             what);
  }

  // Takes the first value off a line.
  double TakeValue(std::string_view* row) const {
    row->remove_prefix(std::min(row->find_first_not_of(" \t\r"), row->size()));
    if (row->empty()) FailAtLine("there are values missing");
    const std::string_view word =
        row->substr(0, std::min(row->find_first_of(" \t\r"), row->size()));
    row->remove_prefix(word.size());
    double value = 0;
    const char* begin = word.data() + (word[0] == '+' ? 1 : 0);
    const char* end = word.data() + word.size();
    const auto result = std::from_chars(begin, end, value);
    if (result.ec == std::errc::result_out_of_range) {
      // Beyond double precision, in either direction.
      return std::strtod(std::string(word).c_str(), nullptr);
    }
    if (result.ec != std::errc() || result.ptr != end) {
      FailAtLine("'" + std::string(word.substr(0, 40)) + "' is no number");
    }
    return value;
  }

  void ReadAscii() {
    std::vector<double> values(element_->properties.size());
    for (uint64_t i = 0; i < element_->count; ++i) {
      std::string_view row = NextRow(i);
      for (size_t j = 0; j < values.size(); ++j) {
        values[j] = TakeValue(&row);
        if (element_->properties[j].list_size_type.has_value()) {
          for (double k = 0; k < values[j]; ++k) TakeValue(&row);
        }
      }
      Add(values[coordinates_[0]], values[coordinates_[1]],
          values[coordinates_[2]]);
    }
  }

  const std::string path_;
  std::ifstream stream_;
  PlyHeader header_;
  // Whether values have the other byte order than this machine.
  bool swap_ = false;
  // What is being read.
  const PlyElement* element_ = nullptr;
  CoordinateIndices coordinates_ = {};
  std::string text_;
  int64_t line_ = 0;
  PointCloud cloud_;
};

void AppendFloat(float value, std::vector<unsigned char>* bytes) {
  uint32_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  for (int shift = 0; shift < 32; shift += 8) {
    bytes->push_back(static_cast<unsigned char>(bits >> shift));
  }
}

}  // namespace

PointCloud ReadPointCloud(const std::string& path) {
  return PointReader(path).Read();
}

void WriteColoredPoints(const std::string& path,
                        const std::vector<Vec3>& points,
                        const std::function<Rgb(size_t)>& color) {
  AtomicFile file(path);
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex " +
      std::to_string(points.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "end_header\n";
  file.Write(header.data(), header.size());
  constexpr size_t kBlock = 16384;
  std::vector<unsigned char> bytes;
  for (size_t begin = 0; begin < points.size(); begin += kBlock) {
    bytes.clear();
    for (size_t i = begin; i < std::min(points.size(), begin + kBlock); ++i) {
      AppendFloat(points[i].x, &bytes);
      AppendFloat(points[i].y, &bytes);
      AppendFloat(points[i].z, &bytes);
      const Rgb rgb = color(i);
      bytes.insert(bytes.end(), {rgb.r, rgb.g, rgb.b});
    }
    file.Write(bytes.data(), bytes.size());
  }
  file.Commit();
}

}  // namespace tapa
