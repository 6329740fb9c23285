#ifndef TAPA_SRC_COLMAP_FUSION_INPUT_H_
#define TAPA_SRC_COLMAP_FUSION_INPUT_H_

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "mvs/fusion.h"
#include "mvs/image.h"
#include "src/colmap/folder_lock.h"
#include "src/colmap/pass.h"
#include "src/colmap/views.h"
#include "src/colmap/workspace.h"
#include "util/bitmap.h"

// This header is included by COLMAP's own sources.

namespace tapa {

// Parameters as of COLMAP's StereoFusion.
WorkspaceLocation FusionLocation(const std::string& path,
                                 const std::string& format,
                                 const std::string& pmvs_option_name);
Pass FusionPass(const std::string& input_type);

// The views to fuse, as indices in the model (views: SceneViews of any size):
// those that the workspace's fusion.cfg lists and that have maps of the pass
// and a photograph; it warns of others. Throws Failure if there are none, or if
// there is anything wrong with them: maps that are damaged, that are not of the
// shape of their photograph or that were made from other poses, and masks as
// CheckMasks finds.
std::vector<int> ViewsToFuse(const std::vector<SceneView>& views,
                             const WorkspaceLocation& location, Pass pass,
                             const std::string& mask_path);

// The names of the same for COLMAP's rule, which is to hold the lock as long as
// it reads maps. Prints an error and returns nothing in place of a Failure.
std::vector<std::string> FusionImages(
    const colmap::mvs::StereoFusionOptions& options, const std::string& path,
    const std::string& format, const std::string& pmvs_option_name,
    const std::string& input_type, std::shared_ptr<const FolderLock>* lock);

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
