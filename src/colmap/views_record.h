#ifndef TAPA_SRC_COLMAP_VIEWS_RECORD_H_
#define TAPA_SRC_COLMAP_VIEWS_RECORD_H_

#include <map>
#include <string>
#include <vector>

#include "src/colmap/views.h"

namespace tapa {

// Maps do not say which poses, cameras, photographs, masks
// and priors made them. A
// small text file beside them does, one for each pass and a line for each view,
// so that maps are not kept for those of another model.

// What the maps of a view are made from, each as a short text that differs if
// that does.
struct ViewInputs {
  // Pose, intrinsics and size of the view itself.
  std::string camera;
  std::string photo;
  // Names of its source views, their cameras and photographs, in any order.
  std::string sources;
  std::string source_cameras;
  std::string source_photos;
  // Masks and priors of the view and of its sources; empty: there are none.
  std::string masks;
  std::string priors;
};

// What tells the files of a view from others, each by DescribeFile.
struct ViewFiles {
  std::string photo;
  // Empty: there is none.
  std::string mask;
  std::string prior;
};

// By the name of the view.
using ViewsRecord = std::map<std::string, ViewInputs>;

// view: at the size of its photograph, which the maps need not have.
std::string DescribeCamera(const SceneView& view);
// By the content of the file. Throws Failure if it cannot be read.
std::string DescribeFile(const std::string& path);
// views: as above. files: of at least the given ones.
ViewInputs DescribeInputs(const std::vector<SceneView>& views, int reference,
                          const std::vector<int>& sources,
                          const std::map<int, ViewFiles>& files);

// Says what differs, for the user, as in "other poses or cameras"; empty:
// nothing.
std::string DescribeDifference(const ViewInputs& recorded,
                               const ViewInputs& current);

// Reads a record; it is empty if there is none. Throws Failure if it is
// damaged.
ViewsRecord ReadViewsRecord(const std::string& path);

// Writes a record such that it is there only when it is complete. Throws
// Failure if that is impossible.
void WriteViewsRecord(const std::string& path, const ViewsRecord& record);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_VIEWS_RECORD_H_
