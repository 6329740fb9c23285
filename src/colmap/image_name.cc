#include "src/colmap/image_name.h"

#include <algorithm>
#include <climits>

#include "src/base/failure.h"

namespace tapa {
namespace {

// Line breaks would end a line of the files that list names, and others
// command a terminal.
bool IsControl(char character) {
  const auto code = static_cast<unsigned char>(character);
  return code < 0x20 || code == 0x7f;
}

// On one line of readable length.
std::string Printable(std::string name) {
  constexpr size_t kMaxSize = 100;
  std::replace_if(name.begin(), name.end(), IsControl, '?');
  return name.size() > kMaxSize ? name.substr(0, kMaxSize) + "..." : name;
}

[[noreturn]] void Fail(const std::string& name, const std::string& what) {
  throw Failure("there is an image called '" + Printable(name) + "', " + what +
                "; rename it in the model, to that of a file below the folder "
                "of images");
}

}  // namespace

void CheckImageName(const std::string& name) {
  if (std::any_of(name.begin(), name.end(), IsControl)) {
    Fail(name, "with characters that are not for names");
  }
  if (name.empty() || name[0] == '/') {
    Fail(name, "which is no name relative to a folder");
  }
  if (name.size() >= PATH_MAX) {
    Fail(name, "which is too long for a file");
  }
  for (size_t begin = 0; begin <= name.size();) {
    const size_t end = std::min(name.find('/', begin), name.size());
    if (name.compare(begin, end - begin, "..") == 0) {
      Fail(name, "which leads out of its folder");
    }
    if (end - begin > NAME_MAX) {
      Fail(name, "which is too long for a file");
    }
    begin = end + 1;
  }
}

}  // namespace tapa
