#ifndef TAPA_SRC_COLMAP_TAPA_DEBUG_H_
#define TAPA_SRC_COLMAP_TAPA_DEBUG_H_

#include <functional>
#include <string>
#include <vector>

#include "src/pictures/tapa_pictures.h"

namespace tapa {

// Writes pictures of a view into its folder, which has to be there, as PNG.
// Each is there under its name only when it is complete. Returns false if
// stopped. Throws Failure if they cannot be written.
bool WriteTapaPictures(const std::vector<NamedPicture>& pictures,
                       const std::string& folder,
                       const std::function<bool()>& stopped);

// Where the pictures of a view are: named as its photograph, within the folder
// of the option tapa_debug.
std::string PictureFolder(const std::string& tapa_debug,
                          const std::string& view);

// Whether all pictures of a view are there that are always drawn.
bool HasTapaPictures(const std::string& folder);

// Removes the pictures of an earlier run, which would tell of other maps.
void RemoveTapaPictures(const std::string& folder);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_TAPA_DEBUG_H_
