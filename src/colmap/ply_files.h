#ifndef TAPA_SRC_COLMAP_PLY_FILES_H_
#define TAPA_SRC_COLMAP_PLY_FILES_H_

#include <string>

// This header is included by COLMAP's own sources.

namespace tapa {

// Whether a binary PLY file is there and is whole: of the length that its
// header asks for. Its last property may be a list, as that of faces is.
bool IsWholePly(const std::string& path);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_PLY_FILES_H_
