#ifndef TAPA_SRC_COLMAP_VIEWS_H_
#define TAPA_SRC_COLMAP_VIEWS_H_

#include <string>
#include <vector>

#include "mvs/model.h"
#include "src/base/map.h"
#include "src/mvs/view.h"
#include "util/bitmap.h"

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

// Whether images of these sizes have the same ratio of their sides, to a pixel.
bool HaveSameShape(int width, int height, int other_width, int other_height);

// Throws Failure unless what belongs to a photograph, such as a mask, has its
// shape. It may be larger, but only so much: few bytes may hold any number of
// pixels. what: begins the message, with the name of the file; advice: ends it.
void CheckShapeOfPhoto(const std::string& what, int width, int height,
                       int photo_width, int photo_height,
                       const std::string& advice);

// As in "640x480".
std::string SizeText(size_t width, size_t height);

// Width and height of an image in a file, without reading its pixels. Throws
// Failure if that is missing or no image.
std::pair<size_t, size_t> ReadImageSize(const std::string& path);

// Reads a photograph. Throws Failure if it is missing or damaged, or, where a
// size is given, if it has another than that of its camera: before its pixels
// are read, as few bytes may hold any number of them.
colmap::Bitmap ReadBitmap(const std::string& path, bool in_color);
colmap::Bitmap ReadBitmap(const std::string& path, bool in_color, int width,
                          int height);

// Throws Failure that says what to do, if the sizes differ.
void CheckPhotoSize(const std::string& path, size_t width, size_t height,
                    size_t camera_width, size_t camera_height);

// Read the photograph, in grey or in colour, at the size that stereo works at.
// Throw Failure as above.
Map<uint8_t> ReadPhoto(const SceneView& view);
Map<Rgb> ReadColorPhoto(const SceneView& view);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_VIEWS_H_
