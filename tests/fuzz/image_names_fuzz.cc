// Lists of images (src/colmap/text_files.h).

#include <cstdlib>

#include "src/colmap/text_files.h"
#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace tapa;
  const std::string path = Folder().Write("names.txt", ToText(data, size));
  ReadOrRefuse(path, [&] {
    const auto is_name = [](const std::string& name) {
      return name == "#1.jpg" || name == " a.jpg ";
    };
    for (const std::string& name : ReadImageNames(path, is_name)) {
      if (name.empty()) {
        std::abort();
      }
    }
  });
  return 0;
}
