#include "src/colmap/workspace.h"

#include <filesystem>
#include <system_error>

#include "mvs/workspace.h"
#include "src/base/failure.h"
#include "src/colmap/fatal_errors.h"
#include "util/misc.h"
#include "util/string.h"

namespace tapa {
namespace {

bool IsPmvs(const WorkspaceLocation& location) {
  std::string format = location.format;
  colmap::StringToLower(&format);
  return format == "pmvs";
}

bool HasModel(const std::string& path, const std::string& extension) {
  for (const char* name : {"cameras", "images", "points3D"}) {
    if (!colmap::ExistsFile(colmap::JoinPaths(path, name + extension))) {
      return false;
    }
  }
  return true;
}

void CheckColmapWorkspace(const WorkspaceLocation& location) {
  const std::string sparse_path = colmap::JoinPaths(location.path, "sparse");
  if (!HasModel(sparse_path, ".bin") && !HasModel(sparse_path, ".txt")) {
    throw Failure(
        "There is no sparse model (cameras, images and points3D, "
        ".bin or .txt) in " +
        sparse_path + "; image_undistorter writes one");
  }
  if (!colmap::ExistsDir(colmap::JoinPaths(location.path, "images"))) {
    throw Failure("There is no folder images in " + location.path +
                  "; image_undistorter makes it");
  }
}

void CheckPmvsWorkspace(const WorkspaceLocation& location) {
  if (!colmap::ExistsFile(colmap::JoinPaths(location.path, "bundle.rd.out")) &&
      !colmap::ExistsFile(colmap::JoinPaths(location.path, "vis.dat"))) {
    throw Failure("There is neither bundle.rd.out nor vis.dat in " +
                  location.path + "; is it a PMVS workspace?");
  }
  const std::string option_path =
      colmap::JoinPaths(location.path, location.pmvs_option_name);
  if (!colmap::ExistsFile(option_path)) {
    throw Failure("There is no PMVS option file " + option_path +
                  "; give its name with --pmvs_option_name");
  }
}

}  // namespace

std::string WorkspaceLocation::StereoPath() const {
  return colmap::JoinPaths(
      path, IsPmvs(*this) ? "stereo-" + pmvs_option_name : "stereo");
}

std::string WorkspaceLocation::ConfigPath() const {
  return config_path.empty()
             ? colmap::JoinPaths(StereoPath(), "patch-match.cfg")
             : config_path;
}

std::string WorkspaceLocation::LevelsPath() const {
  return colmap::JoinPaths(StereoPath(), "levels");
}

std::string WorkspaceLocation::LevelPath(Pass pass, int level) const {
  return IsResult(pass, level)
             ? StereoPath()
             : colmap::JoinPaths(LevelsPath(), std::to_string(level));
}

std::string WorkspaceLocation::MapPath(MapKind kind,
                                       const std::string& image_name, Pass pass,
                                       int level) const {
  const char* folder = kind == MapKind::kDepth    ? "depth_maps"
                       : kind == MapKind::kNormal ? "normal_maps"
                                                  : "consistency_graphs";
  return colmap::JoinPaths(LevelPath(pass, level), folder,
                           image_name + "." + PassName(pass) + ".bin");
}

std::string WorkspaceLocation::RecordPath(Pass pass, int level) const {
  return colmap::JoinPaths(LevelPath(pass, level),
                           std::string("options.") + PassName(pass) + ".txt");
}

std::string WorkspaceLocation::ViewsRecordPath(Pass pass, int level) const {
  return colmap::JoinPaths(LevelPath(pass, level),
                           std::string("views.") + PassName(pass) + ".txt");
}

void RemoveLevels(const WorkspaceLocation& location) {
  std::error_code error;
  std::filesystem::remove_all(location.LevelsPath(), error);
  if (error) {
    throw Failure("The maps of coarse levels in " + location.LevelsPath() +
                  " cannot be removed: " + error.message());
  }
}

namespace {

colmap::mvs::Workspace OpenWorkspace(const WorkspaceLocation& location) {
  if (!colmap::ExistsDir(location.path)) {
    throw Failure("There is no workspace folder " + location.path +
                  "; image_undistorter makes one");
  }
  if (IsPmvs(location)) {
    CheckPmvsWorkspace(location);
  } else {
    CheckColmapWorkspace(location);
  }

  const FatalErrors fatal_errors("Cannot read the workspace " + location.path);
  colmap::mvs::Workspace::Options options;
  options.workspace_path = location.path;
  options.workspace_format = location.format;
  options.stereo_folder = colmap::GetPathBaseName(location.StereoPath());
  return colmap::mvs::Workspace(options);
}

}  // namespace

colmap::mvs::Model ReadModel(const WorkspaceLocation& location) {
  return OpenWorkspace(location).GetModel();
}

colmap::mvs::Model ReadWorkspace(const WorkspaceLocation& location) {
  const colmap::mvs::Workspace workspace = OpenWorkspace(location);
  if (IsPmvs(location)) {
    const FatalErrors fatal_errors("Cannot read the workspace " +
                                   location.path);
    colmap::mvs::ImportPMVSWorkspace(workspace, location.pmvs_option_name);
  }
  return workspace.GetModel();
}

}  // namespace tapa
