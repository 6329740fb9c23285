#ifndef TAPA_SRC_COLMAP_UNDISTORTER_FILES_H_
#define TAPA_SRC_COLMAP_UNDISTORTER_FILES_H_

#include <cstddef>
#include <string>

#include "base/camera.h"
#include "base/reconstruction.h"
#include "base/undistortion.h"
#include "util/bitmap.h"

// This header is included by COLMAP's own sources.

namespace tapa {

// Throws Failure if the undistorter would write over the photographs or the
// model that it reads.
void CheckUndistorterPaths(const std::string& image_path,
                           const std::string& input_path,
                           const std::string& output_path);

// Prints a warning, and returns false, unless the photograph has the size of
// its camera.
bool HasSizeOf(const colmap::Camera& camera, const std::string& path);

// Reads a photograph. Prints a warning, and returns false, if it is damaged or
// does not have the size of its camera. Throws ReadFailure.
bool ReadPhotoOf(const colmap::Camera& camera, const std::string& path,
                 colmap::Bitmap* bitmap);

// Writes a photograph, or a mask, in the format that its name says, or PNG.
// Throws Failure.
void WritePhoto(const colmap::Bitmap& bitmap, const std::string& path);

// Makes room for what is made of an input. A link there, as another run may
// have made it, would be written through. Throws Failure if it is the input
// itself.
void RemoveOutput(const std::string& input_path,
                  const std::string& output_path);

// Prints what became of a number of photographs. Returns false if there is none
// to go on with.
bool ReportUndistorted(size_t num_undistorted, size_t num_all);

// Warns of cameras of which undistortion leaves less than half.
void WarnOfCut(colmap::UndistortCameraOptions options,
               const colmap::Reconstruction& model);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_UNDISTORTER_FILES_H_
