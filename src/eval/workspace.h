#ifndef TAPA_SRC_EVAL_WORKSPACE_H_
#define TAPA_SRC_EVAL_WORKSPACE_H_

#include <string>
#include <vector>

namespace tapa {

// What belongs to one view of a COLMAP workspace. Only the depth map is known
// to exist.
struct WorkspaceView {
  // Name of the photograph relative to the folder of images.
  std::string name;
  std::string image_path;
  std::string depth_path;
  std::string normal_path;
};

// Views with a depth map of the given type ("geometric" or "photometric"),
// sorted by name. Throws std::runtime_error if the workspace or its folder of
// depth maps is missing, or holds no such map.
std::vector<WorkspaceView> ListWorkspace(const std::string& workspace_path,
                                         const std::string& input_type);

// Path of a photograph's ground truth in a folder, "" if there is none: the
// photograph's name with the extension .png or .bin, with the photograph's own
// sub-folder or without.
std::string FindGroundTruth(const std::string& folder, const std::string& name);

// Number of files in a folder that may be ground truth. Throws
// std::runtime_error if the folder is missing.
int CountGroundTruth(const std::string& folder);

}  // namespace tapa

#endif  // TAPA_SRC_EVAL_WORKSPACE_H_
