#ifndef TAPA_SRC_PICTURES_DEPTH_FILES_H_
#define TAPA_SRC_PICTURES_DEPTH_FILES_H_

#include <functional>
#include <string>

#include "src/base/map.h"

namespace tapa {

// Endings of the names of files that ReadDepthFile knows, the first choice
// first.
constexpr const char* kDepthFileExtensions[] = {".exr", ".pfm", ".png", ".npy"};

// One number per pixel from a file of another program, as it stands there: EXR
// with one channel of any letter (32 or 16 bits), PFM of either byte order, PNG
// of 16 bits in grey, and NPY of floats (16, 32 or 64 bits), little-endian, of
// the shape (height, width). Throws Failure that names the file.
//
// check_size may throw, too. It is asked before pixels are
// decoded, as few bytes may hold any number of them.
using SizeCheck = std::function<void(int width, int height)>;
Map<float> ReadDepthFile(
    const std::string& path, const SizeCheck& check_size = [](int, int) {});

}  // namespace tapa

#endif  // TAPA_SRC_PICTURES_DEPTH_FILES_H_
