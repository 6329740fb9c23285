#include "src/colmap/views.h"

#include <FreeImage.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "mvs/image.h"
#include "src/base/failure.h"
#include "src/colmap/photo_formats.h"
#include "src/mvs/levels.h"
#include "util/bitmap.h"

namespace tapa {
namespace {

Camera ToCamera(const colmap::mvs::Image& image) {
  Camera camera;
  const float* K = image.GetK();
  camera.fx = K[0];
  camera.fy = K[4];
  camera.cx = K[2];
  camera.cy = K[5];
  for (int i = 0; i < 9; ++i) {
    camera.R[i] = image.GetR()[i];
  }
  for (int i = 0; i < 3; ++i) {
    camera.t[i] = image.GetT()[i];
  }
  return camera;
}

// Whether the library has said, since this was cleared, that image data end
// too early. It fills the rest with grey and calls it a success.
thread_local bool is_truncated = false;

void NoteMessage(FREE_IMAGE_FORMAT, const char* message) {
  // "Premature end of JPEG file", "Corrupt JPEG data: premature end of ...".
  // Other corrupt data, such as stray bytes between markers, may do no harm.
  if (std::strstr(message, "remature end") != nullptr) {
    is_truncated = true;
  }
}

[[noreturn]] void FailToRead(const std::string& path) {
  throw Failure("The image " + path +
                " cannot be read; is it there, and is it a whole image?");
}

// Of a strip that is scaled down.
void CheckThatPixelsAreLeft(const SceneView& view, int longest_side) {
  if (view.width < 1 || view.height < 1) {
    throw Failure("The image " + view.image_path + " has " +
                  SizeText(view.photo_width, view.photo_height) +
                  " pixels, so that nothing is left of it at a longest side "
                  "of " +
                  std::to_string(longest_side) +
                  "; take it out of the model, or give a larger "
                  "max_image_size and fewer num_levels");
  }
}

colmap::Bitmap ReadScaled(const SceneView& view, bool in_color) {
  colmap::Bitmap bitmap = ReadBitmap(view.image_path, in_color,
                                     view.photo_width, view.photo_height);
  if (view.width != view.photo_width || view.height != view.photo_height) {
    bitmap.Rescale(view.width, view.height);
  }
  return bitmap;
}

}  // namespace

std::vector<SceneView> SceneViews(const colmap::mvs::Model& model,
                                  int max_image_size, int level) {
  const auto depth_ranges = model.ComputeDepthRanges();
  std::vector<SceneView> views;
  for (size_t i = 0; i < model.images.size(); ++i) {
    colmap::mvs::Image image = model.images[i];
    SceneView view;
    view.name = model.GetImageName(i);
    view.image_path = image.GetPath();
    view.photo_width = static_cast<int>(image.GetWidth());
    view.photo_height = static_cast<int>(image.GetHeight());
    if (max_image_size > 0) {
      image.Downsize(max_image_size, max_image_size);
    }
    const int longest_side =
        static_cast<int>(std::max(image.GetWidth(), image.GetHeight()));
    const int size_at_level = LongestSideAtLevel(longest_side, level);
    image.Downsize(size_at_level, size_at_level);
    view.width = static_cast<int>(image.GetWidth());
    view.height = static_cast<int>(image.GetHeight());
    CheckThatPixelsAreLeft(view, size_at_level);
    view.camera = ToCamera(image);
    view.depth_min = depth_ranges[i].first;
    view.depth_max = depth_ranges[i].second;
    views.push_back(view);
  }
  return views;
}

bool HaveSameShape(int width, int height, int other_width, int other_height) {
  const double difference =
      std::abs(1.0 * width * other_height - 1.0 * height * other_width);
  return difference <= std::max({width, height, other_width, other_height});
}

void CheckShapeOfPhoto(const std::string& what, int width, int height,
                       int photo_width, int photo_height,
                       const std::string& advice) {
  constexpr double kMaxScale = 16;
  const std::string size = what + " has " + SizeText(width, height) + " pixels";
  const std::string photo = SizeText(photo_width, photo_height);
  if (!HaveSameShape(width, height, photo_width, photo_height)) {
    throw Failure(size + ", which is not the shape of its photograph of " +
                  photo + "; " + advice);
  }
  if (width > kMaxScale * photo_width) {
    throw Failure(size +
                  ", more than 16 times the width of its photograph "
                  "of " +
                  photo + "; make it smaller");
  }
}

std::string SizeText(size_t width, size_t height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

std::pair<size_t, size_t> ReadImageSize(const std::string& path) {
  const FREE_IMAGE_FORMAT format = FreeImage_GetFileType(path.c_str());
  const std::unique_ptr<FIBITMAP, decltype(&FreeImage_Unload)> header(
      format == FIF_UNKNOWN
          ? nullptr
          : FreeImage_Load(format, path.c_str(), FIF_LOAD_NOPIXELS),
      &FreeImage_Unload);
  if (header == nullptr) {
    // It tells whether it was reading that failed.
    FreeImage_Unload(LoadPicture(path, FIF_LOAD_NOPIXELS));
    FailToRead(path);
  }
  return {FreeImage_GetWidth(header.get()), FreeImage_GetHeight(header.get())};
}

colmap::Bitmap ReadBitmap(const std::string& path, bool in_color) {
  is_truncated = false;
  FreeImage_SetOutputMessage(&NoteMessage);
  colmap::Bitmap bitmap;
  if (!bitmap.Read(path, in_color) || is_truncated) {
    FailToRead(path);
  }
  return bitmap;
}

colmap::Bitmap ReadBitmap(const std::string& path, bool in_color, int width,
                          int height) {
  const auto size = ReadImageSize(path);
  CheckPhotoSize(path, size.first, size.second, width, height);
  return ReadBitmap(path, in_color);
}

void CheckPhotoSize(const std::string& path, size_t width, size_t height,
                    size_t camera_width, size_t camera_height) {
  if (width != camera_width || height != camera_height) {
    throw Failure("The image " + path + " has " + SizeText(width, height) +
                  " pixels, but its camera has " +
                  SizeText(camera_width, camera_height) +
                  "; take the photograph that the model was made from, or "
                  "scale it to that size");
  }
}

Map<uint8_t> ReadPhoto(const SceneView& view) {
  const std::vector<uint8_t> pixels =
      ReadScaled(view, /* in_color */ false).ConvertToRowMajorArray();
  Map<uint8_t> image(view.width, view.height);
  std::memcpy(image.data(), pixels.data(), image.size());
  return image;
}

Map<Rgb> ReadColorPhoto(const SceneView& view) {
  // The channels are in the order of FreeImage.
  const std::vector<uint8_t> channels =
      ReadScaled(view, /* in_color */ true).ConvertToRowMajorArray();
  Map<Rgb> image(view.width, view.height);
  for (size_t i = 0; i < image.size(); ++i) {
    const uint8_t* pixel = &channels[3 * i];
    image.data()[i] = {pixel[FI_RGBA_RED], pixel[FI_RGBA_GREEN],
                       pixel[FI_RGBA_BLUE]};
  }
  return image;
}

}  // namespace tapa
