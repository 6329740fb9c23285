// Sparse models in text files (src/colmap/model_files.h).

#include "tests/fuzz/input.h"
#include "tests/fuzz/model.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  tapa::ReadModelAndViews(tapa::ToText(data, size), ".txt");
  return 0;
}
