#include "src/colmap/ply_files.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <system_error>
#include <vector>

namespace tapa {
namespace {

struct Element {
  uint64_t count = 0;
  // Of one, without a list.
  uint64_t size = 0;
  // Of a value of its list; 0: there is none.
  uint64_t list_value_size = 0;
};

uint64_t SizeOf(const std::string& type) {
  static const std::map<std::string, uint64_t> sizes = {
      {"float", 4}, {"double", 8}, {"uchar", 1}, {"int", 4}};
  const auto found = sizes.find(type);
  return found == sizes.end() ? 0 : found->second;
}

// Returns nothing if the header does not end.
std::vector<Element> ReadHeader(std::istream* file) {
  std::vector<Element> elements;
  std::string line;
  while (std::getline(*file, line) && line != "end_header") {
    std::istringstream words(line);
    std::string key;
    std::string type;
    words >> key >> type;
    if (key == "element") {
      elements.emplace_back();
      words >> elements.back().count;
    } else if (key == "property" && !elements.empty()) {
      if (type == "list") {
        words >> type >> type;  // Numbers of values are bytes.
        elements.back().list_value_size = SizeOf(type);
      } else {
        elements.back().size += SizeOf(type);
      }
    }
  }
  return line == "end_header" ? elements : std::vector<Element>();
}

}  // namespace

bool IsWholePly(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<Element> elements = ReadHeader(&file);
  for (const Element& element : elements) {
    if (element.list_value_size == 0) {
      file.seekg(element.count * element.size, std::ios::cur);
      continue;
    }
    for (uint64_t i = 0; i < element.count && file; ++i) {
      file.ignore(element.size);
      file.ignore(file.get() * element.list_value_size);
    }
  }
  std::error_code error;
  return !elements.empty() && file &&
         static_cast<uint64_t>(file.tellg()) ==
             std::filesystem::file_size(path, error) &&
         !error;
}

}  // namespace tapa
