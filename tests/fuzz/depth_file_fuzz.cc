// Depth maps of other programs (src/pictures/depth_files.h). The first byte of
// an input chooses the format. OpenCV's decoders are not ours: what is looked
// at is what we do before and after them.

#include <cstdlib>
#include <iterator>
#include <utility>

#include "src/base/failure.h"
#include "src/pictures/depth_files.h"
#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace tapa;
  if (size == 0) {
    return 0;
  }
  const std::string extension =
      kDepthFileExtensions[data[0] % std::size(kDepthFileExtensions)];
  const std::string path =
      Folder().Write("depth" + extension, ToText(data + 1, size - 1));
  ReadOrRefuse(path, [&] {
    std::pair<int, int> size;
    const Map<float> map = ReadDepthFile(path, [&](int width, int height) {
      size = {width, height};
      // As a photograph limits it.
      if (width > 1000 || height > 1000) {
        throw Failure(path + " is too large");
      }
    });
    if (size != std::pair(map.width(), map.height())) {
      std::abort();
    }
  });
  return 0;
}
