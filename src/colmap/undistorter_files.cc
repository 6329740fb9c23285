#include "src/colmap/undistorter_files.h"

#include <filesystem>
#include <memory>
#include <mutex>
#include <system_error>

#include "src/base/atomic_file.h"
#include "src/base/failure.h"
#include "src/colmap/fatal_errors.h"
#include "src/colmap/photo_formats.h"
#include "src/colmap/progress.h"
#include "src/colmap/views.h"
#include "util/misc.h"

namespace tapa {
namespace {

bool IsSame(const std::string& path, const std::string& other) {
  std::error_code ignored;
  return std::filesystem::equivalent(path, other, ignored);
}

void WarnOfPhoto(const Failure& error) {
  PrintWarning(std::string(error.what()) + "; it is left out");
}

// Photographs are written by several threads, and the library takes its list of
// names apart with strtok(), whose place in it they would share.
FREE_IMAGE_FORMAT FormatOfName(const std::string& path) {
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  const FREE_IMAGE_FORMAT format = FreeImage_GetFIFFromFilename(path.c_str());
  return format == FIF_UNKNOWN ? FIF_PNG : format;
}

}  // namespace

void CheckUndistorterPaths(const std::string& image_path,
                           const std::string& input_path,
                           const std::string& output_path) {
  for (const char* part : {"images", "sparse"}) {
    const std::string output = colmap::JoinPaths(output_path, part);
    for (const std::string& input : {image_path, input_path}) {
      if (IsSame(input, output)) {
        throw Failure("The undistorter would write into " + output +
                      ", which it reads from; name another --output_path");
      }
    }
  }
}

bool HasSizeOf(const colmap::Camera& camera, const std::string& path) {
  try {
    const auto size = ReadImageSize(path);
    CheckPhotoSize(path, size.first, size.second, camera.Width(),
                   camera.Height());
  } catch (const ReadFailure&) {
    throw;
  } catch (const Failure& error) {
    WarnOfPhoto(error);
    return false;
  }
  return true;
}

bool ReadPhotoOf(const colmap::Camera& camera, const std::string& path,
                 colmap::Bitmap* bitmap) {
  try {
    *bitmap =
        ReadBitmap(path, /* in_color */ true, static_cast<int>(camera.Width()),
                   static_cast<int>(camera.Height()));
  } catch (const ReadFailure&) {
    throw;
  } catch (const Failure& error) {
    WarnOfPhoto(error);
    return false;
  }
  return true;
}

void WritePhoto(const colmap::Bitmap& bitmap, const std::string& path) {
  const FREE_IMAGE_FORMAT format = FormatOfName(path);
  // As COLMAP does. The library does not look at what becomes of a file's end.
  const int flags = format == FIF_JPEG ? JPEG_QUALITYSUPERB : 0;
  const std::unique_ptr<FIMEMORY, decltype(&FreeImage_CloseMemory)> memory(
      FreeImage_OpenMemory(), &FreeImage_CloseMemory);
  BYTE* data = nullptr;
  DWORD size = 0;
  // It asks for a picture that it may change, and does not.
  if (!FreeImage_SaveToMemory(format, const_cast<FIBITMAP*>(bitmap.Data()),
                              memory.get(), flags) ||
      !FreeImage_AcquireMemory(memory.get(), &data, &size)) {
    throw Failure("The image " + path + " cannot be written in its format");
  }
  AtomicFile file(path);
  file.Write(data, size);
  file.Commit();
}

void RemoveOutput(const std::string& input_path,
                  const std::string& output_path) {
  if (IsSame(colmap::GetParentDir(input_path),
             colmap::GetParentDir(output_path))) {
    throw Failure("The undistorter would write " + output_path +
                  ", which it reads; name another --output_path");
  }
  std::error_code ignored;  // Writing fails then.
  std::filesystem::remove(output_path, ignored);
}

bool ReportUndistorted(size_t num_undistorted, size_t num_all) {
  if (num_undistorted == 0) {
    PrintError(
        "No photograph could be undistorted; is --image_path the folder that "
        "the names in the model are relative to, and are the photographs the "
        "ones that the model was made from");
    return false;
  }
  if (num_undistorted < num_all) {
    PrintWarning(std::to_string(num_all - num_undistorted) + " of " +
                 std::to_string(num_all) +
                 " photographs could not be undistorted and are left out");
  }
  return true;
}

void WarnOfCut(colmap::UndistortCameraOptions options,
               const colmap::Reconstruction& model) {
  const colmap::UndistortCameraOptions defaults;
  options.max_image_size = -1;
  options.roi_min_x = defaults.roi_min_x;
  options.roi_min_y = defaults.roi_min_y;
  options.roi_max_x = defaults.roi_max_x;
  options.roi_max_y = defaults.roi_max_y;
  for (const auto& [id, camera] : model.Cameras()) {
    const colmap::Camera undistorted = colmap::UndistortCamera(options, camera);
    const auto num_pixels = [](const colmap::Camera& of) {
      return 1.0 * static_cast<double>(of.Width()) *
             static_cast<double>(of.Height());
    };
    if (num_pixels(undistorted) < 0.5 * num_pixels(camera)) {
      PrintWarning("Without the distortion of camera " + std::to_string(id) +
                   ", " + std::to_string(undistorted.Width()) + "x" +
                   std::to_string(undistorted.Height()) + " of " +
                   std::to_string(camera.Width()) + "x" +
                   std::to_string(camera.Height()) +
                   " pixels are left; is the model right? --blank_pixels and "
                   "--min_scale say how much is cut");
    }
  }
}

}  // namespace tapa
