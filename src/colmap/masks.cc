#include "src/colmap/masks.h"

#include <filesystem>

#include "base/warp.h"
#include "src/base/failure.h"
#include "src/base/parallel.h"
#include "src/colmap/part_files.h"
#include "src/colmap/progress.h"
#include "src/colmap/undistorter_files.h"
#include "util/bitmap.h"
#include "util/misc.h"

namespace tapa {
namespace {

namespace fs = std::filesystem;

std::string MaskName(const std::string& image_name) {
  return image_name + ".png";
}

template <typename Read>
auto ReadOrExplain(const std::string& path, const Read& read) {
  try {
    return read();
  } catch (const Failure&) {
    throw Failure("The mask " + path +
                  " cannot be read; write it again, or remove it to mask "
                  "nothing of its image");
  }
}

// Reads a mask in grey, of any size. width, height: of its photograph. kind: of
// photographs, for the message.
colmap::Bitmap ReadWholeMask(const std::string& path, int width, int height,
                             const std::string& kind) {
  const auto size = ReadOrExplain(path, [&] { return ReadImageSize(path); });
  CheckShapeOfPhoto("The mask " + path, static_cast<int>(size.first),
                    static_cast<int>(size.second), width, height,
                    "make it of " + kind);
  return ReadOrExplain(path,
                       [&] { return ReadBitmap(path, /* in_color */ false); });
}

colmap::Bitmap ReadWholeMask(const std::string& path, const SceneView& view) {
  return ReadWholeMask(
      path, view.photo_width, view.photo_height,
      "the photograph in the workspace, which is without distortion");
}

// Black where all that a pixel covers is.
void Rescale(int width, int height, colmap::Bitmap* mask) {
  if (mask->Width() != width || mask->Height() != height) {
    mask->Rescale(width, height, FILTER_BOX);
  }
}

// Nobody names a folder of masks to have none: without an error, hours would be
// spent because of a name that is spelt wrong. missing: the names of masks that
// are not there, of `count` images.
void CheckMissing(const std::string& folder,
                  const std::vector<std::string>& missing, size_t count) {
  if (missing.size() == count) {
    throw Failure((colmap::ExistsDir(folder) ? "There are no masks in "
                                             : "There is no folder of masks ") +
                  folder +
                  "; they have the names of the images with .png after them, "
                  "as in " +
                  missing[0] + ", and without mask_path nothing is masked");
  }
  if (!missing.empty()) {
    PrintWarning(std::to_string(missing.size()) + " of " +
                 std::to_string(count) +
                 " images have no mask and are taken as a whole; such as " +
                 missing[0] + " is not in " + folder);
  }
}

void UndistortMask(const std::string& path, const colmap::Camera& camera,
                   const colmap::Camera& undistorted_camera,
                   const std::string& output_path) {
  const int width = static_cast<int>(camera.Width());
  const int height = static_cast<int>(camera.Height());
  colmap::Bitmap mask = ReadWholeMask(path, width, height, "the photograph");
  Rescale(width, height, &mask);
  if (!camera.IsUndistorted()) {
    colmap::Bitmap undistorted;
    colmap::WarpImageBetweenCameras(camera, undistorted_camera, mask,
                                    &undistorted);
    mask = undistorted;
  }
  std::error_code ignored;  // Writing fails then.
  fs::create_directories(fs::path(output_path).parent_path(), ignored);
  WritePhoto(mask, output_path);
}

}  // namespace

std::string MaskPath(const std::string& folder, const std::string& image_name) {
  if (folder.empty()) {
    return "";
  }
  const std::string path = colmap::JoinPaths(folder, MaskName(image_name));
  return colmap::ExistsFile(path) ? path : "";
}

void CheckMasks(const std::string& folder, const std::vector<SceneView>& scene,
                const std::vector<int>& views) {
  if (folder.empty() || views.empty()) {
    return;
  }
  std::vector<std::string> missing;
  for (const int index : views) {
    const std::string path = MaskPath(folder, scene[index].name);
    if (path.empty()) {
      missing.push_back(MaskName(scene[index].name));
    } else {
      ReadWholeMask(path, scene[index]);
    }
  }
  CheckMissing(folder, missing, views.size());
}

Map<uint8_t> ReadMask(const std::string& folder, const SceneView& view) {
  const std::string path = MaskPath(folder, view.name);
  if (path.empty()) {
    return {};
  }
  colmap::Bitmap bitmap = ReadWholeMask(path, view);
  Rescale(view.width, view.height, &bitmap);
  const std::vector<uint8_t> grey = bitmap.ConvertToRowMajorArray();
  Map<uint8_t> mask(view.width, view.height);
  for (size_t i = 0; i < mask.size(); ++i) {
    mask.data()[i] = grey[i] == 0 ? 1 : 0;
  }
  return mask;
}

std::string UndistortMasks(const std::string& folder,
                           const colmap::Reconstruction& model,
                           const std::string& workspace_path) {
  if (folder.empty()) {
    return "";
  }
  colmap::Reconstruction undistorted;
  undistorted.Read(colmap::JoinPaths(workspace_path, "sparse"));
  std::vector<colmap::image_t> masked;
  std::vector<std::string> missing;
  for (const colmap::image_t id : undistorted.RegImageIds()) {
    const std::string& name = undistorted.Image(id).Name();
    if (MaskPath(folder, name).empty()) {
      missing.push_back(MaskName(name));
    } else {
      masked.push_back(id);
    }
  }
  CheckMissing(folder, missing, undistorted.NumRegImages());

  const std::string output = colmap::JoinPaths(workspace_path, "masks");
  const std::string part = MakePart(output);
  ThreadTeam(-1).For(
      static_cast<int>(masked.size()), 1,
      [&](int, int begin, int end, const ContinueCheck&) {
        for (int i = begin; i < end; ++i) {
          const colmap::Image& image = undistorted.Image(masked[i]);
          UndistortMask(MaskPath(folder, image.Name()),
                        model.Camera(model.Image(masked[i]).CameraId()),
                        undistorted.Camera(image.CameraId()),
                        colmap::JoinPaths(part, MaskName(image.Name())));
        }
      },
      [](double) { return true; });
  CommitPart(output);
  return output;
}

}  // namespace tapa
