#ifndef TAPA_SRC_COLMAP_MASKS_H_
#define TAPA_SRC_COLMAP_MASKS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "base/reconstruction.h"
#include "src/base/map.h"
#include "src/colmap/views.h"

// This header is included by COLMAP's own sources.

namespace tapa {

// Masks leave pixels of views out of stereo and fusion: FOLDER/<image
// name>.png, as COLMAP names them for features, of the shape of the photograph
// in the workspace but of any size, black (0) where it is masked. A view
// without such a file is not masked, nor is any if the folder's name is empty.

// Path of the mask of an image; empty if there is none.
std::string MaskPath(const std::string& folder, const std::string& image_name);

// Warns of those views, indices of the scene's, that have no mask. Throws
// Failure if none has one, or if ReadMask would throw for one.
void CheckMasks(const std::string& folder, const std::vector<SceneView>& scene,
                const std::vector<int>& views);

// 1 where a view is masked, otherwise 0, at the size that stereo works at;
// empty if the view has no mask. A pixel is masked only if all that it covers
// is. Throws Failure if the mask cannot be read or is of another shape.
Map<uint8_t> ReadMask(const std::string& folder, const SceneView& view);

// Makes, of masks of the photographs that a model was made from, those of the
// workspace that the undistorter has made of it: in a folder there, which it
// returns. Does nothing if the name of the masks' folder is empty. Throws
// Failure as CheckMasks does.
std::string UndistortMasks(const std::string& folder,
                           const colmap::Reconstruction& model,
                           const std::string& workspace_path);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_MASKS_H_
