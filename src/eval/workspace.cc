#include "src/eval/workspace.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace tapa {
namespace {

namespace fs = std::filesystem;

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() > end.size() &&
         text.compare(text.size() - end.size(), end.size(), end) == 0;
}

void CheckFolder(const fs::path& path, const std::string& what) {
  if (!fs::is_directory(path)) {
    throw std::runtime_error("no " + what + " at " + path.string());
  }
}

}  // namespace

std::vector<WorkspaceView> ListWorkspace(const std::string& workspace_path,
                                         const std::string& input_type) {
  const fs::path workspace = workspace_path;
  const fs::path depth_maps = workspace / "stereo" / "depth_maps";
  CheckFolder(workspace, "workspace");
  CheckFolder(depth_maps, "folder of depth maps");

  const std::string end = "." + input_type + ".bin";
  std::vector<WorkspaceView> views;
  for (const fs::directory_entry& entry :
       fs::recursive_directory_iterator(depth_maps)) {
    if (!entry.is_regular_file()) continue;
    const std::string file =
        entry.path().lexically_relative(depth_maps).generic_string();
    if (!EndsWith(file, end)) continue;
    WorkspaceView view;
    view.name = file.substr(0, file.size() - end.size());
    view.image_path = (workspace / "images" / view.name).string();
    view.depth_path = entry.path().string();
    view.normal_path = (workspace / "stereo" / "normal_maps" / file).string();
    views.push_back(std::move(view));
  }
  if (views.empty()) {
    throw std::runtime_error("no " + input_type + " depth map in " +
                             depth_maps.string());
  }
  std::sort(views.begin(), views.end(),
            [](const WorkspaceView& a, const WorkspaceView& b) {
              return a.name < b.name;
            });
  return views;
}

std::string FindGroundTruth(const std::string& folder,
                            const std::string& name) {
  const fs::path relative = name;
  for (fs::path candidate : {relative, relative.filename()}) {
    for (const char* extension : {".png", ".bin"}) {
      const fs::path path = folder / candidate.replace_extension(extension);
      if (fs::is_regular_file(path)) return path.string();
    }
  }
  return "";
}

int CountGroundTruth(const std::string& folder) {
  CheckFolder(folder, "folder of ground truth");
  int count = 0;
  for (const fs::directory_entry& entry :
       fs::recursive_directory_iterator(folder)) {
    const fs::path extension = entry.path().extension();
    count += extension == ".png" || extension == ".bin";
  }
  return count;
}

}  // namespace tapa
