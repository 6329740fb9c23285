// What is looked at of a PLY file of points (src/colmap/ply_files.h).

#include "src/colmap/ply_files.h"
#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace tapa;
  IsWholePly(Folder().Write("fused.ply", ToText(data, size)));
  return 0;
}
