#ifndef TAPA_SRC_COLMAP_FUSION_RUN_H_
#define TAPA_SRC_COLMAP_FUSION_RUN_H_

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "src/fusion/fused_cloud.h"
#include "util/ply.h"

// This header is included by COLMAP's own sources.

namespace colmap {
namespace mvs {
struct StereoFusionOptions;
}  // namespace mvs
}  // namespace colmap

namespace tapa {

// Fuses a workspace with the rule that weighs agreement. Parameters as of
// COLMAP's StereoFusion. Reports what it does, and what is wrong in one line.
// Returns the exit status, 0 with the points in the cloud, whose views and
// neighbours are then indices in the model.
int FuseWorkspace(const colmap::mvs::StereoFusionOptions& options,
                  const std::string& workspace_path,
                  const std::string& workspace_format,
                  const std::string& pmvs_option_name,
                  const std::string& input_type,
                  const std::function<bool()>& is_stopped,
                  std::shared_ptr<const FusedCloud>* cloud);

// The points without confidence and visibility.
std::vector<colmap::PlyPoint> PlyPoints(const FusedCloud& cloud);

// Write PATH and PATH.vis, in COLMAP's formats, the first with the property
// `confidence` in addition. Files appear under their name when they are
// complete, PATH last. What goes wrong ends the program as COLMAP's CHECK does.
void WriteFusedCloud(const std::string& path, const FusedCloud& cloud);
// The same for points of COLMAP's rule.
void WriteFusedCloud(const std::string& path,
                     const std::vector<colmap::PlyPoint>& points,
                     const std::vector<std::vector<int>>& visibility);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_FUSION_RUN_H_
