#include "src/colmap/fusion_input.h"

#include <glog/logging.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "src/base/failure.h"
#include "src/base/map_files.h"
#include "src/colmap/fatal_errors.h"
#include "src/colmap/pass.h"
#include "src/colmap/progress.h"
#include "src/colmap/text_files.h"
#include "src/colmap/views.h"
#include "src/colmap/views_record.h"
#include "src/colmap/workspace.h"
#include "util/misc.h"

namespace tapa {
namespace {

using colmap::ExistsFile;
using colmap::JoinPaths;

class FusionInput {
 public:
  FusionInput(const WorkspaceLocation& location, Pass pass)
      : location_(location), pass_(pass) {}

  std::vector<std::string> Names(const std::string& mask_path) const {
    const std::vector<SceneView> views =
        SceneViews(ReadModel(location_), /* max_image_size */ -1);
    const std::vector<SceneView> listed = Listed(views);
    CheckMaps(listed);
    CheckPoses(listed);
    std::vector<std::string> names;
    for (const SceneView& view : listed) {
      names.push_back(view.name);
    }
    CheckMasks(mask_path, names);
    return names;
  }

 private:
  bool HasMaps(const SceneView& view, Pass pass) const {
    return ExistsFile(location_.MapPath(MapKind::kDepth, view.name, pass, 0)) &&
           ExistsFile(location_.MapPath(MapKind::kNormal, view.name, pass, 0));
  }

  std::vector<SceneView> Listed(const std::vector<SceneView>& views) const {
    const std::string path = JoinPaths(location_.StereoPath(), "fusion.cfg");
    if (!ExistsFile(path)) {
      throw Failure("There is no " + path +
                    ", which lists the images to fuse; image_undistorter "
                    "writes it");
    }
    std::map<std::string, const SceneView*> by_name;
    for (const SceneView& view : views) {
      by_name.emplace(view.name, &view);
    }
    std::vector<SceneView> listed;
    for (const std::string& name :
         ReadImageNames(path, [&by_name](const std::string& line) {
           return by_name.count(line) > 0;
         })) {
      const auto found = by_name.find(name);
      if (found == by_name.end()) {
        throw Failure(path + " names the image " + name +
                      ", which is not in the sparse model; remove that line");
      }
      listed.push_back(*found->second);
    }
    if (listed.empty()) {
      throw Failure(path + " lists no images to fuse");
    }
    return listed;
  }

  void CheckMaps(const std::vector<SceneView>& views) const {
    const auto count = [&](Pass pass) {
      return std::count_if(views.begin(), views.end(), [&](const auto& view) {
        return HasMaps(view, pass) && ExistsFile(view.image_path);
      });
    };
    if (count(pass_) == 0) {
      const Pass other =
          pass_ == Pass::kGeometric ? Pass::kPhotometric : Pass::kGeometric;
      throw Failure(
          std::string("There are no ") + PassName(pass_) + " maps in " +
          location_.StereoPath() + " of images that fusion.cfg lists; " +
          (count(other) > 0
               ? std::string("there are ") + PassName(other) +
                     " ones: fuse them with --input_type " + PassName(other)
               : "patch_match_stereo makes them"));
    }
    for (const SceneView& view : views) {
      if (HasMaps(view, pass_)) {
        for (const MapKind kind : {MapKind::kDepth, MapKind::kNormal}) {
          CheckMap(kind, view);
        }
      }
    }
  }

  void CheckMap(MapKind kind, const SceneView& view) const {
    try {
      CheckMapFile(location_.MapPath(kind, view.name, pass_, 0), kind);
    } catch (const Failure& error) {
      throw Failure(std::string(error.what()) +
                    "; remove it and run patch_match_stereo again");
    }
  }

  void CheckPoses(const std::vector<SceneView>& views) const {
    const std::string path = location_.ViewsRecordPath(pass_, 0);
    const ViewsRecord recorded = ReadViewsRecord(path);
    for (const SceneView& view : views) {
      const auto found = recorded.find(view.name);
      if (found != recorded.end() && HasMaps(view, pass_) &&
          found->second.camera != DescribeCamera(view)) {
        throw Failure(
            "The maps of " + view.name +
            " were made with another pose or camera than the sparse "
            "model has now; run patch_match_stereo again, or remove " +
            path + " to fuse them all the same");
      }
    }
  }

  void CheckMasks(const std::string& mask_path,
                  const std::vector<std::string>& names) const {
    if (mask_path.empty()) {
      return;
    }
    std::vector<std::string> missing;
    for (const std::string& name : names) {
      if (!ExistsFile(JoinPaths(mask_path, name + ".png"))) {
        missing.push_back(name + ".png");
      }
    }
    if (missing.size() == names.size()) {
      throw Failure("There are no masks in " + mask_path +
                    "; they have the names of the images with .png after them, "
                    "as in " +
                    missing[0]);
    }
    if (!missing.empty()) {
      PrintWarning(std::to_string(missing.size()) + " of " +
                   std::to_string(names.size()) +
                   " images have no mask and are fused as a whole; such as " +
                   missing[0] + " is not in " + mask_path);
    }
  }

  const WorkspaceLocation location_;
  const Pass pass_;
};

}  // namespace

std::vector<std::string> FusionImages(
    const colmap::mvs::StereoFusionOptions& options, const std::string& path,
    const std::string& format, const std::string& pmvs_option_name,
    const std::string& input_type) {
  WorkspaceLocation location;
  location.path = path;
  location.format = format;
  location.pmvs_option_name = pmvs_option_name;
  const Pass pass =
      input_type == "photometric" ? Pass::kPhotometric : Pass::kGeometric;
  try {
    return FusionInput(location, pass).Names(options.mask_path);
  } catch (const Failure& error) {
    PrintError(error.what());
    return {};
  }
}

void ReportNoPoints(const colmap::mvs::StereoFusionOptions& options) {
  PrintError(
      "No points could be fused. A point is what at least " +
      std::to_string(options.min_num_pixels) +
      " pixels agree on; with few photographs lower "
      "--StereoFusion.min_num_pixels to their number. Masks and a bounding box "
      "leave points out, and the last run of patch_match_stereo has to have "
      "left some depth");
}

void ReadFusionPhoto(const colmap::mvs::Image& image, bool is_scaled,
                     colmap::Bitmap* bitmap) {
  try {
    *bitmap = is_scaled ? ReadBitmap(image.GetPath(), /* in_color */ true)
                        : ReadBitmap(image.GetPath(), /* in_color */ true,
                                     static_cast<int>(image.GetWidth()),
                                     static_cast<int>(image.GetHeight()));
  } catch (const Failure& error) {
    // A thread that throws would not end fusion.
    LOG(FATAL) << error.what();
  }
}

std::pair<Eigen::Vector3f, Eigen::Vector3f> ReadBoundingBox(
    const std::string& path, const Eigen::Vector3d& origin) {
  std::istringstream numbers(ReadWholeFile(path));
  Eigen::Vector3d min;
  Eigen::Vector3d max;
  for (Eigen::Vector3d* corner : {&min, &max}) {
    numbers >> (*corner)(0) >> (*corner)(1) >> (*corner)(2);
  }
  if (!numbers || (min.array() > max.array()).any()) {
    throw Failure(
        path +
        " has no bounding box, which are six numbers: the smallest x, "
        "y and z, then the largest ones");
  }
  return {(min - origin).cast<float>(), (max - origin).cast<float>()};
}

}  // namespace tapa
