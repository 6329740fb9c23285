#include "tests/fuzz/input.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "src/base/failure.h"

namespace tapa {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void Find(const std::string& what) {
  std::fprintf(stderr, "FOUND: %s\n", what.c_str());
  std::abort();
}

}  // namespace

InputFolder::InputFolder() {
  const bool has_memory = access("/dev/shm", W_OK) == 0;
  std::string path =
      (has_memory ? fs::path("/dev/shm") : fs::temp_directory_path()) /
      "tapa-fuzz-XXXXXX";
  if (mkdtemp(path.data()) == nullptr) {
    Find("no folder for inputs can be made at " + path);
  }
  path_ = path;
}

InputFolder::~InputFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string InputFolder::Path(const std::string& name) const {
  return path_ + "/" + name;
}

std::string InputFolder::Write(const std::string& name,
                               std::string_view content) const {
  std::ofstream file(Path(name), std::ios::binary);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  if (!file.flush()) {
    Find("an input cannot be written to " + Path(name));
  }
  return Path(name);
}

const InputFolder& Folder() {
  static const InputFolder folder;
  return folder;
}

std::string_view ToText(const uint8_t* data, size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

std::vector<std::string_view> SplitParts(std::string_view text, size_t count) {
  constexpr std::string_view kLine = "----\n";
  std::vector<std::string_view> parts;
  while (parts.size() + 1 < count) {
    const size_t end = text.find(kLine);
    parts.push_back(text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view()
                                         : text.substr(end + kLine.size());
  }
  parts.push_back(text);
  return parts;
}

void ReadOrRefuse(const std::string& file, const std::function<void()>& read) {
  try {
    read();
  } catch (const Failure& error) {
    const std::string line = error.what();
    if (line.find(file) == std::string::npos) {
      Find("a failure that does not name " + file + ": " + line);
    }
  }
}

}  // namespace tapa
