// Records of what views were made from (src/colmap/views_record.h). What was
// read is the same when it is written and read again.

#include <cstdlib>

#include "src/colmap/views_record.h"
#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace tapa;
  const std::string path = Folder().Write("views.txt", ToText(data, size));
  ReadOrRefuse(path, [&] {
    for (const auto& [name, inputs] : ReadViewsRecord(path)) {
      if (name.empty() || !DescribeDifference(inputs, inputs).empty()) {
        std::abort();
      }
    }
  });
  return 0;
}
