// Records of options (src/colmap/options_record.h).

#include "src/colmap/options_record.h"
#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace tapa;
  const std::string path = Folder().Write("options.txt", ToText(data, size));
  ReadOrRefuse(path, [&] {
    static const OptionValues options =
        OptionsOfMaps(colmap::mvs::PatchMatchOptions());
    DescribeDifferences(*ReadOptionsRecord(path), options);
  });
  return 0;
}
