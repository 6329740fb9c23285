#ifndef TAPA_SRC_COLMAP_TAPA_DEBUG_H_
#define TAPA_SRC_COLMAP_TAPA_DEBUG_H_

#include <functional>
#include <string>

#include "src/pictures/tapa_pictures.h"

namespace tapa {

// Draws the pictures of a view into its folder, which has to be there, as PNG.
// Each is there under its name only when it is complete. Pictures of an earlier
// run that are not drawn this time are removed, as they would tell of other
// maps. Returns false if stopped. Throws Failure if they cannot be written.
bool WriteTapaPictures(const TapaView& view, const std::string& folder,
                       const std::function<bool()>& stopped);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_TAPA_DEBUG_H_
