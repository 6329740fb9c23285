#include "src/colmap/text_files.h"

#include <cerrno>
#include <cstring>

#include "src/base/failure.h"

namespace tapa {

TextLines::TextLines(const std::string& path) : path_(path), file_(path) {
  if (!file_) {
    throw Failure(path + " cannot be opened: " + std::strerror(errno));
  }
}

bool TextLines::Next(std::string* line) {
  if (!std::getline(file_, *line)) {
    if (file_.bad()) {
      throw Failure(path_ + " cannot be read: " + std::strerror(errno));
    }
    return false;
  }
  constexpr char kByteOrderMark[] = "\xef\xbb\xbf";
  if (++number_ == 1 && line->compare(0, 3, kByteOrderMark) == 0) {
    line->erase(0, 3);
  }
  if (!line->empty() && line->back() == '\r') {
    line->pop_back();
  }
  return true;
}

std::string ReadWholeFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw ReadFailure(path + " cannot be opened: " + std::strerror(errno));
  }
  std::string content;
  char buffer[4096];
  do {
    file.read(buffer, sizeof(buffer));
    content.append(buffer, static_cast<size_t>(file.gcount()));
  } while (file);
  if (file.bad()) {
    throw ReadFailure(path + " cannot be read: " + std::strerror(errno));
  }
  return content;
}

std::string Trim(const std::string& text) {
  constexpr char kSpace[] = " \t\r\n\v\f";
  const size_t begin = text.find_first_not_of(kSpace);
  if (begin == std::string::npos) {
    return "";
  }
  return text.substr(begin, text.find_last_not_of(kSpace) - begin + 1);
}

bool IsNotBlank(const std::string& text) { return !Trim(text).empty(); }

std::vector<std::string> ReadImageNames(
    const std::string& path,
    const std::function<bool(const std::string&)>& is_name) {
  std::vector<std::string> names;
  TextLines lines(path);
  std::string line;
  while (lines.Next(&line)) {
    if (!is_name(line)) {
      line = Trim(line);
      if (line.empty() || (line[0] == '#' && !is_name(line))) {
        continue;
      }
    }
    names.push_back(line);
  }
  return names;
}

}  // namespace tapa
