// Depth maps, normal maps and consistency graphs (src/base/map_files.h).

#include "src/base/map_files.h"
#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace tapa;
  const std::string path = Folder().Write("map.bin", ToText(data, size));
  ReadOrRefuse(path, [&] { ReadDepthMap(path); });
  ReadOrRefuse(path, [&] { ReadNormalMap(path); });
  ReadOrRefuse(path, [&] { CheckMapFile(path, MapKind::kConsistencyGraph); });
  return 0;
}
