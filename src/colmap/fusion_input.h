#ifndef TAPA_SRC_COLMAP_FUSION_INPUT_H_
#define TAPA_SRC_COLMAP_FUSION_INPUT_H_

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "mvs/fusion.h"
#include "mvs/image.h"
#include "util/bitmap.h"

// This header is included by COLMAP's own sources.

namespace tapa {

// The names of the images that the workspace's fusion.cfg lists, after a look
// for whatever can be wrong with them: maps of the input type ("geometric" or
// "photometric") that are damaged, were made from other poses or are not there
// at all, and masks that are not found. Prints an error and returns nothing if
// there is nothing to fuse.
std::vector<std::string> FusionImages(
    const colmap::mvs::StereoFusionOptions& options, const std::string& path,
    const std::string& format, const std::string& pmvs_option_name,
    const std::string& input_type);

// Says that nothing came out of fusion, and what may help.
void ReportNoPoints(const colmap::mvs::StereoFusionOptions& options);

// Reads the photograph of an image of the model, in colour. Ends the program
// with a line if it cannot be read or, unless the image was scaled for fusion,
// is not of the size that its camera has.
void ReadFusionPhoto(const colmap::mvs::Image& image, bool is_scaled,
                     colmap::Bitmap* bitmap);

// Reads the two corners of a box, six numbers, and returns them relative to the
// origin. Throws Failure if that is not what the file has.
std::pair<Eigen::Vector3f, Eigen::Vector3f> ReadBoundingBox(
    const std::string& path, const Eigen::Vector3d& origin);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_FUSION_INPUT_H_
