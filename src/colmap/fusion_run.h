#ifndef TAPA_SRC_COLMAP_FUSION_RUN_H_
#define TAPA_SRC_COLMAP_FUSION_RUN_H_

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>

#include "src/fusion/fused_cloud.h"

// This header is included by COLMAP's own sources.

namespace colmap {
namespace mvs {
struct StereoFusionOptions;
}  // namespace mvs
}  // namespace colmap

namespace tapa {

// Fuses a workspace with the rule that weighs agreement. Parameters as of
// COLMAP's StereoFusion. Reports what it does, and what is wrong in one line.
// Returns the exit status, 0 with points in the cloud, whose views and
// neighbours are then indices in the model, and which is relative to the origin
// (LocalOrigin).
int FuseWorkspace(const colmap::mvs::StereoFusionOptions& options,
                  const std::string& workspace_path,
                  const std::string& workspace_format,
                  const std::string& pmvs_option_name,
                  const std::string& input_type,
                  const std::function<bool()>& is_stopped,
                  std::shared_ptr<const FusedCloud>* cloud,
                  Eigen::Vector3d* origin);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_FUSION_RUN_H_
