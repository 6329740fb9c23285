#ifndef TAPA_SRC_COLMAP_VIEWS_H_
#define TAPA_SRC_COLMAP_VIEWS_H_

#include <string>
#include <vector>

#include "mvs/model.h"
#include "src/base/map.h"
#include "src/mvs/view.h"

namespace tapa {

// An image of COLMAP's model, as far as stereo needs it.
struct SceneView {
  std::string name;
  std::string image_path;
  // Size of the photograph, in pixels, by the model's camera.
  int photo_width = 0;
  int photo_height = 0;
  // Size that stereo works at, and the camera at that size.
  int width = 0;
  int height = 0;
  Camera camera;
  // Range of the depths that the sparse points suggest; if <= 0, there are no
  // points.
  double depth_min = -1;
  double depth_max = -1;
};

// The images of the model, in its order, at a level (src/mvs/levels.h).
// max_image_size: photographs that are wider or higher, in pixels, are scaled
// down to it for level 0; if <= 0, none is.
std::vector<SceneView> SceneViews(const colmap::mvs::Model& model,
                                  int max_image_size, int level = 0);

// Read the photograph, in grey or in colour, at the size that stereo works at.
// Throw Failure if it is missing, damaged, or not of the size that its camera
// has. Not to be called from two threads at a time.
Map<uint8_t> ReadPhoto(const SceneView& view);
Map<Rgb> ReadColorPhoto(const SceneView& view);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_VIEWS_H_
