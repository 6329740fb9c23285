#ifndef TAPA_SRC_COLMAP_MODEL_FILES_H_
#define TAPA_SRC_COLMAP_MODEL_FILES_H_

#include <string>
#include <vector>

#include "base/camera.h"
#include "base/image.h"
#include "base/point3d.h"
#include "util/types.h"

// This header is included by COLMAP's own sources.

namespace tapa {

// The parts of COLMAP's Reconstruction that its files hold.
struct ModelParts {
  EIGEN_STL_UMAP(colmap::camera_t, colmap::Camera) * cameras;
  EIGEN_STL_UMAP(colmap::image_t, colmap::Image) * images;
  EIGEN_STL_UMAP(colmap::point3D_t, colmap::Point3D) * points;
  // Of the images, in the order of the file.
  std::vector<colmap::image_t>* image_ids;
  // The largest one.
  colmap::point3D_t* max_point_id;
};

// Read cameras, images and points3D, .txt or .bin, from a folder, in place of
// COLMAP's readers, which trust them. Throw Failure that names the file, where
// in it, and what is wrong: parts that are missing or make no sense, numbers
// that poses and cameras cannot have, and references to what is not there.
//
// In text, numbers are separated by blanks or tabs, and lines may end as on
// Windows and begin with a byte order mark. The name of an image is the rest of
// its line. It may begin with a blank if single blanks separate all before it,
// as COLMAP writes them.
void ReadTextModel(const std::string& folder, const ModelParts& parts);
void ReadBinaryModel(const std::string& folder, const ModelParts& parts);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_MODEL_FILES_H_
