#ifndef TAPA_TESTS_FUZZ_MODEL_H_
#define TAPA_TESTS_FUZZ_MODEL_H_

#include <string>
#include <string_view>

#include "mvs/model.h"

namespace tapa {

// Reads the sparse model of a workspace. input: cameras, images and points as
// SplitParts tells them apart. extension: of the files. Throws Failure.
colmap::mvs::Model ReadModelInput(std::string_view input,
                                  const std::string& extension);

// The same, and goes on as dense stereo does, up to its views.
void ReadModelAndViews(std::string_view input, const std::string& extension);

}  // namespace tapa

#endif  // TAPA_TESTS_FUZZ_MODEL_H_
