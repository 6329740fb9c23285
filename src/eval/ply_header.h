#ifndef TAPA_SRC_EVAL_PLY_HEADER_H_
#define TAPA_SRC_EVAL_PLY_HEADER_H_

#include <cstddef>
#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <vector>

namespace tapa {

enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };

enum class PlyType {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kFloat,
  kDouble
};

// Bytes of a value in a binary file.
size_t SizeOf(PlyType type);

struct PlyProperty {
  std::string name;
  // Of the value, or of the values of a list.
  PlyType type = PlyType::kFloat;
  // A list has a number of this type in front, which says how many values it
  // has.
  std::optional<PlyType> list_size_type;
};

struct PlyElement {
  std::string name;
  uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  // In the order in which their values follow.
  std::vector<PlyElement> elements;
  // Number of lines, that of "end_header" included.
  int num_lines = 0;
};

// Reads the header of a PLY file and leaves the stream where the values begin.
// Lines may end in "\n" or "\r\n". Throws std::runtime_error with `path` in the
// message if the stream holds no such header.
PlyHeader ReadPlyHeader(const std::string& path, std::istream* stream);

}  // namespace tapa

#endif  // TAPA_SRC_EVAL_PLY_HEADER_H_
