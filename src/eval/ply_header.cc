#include "src/eval/ply_header.h"

#include <charconv>
#include <map>
#include <sstream>
#include <stdexcept>

namespace tapa {
namespace {

std::optional<PlyType> ParseType(const std::string& name) {
  static const std::map<std::string, PlyType> types = {
      {"char", PlyType::kInt8},     {"int8", PlyType::kInt8},
      {"uchar", PlyType::kUint8},   {"uint8", PlyType::kUint8},
      {"short", PlyType::kInt16},   {"int16", PlyType::kInt16},
      {"ushort", PlyType::kUint16}, {"uint16", PlyType::kUint16},
      {"int", PlyType::kInt32},     {"int32", PlyType::kInt32},
      {"uint", PlyType::kUint32},   {"uint32", PlyType::kUint32},
      {"float", PlyType::kFloat},   {"float32", PlyType::kFloat},
      {"double", PlyType::kDouble}, {"float64", PlyType::kDouble}};
  const auto found = types.find(name);
  if (found == types.end()) return std::nullopt;
  return found->second;
}

// Reads line after line and says where an error is.
class HeaderParser {
 public:
  HeaderParser(const std::string& path, std::istream* stream)
      : path_(path), stream_(*stream) {}

  PlyHeader Parse() {
    if (!NextLine() || Words() != std::vector<std::string>{"ply"}) {
      throw std::runtime_error(path_ + " is not a PLY file");
    }
    bool has_format = false;
    while (true) {
      if (!NextLine()) {
        throw std::runtime_error(path_ +
                                 " is truncated: its header has no end");
      }
      const std::vector<std::string> words = Words();
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") {
        continue;
      }
      if (words[0] == "end_header") break;
      if (words[0] == "format") {
        ParseFormat(words);
        has_format = true;
      } else if (words[0] == "element") {
        ParseElement(words);
      } else if (words[0] == "property") {
        ParseProperty(words);
      } else {
        Fail();
      }
    }
    if (!has_format) {
      throw std::runtime_error(path_ + " does not say its format");
    }
    return header_;
  }

 private:
  // Headers have short lines. What does not is another kind of file, of which
  // there is no need to read gigabytes.
  static constexpr size_t kMaxLineLength = 65536;

  bool NextLine() {
    line_.clear();
    ++header_.num_lines;
    for (int c = stream_.get(); c != '\n'; c = stream_.get()) {
      if (c == std::istream::traits_type::eof() ||
          line_.size() == kMaxLineLength) {
        return false;
      }
      line_.push_back(static_cast<char>(c));
    }
    return true;
  }

  std::vector<std::string> Words() const {
    std::istringstream stream(line_);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
  }

  [[noreturn]] void Fail() const {
    throw std::runtime_error(
        path_ + " has a header that cannot be understood, line " +
        std::to_string(header_.num_lines) + ": '" +
        line_.substr(0, line_.find('\r')).substr(0, 80) + "'");
  }

  void ParseFormat(const std::vector<std::string>& words) {
    if (words.size() != 3 || words[2] != "1.0") Fail();
    if (words[1] == "ascii") {
      header_.format = PlyFormat::kAscii;
    } else if (words[1] == "binary_little_endian") {
      header_.format = PlyFormat::kLittleEndian;
    } else if (words[1] == "binary_big_endian") {
      header_.format = PlyFormat::kBigEndian;
    } else {
      Fail();
    }
  }

  void ParseElement(const std::vector<std::string>& words) {
    if (words.size() != 3) Fail();
    PlyElement element;
    element.name = words[1];
    const char* end = words[2].data() + words[2].size();
    const auto result = std::from_chars(words[2].data(), end, element.count);
    if (result.ec != std::errc() || result.ptr != end) Fail();
    header_.elements.push_back(element);
  }

  void ParseProperty(const std::vector<std::string>& words) {
    const bool is_list = words.size() == 5 && words[1] == "list";
    if (header_.elements.empty() || (!is_list && words.size() != 3)) Fail();
    PlyProperty property;
    property.name = words.back();
    const auto type = ParseType(words[words.size() - 2]);
    if (!type.has_value()) Fail();
    property.type = *type;
    if (is_list) {
      property.list_size_type = ParseType(words[2]);
      if (!property.list_size_type.has_value() ||
          *property.list_size_type >= PlyType::kFloat) {
        Fail();
      }
    }
    header_.elements.back().properties.push_back(property);
  }

  const std::string& path_;
  std::istream& stream_;
  std::string line_;
  PlyHeader header_;
};

}  // namespace

size_t SizeOf(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat:
      return 4;
    case PlyType::kDouble:
      break;
  }
  return 8;
}

PlyHeader ReadPlyHeader(const std::string& path, std::istream* stream) {
  return HeaderParser(path, stream).Parse();
}

}  // namespace tapa
