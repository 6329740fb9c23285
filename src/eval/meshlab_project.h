#ifndef TAPA_SRC_EVAL_MESHLAB_PROJECT_H_
#define TAPA_SRC_EVAL_MESHLAB_PROJECT_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "src/base/vec3.h"

namespace tapa {

// Where a scanner stood: X_world = rotation * X_scan + translation. The scanner
// is at the origin of its scan.
struct ScanPose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  // Rounded to single precision.
  Vec3 ToWorld(const Vec3& point) const;
  Eigen::Vector3d ToScan(const Vec3& point) const;
};

struct ScanFile {
  // Of a PLY file. Relative names in a project count from the project's folder.
  std::string path;
  ScanPose pose;
};

// Reads the scans that a MeshLab project (.mlp) lists, in its order. Throws
// std::runtime_error, with the path in the message, if the file cannot be read,
// is no such project, lists no scan, or has a scan without a file name or with
// a matrix that is no rotation (to 1e-4) and translation.
std::vector<ScanFile> ReadMeshLabProject(const std::string& path);

}  // namespace tapa

#endif  // TAPA_SRC_EVAL_MESHLAB_PROJECT_H_
