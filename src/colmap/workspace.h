#ifndef TAPA_SRC_COLMAP_WORKSPACE_H_
#define TAPA_SRC_COLMAP_WORKSPACE_H_

#include <string>

#include "mvs/model.h"
#include "src/base/map_files.h"
#include "src/colmap/pass.h"

namespace tapa {

// Where a dense workspace is and what kind it is.
struct WorkspaceLocation {
  std::string path;
  // "COLMAP" or "PMVS", in any case.
  std::string format = "COLMAP";
  // With PMVS: name of the option file.
  std::string pmvs_option_name = "option-all";
  // The list of views; empty: patch-match.cfg in the stereo folder.
  std::string config_path;

  // Folder of the maps.
  std::string StereoPath() const;
  std::string ConfigPath() const;

  std::string MapPath(MapKind kind, const std::string& image_name, Pass pass,
                      int level) const;
  // Record of the options that made the maps of a pass (options_record.h).
  std::string RecordPath(Pass pass, int level) const;
  // Record of what the maps of a pass were made from (views_record.h).
  std::string ViewsRecordPath(Pass pass, int level) const;
  // Folder of drafts and of the maps of all levels but level 0
  // (src/mvs/levels.h), which a run removes at its end.
  std::string LevelsPath() const;

 private:
  std::string LevelPath(Pass pass, int level) const;
};

// Removes the folder of coarse levels and drafts, if there is one. Throws
// Failure.
void RemoveLevels(const WorkspaceLocation& location);

// Reads the sparse model. Throws Failure if parts of the workspace are missing
// or damaged; ends the program with one line for what COLMAP itself finds
// wrong.
colmap::mvs::Model ReadModel(const WorkspaceLocation& location);

// The same, and makes the stereo folder of a PMVS workspace.
colmap::mvs::Model ReadWorkspace(const WorkspaceLocation& location);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_WORKSPACE_H_
