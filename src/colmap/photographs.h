#ifndef TAPA_SRC_COLMAP_PHOTOGRAPHS_H_
#define TAPA_SRC_COLMAP_PHOTOGRAPHS_H_

#include <string>
#include <vector>

// This header is included by COLMAP's own sources.

namespace tapa {

// The names, relative to a folder, of the photographs in it and below, in their
// order; without other files, and without what is in the workspace, which may
// stand below it.
std::vector<std::string> FindPhotographs(const std::string& image_path,
                                         const std::string& workspace_path);

// A workspace remembers its photographs, in photographs.txt. Prints a warning
// if others have come under the same names; prints an error, and returns false,
// if there are none.
bool KeepPhotographs(const std::string& image_path,
                     const std::string& workspace_path);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_PHOTOGRAPHS_H_
