#include "src/eval/point_cloud.h"

#include <algorithm>
#include <array>
#include <boost/endian/conversion.hpp>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string_view>

#include "src/base/atomic_file.h"
#include "src/eval/ply_header.h"

namespace tapa {
namespace {

namespace endian = boost::endian;

// The file ends before what was to be read.
struct Truncated {};

// Reads the values of elements one after the other.
class ValueReader {
 public:
  virtual ~ValueReader() = default;
  // Goes to the next element.
  virtual void BeginElement() {}
  virtual double Next(PlyType type) = 0;
  virtual void Skip(PlyType type, double count) = 0;
};

class AsciiReader : public ValueReader {
 public:
  AsciiReader(const std::string& path, int num_lines, std::istream* stream)
      : path_(path), stream_(*stream), line_(num_lines) {}

  // An element has a line of its own.
  void BeginElement() override {
    do {
      if (!std::getline(stream_, text_)) throw Truncated();
      ++line_;
    } while (text_.find_first_not_of(kSpace) == std::string::npos);
    row_ = text_;
  }

  double Next(PlyType) override {
    row_.remove_prefix(std::min(row_.find_first_not_of(kSpace), row_.size()));
    if (row_.empty()) Fail("there are values missing");
    const std::string_view word =
        row_.substr(0, std::min(row_.find_first_of(kSpace), row_.size()));
    row_.remove_prefix(word.size());
    double value = 0;
    const char* begin = word.data() + (word[0] == '+' ? 1 : 0);
    const char* end = word.data() + word.size();
    const auto result = std::from_chars(begin, end, value);
    if (result.ec == std::errc::result_out_of_range) {
      // Beyond double precision, in either direction.
      return std::strtod(std::string(word).c_str(), nullptr);
    }
    if (result.ec != std::errc() || result.ptr != end) {
      Fail("'" + std::string(word.substr(0, 40)) + "' is no number");
    }
    return value;
  }

  void Skip(PlyType type, double count) override {
    for (double i = 0; i < count; ++i) Next(type);
  }

 private:
  static constexpr char kSpace[] = " \t\r";

  [[noreturn]] void Fail(const std::string& what) const {
    throw std::runtime_error(path_ + ", line " + std::to_string(line_) + ": " +
                             what);
  }

  const std::string& path_;
  std::istream& stream_;
  int64_t line_;
  std::string text_;
  // What is left of the line.
  std::string_view row_;
};

template <endian::order kOrder>
class BinaryReader : public ValueReader {
 public:
  explicit BinaryReader(std::istream* stream) : stream_(*stream) {}

  double Next(PlyType type) override {
    switch (type) {
      case PlyType::kInt8:
        return Load<int8_t>();
      case PlyType::kUint8:
        return Load<uint8_t>();
      case PlyType::kInt16:
        return Load<int16_t>();
      case PlyType::kUint16:
        return Load<uint16_t>();
      case PlyType::kInt32:
        return Load<int32_t>();
      case PlyType::kUint32:
        return Load<uint32_t>();
      case PlyType::kFloat:
        return Load<float>();
      case PlyType::kDouble:
        break;
    }
    return Load<double>();
  }

  void Skip(PlyType type, double count) override {
    const double size = count * static_cast<double>(SizeOf(type));
    const double here = std::min(size, static_cast<double>(end_ - next_));
    next_ += static_cast<size_t>(here);
    const auto rest = static_cast<std::streamsize>(size - here);
    if (rest > 0 && stream_.ignore(rest).gcount() != rest) throw Truncated();
  }

 private:
  template <typename T>
  double Load() {
    if (end_ - next_ < sizeof(T)) Fill(sizeof(T));
    next_ += sizeof(T);
    return static_cast<double>(
        endian::endian_load<T, sizeof(T), kOrder>(&buffer_[next_ - sizeof(T)]));
  }

  // Reads on, so that there are at least so many bytes.
  void Fill(size_t size) {
    std::copy_n(buffer_.data() + next_, end_ - next_, buffer_.data());
    end_ -= next_;
    next_ = 0;
    stream_.read(reinterpret_cast<char*>(&buffer_[end_]),
                 static_cast<std::streamsize>(buffer_.size() - end_));
    end_ += static_cast<size_t>(stream_.gcount());
    if (end_ < size) throw Truncated();
  }

  std::istream& stream_;
  std::array<unsigned char, 65536> buffer_;
  // What was read and not taken yet.
  size_t next_ = 0;
  size_t end_ = 0;
};

// Reads the points of one file.
class PointReader {
 public:
  explicit PointReader(const std::string& path)
      : path_(path), stream_(path, std::ios::binary) {
    if (!stream_ || std::filesystem::is_directory(path)) {
      throw std::runtime_error("cannot open " + path);
    }
    header_ = ReadPlyHeader(path, &stream_);
    if (header_.format == PlyFormat::kAscii) {
      reader_ =
          std::make_unique<AsciiReader>(path_, header_.num_lines, &stream_);
    } else if (header_.format == PlyFormat::kLittleEndian) {
      reader_ = std::make_unique<BinaryReader<endian::order::little>>(&stream_);
    } else {
      reader_ = std::make_unique<BinaryReader<endian::order::big>>(&stream_);
    }
  }

  PointCloud Read() {
    for (const PlyElement& element : header_.elements) {
      const bool is_vertex = element.name == "vertex";
      if (is_vertex) {
        FindCoordinates(element);
        cloud_.points.reserve(std::min(element.count, MostThatFit(element)));
      }
      // What has no properties takes no place in the file.
      if (element.properties.empty()) continue;
      for (uint64_t i = 0; i < element.count; ++i) {
        try {
          ReadElement(element, i);
        } catch (const Truncated&) {
          throw std::runtime_error(
              path_ + " is truncated: of " + std::to_string(element.count) +
              " elements " + element.name + " it has " + std::to_string(i));
        }
        if (is_vertex) AddPoint();
      }
      if (is_vertex) return std::move(cloud_);
    }
    throw std::runtime_error(path_ + " has no vertices");
  }

 private:
  // Which of a vertex' properties its coordinates are.
  void FindCoordinates(const PlyElement& element) {
    const std::array<std::string, 3> names = {"x", "y", "z"};
    for (size_t axis = 0; axis < names.size(); ++axis) {
      const std::vector<PlyProperty>& properties = element.properties;
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

  // No more elements than this are in the file, lest a wrong header
  // ask for all memory.
  uint64_t MostThatFit(const PlyElement& element) {
    uint64_t least_size = 0;
    for (const PlyProperty& property : element.properties) {
      least_size +=
          header_.format == PlyFormat::kAscii
              ? 2
              : SizeOf(property.list_size_type.value_or(property.type));
    }
    // The last value of an ascii file may have no character behind it.
    return (std::filesystem::file_size(path_) + 1) / least_size;
  }

  // Values of all properties but lists.
  void ReadElement(const PlyElement& element, uint64_t index) {
    values_.resize(element.properties.size());
    reader_->BeginElement();
    for (size_t i = 0; i < values_.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (!property.list_size_type.has_value()) {
        values_[i] = reader_->Next(property.type);
        continue;
      }
      const double size = reader_->Next(*property.list_size_type);
      if (size < 0) {
        throw std::runtime_error(path_ + " is damaged: " + element.name + " " +
                                 std::to_string(index) +
                                 " has a list of negative length");
      }
      reader_->Skip(property.type, size);
    }
  }

  void AddPoint() {
    const Vec3 point = {static_cast<float>(values_[coordinates_[0]]),
                        static_cast<float>(values_[coordinates_[1]]),
                        static_cast<float>(values_[coordinates_[2]])};
    if (std::isfinite(point.x) && std::isfinite(point.y) &&
        std::isfinite(point.z)) {
      cloud_.points.push_back(point);
    } else {
      ++cloud_.num_not_finite;
    }
  }

  const std::string path_;
  std::ifstream stream_;
  PlyHeader header_;
  std::unique_ptr<ValueReader> reader_;
  std::array<size_t, 3> coordinates_ = {};
  std::vector<double> values_;
  PointCloud cloud_;
};

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
  constexpr size_t kSize = 3 * sizeof(float) + 3;
  for (size_t begin = 0; begin < points.size(); begin += kBlock) {
    bytes.resize(kSize * (std::min(points.size(), begin + kBlock) - begin));
    for (size_t i = 0; i < bytes.size() / kSize; ++i) {
      unsigned char* row = &bytes[kSize * i];
      for (const float value :
           {points[begin + i].x, points[begin + i].y, points[begin + i].z}) {
        endian::endian_store<float, sizeof(float), endian::order::little>(
            row, value);
        row += sizeof(float);
      }
      const Rgb rgb = color(begin + i);
      std::copy_n(std::array{rgb.r, rgb.g, rgb.b}.begin(), 3, row);
    }
    file.Write(bytes.data(), bytes.size());
  }
  file.Commit();
}

}  // namespace tapa
