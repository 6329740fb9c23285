#include "src/colmap/fusion_input.h"

#include <glog/logging.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "src/base/failure.h"
#include "src/base/map_files.h"
#include "src/colmap/fatal_errors.h"
#include "src/colmap/masks.h"
#include "src/colmap/progress.h"
#include "src/colmap/text_files.h"
#include "src/colmap/views_record.h"
#include "util/misc.h"

namespace tapa {
namespace {

using colmap::ExistsFile;
using colmap::JoinPaths;

class FusionInput {
 public:
  FusionInput(const std::vector<SceneView>& scene,
              const WorkspaceLocation& location, Pass pass)
      : scene_(scene), location_(location), pass_(pass) {}

  std::vector<int> Views(const std::string& mask_path) const {
    std::vector<int> views;
    std::vector<int> others;
    for (const int index : Listed()) {
      (Lacking(index, pass_).empty() ? views : others).push_back(index);
    }
    if (views.empty()) {
      throw Failure(NothingToFuse(others));
    }
    for (const int index : others) {
      ReportLacking(index);
    }
    for (const int index : views) {
      CheckMaps(scene_[index]);
    }
    CheckPoses(views);
    CheckMasks(mask_path, scene_, views);
    return views;
  }

 private:
  // The first file that a view lacks to be fused; empty: none.
  std::string Lacking(int index, Pass pass) const {
    const SceneView& view = scene_[index];
    for (const std::string& path :
         {location_.MapPath(MapKind::kDepth, view.name, pass, 0),
          location_.MapPath(MapKind::kNormal, view.name, pass, 0),
          view.image_path}) {
      if (!ExistsFile(path)) {
        return path;
      }
    }
    return "";
  }

  void ReportLacking(int index) const {
    const SceneView& view = scene_[index];
    const std::string lacking = Lacking(index, pass_);
    if (lacking == view.image_path) {
      PrintWarning("There is no photograph " + lacking + "; " + view.name +
                   " is left out.");
    } else if (ExistsFile(
                   location_.MapPath(MapKind::kDepth, view.name, pass_, 0)) ||
               ExistsFile(
                   location_.MapPath(MapKind::kNormal, view.name, pass_, 0))) {
      throw Failure("There is no map " + lacking +
                    ", but the other one of the view; run patch_match_stereo "
                    "again");
    } else {
      PrintWarning("There are no maps of " + view.name + " (" + lacking +
                   "); it is left out.");
    }
  }

  // Each once.
  std::vector<int> Listed() const {
    const std::string path = JoinPaths(location_.StereoPath(), "fusion.cfg");
    if (!ExistsFile(path)) {
      throw Failure("There is no " + path +
                    ", which lists the images to fuse; image_undistorter "
                    "writes it");
    }
    std::map<std::string, int> by_name;
    for (size_t i = 0; i < scene_.size(); ++i) {
      by_name.emplace(scene_[i].name, static_cast<int>(i));
    }
    std::vector<int> listed;
    std::vector<char> is_listed(scene_.size());
    for (const std::string& name :
         ReadImageNames(path, [&by_name](const std::string& line) {
           return by_name.count(line) > 0;
         })) {
      const auto found = by_name.find(name);
      if (found == by_name.end()) {
        throw Failure(path + " names the image " + name +
                      ", which is not in the sparse model; remove that line");
      }
      if (!is_listed[found->second]) {
        is_listed[found->second] = true;
        listed.push_back(found->second);
      }
    }
    if (listed.empty()) {
      throw Failure(path + " lists no images to fuse");
    }
    return listed;
  }

  std::string NothingToFuse(const std::vector<int>& listed) const {
    const Pass other =
        pass_ == Pass::kGeometric ? Pass::kPhotometric : Pass::kGeometric;
    const bool has_other =
        std::any_of(listed.begin(), listed.end(),
                    [&](int index) { return Lacking(index, other).empty(); });
    return std::string("There are no ") + PassName(pass_) + " maps in " +
           location_.StereoPath() + " of images that fusion.cfg lists; " +
           (has_other
                ? std::string("there are ") + PassName(other) +
                      " ones: fuse them with --input_type " + PassName(other)
                : "patch_match_stereo makes them");
  }

  void CheckMaps(const SceneView& view) const {
    const std::string depth_path =
        location_.MapPath(MapKind::kDepth, view.name, pass_, 0);
    try {
      const auto [width, height] = ReadMapSize(depth_path, MapKind::kDepth);
      CheckMapFile(location_.MapPath(MapKind::kNormal, view.name, pass_, 0),
                   MapKind::kNormal, width, height);
      if (width > view.photo_width || height > view.photo_height ||
          !HaveSameShape(width, height, view.photo_width, view.photo_height)) {
        throw Failure(depth_path + " has " + SizeText(width, height) +
                      " pixels, which is not the shape of its photograph of " +
                      SizeText(view.photo_width, view.photo_height));
      }
    } catch (const Failure& error) {
      throw Failure(std::string(error.what()) +
                    "; remove it and run patch_match_stereo again");
    }
  }

  void CheckPoses(const std::vector<int>& views) const {
    const std::string path = location_.ViewsRecordPath(pass_, 0);
    const ViewsRecord recorded = ReadViewsRecord(path);
    for (const int index : views) {
      const SceneView& view = scene_[index];
      const auto found = recorded.find(view.name);
      if (found != recorded.end() &&
          found->second.camera != DescribeCamera(view)) {
        throw Failure(
            "The maps of " + view.name +
            " were made with another pose or camera than the sparse "
            "model has now; run patch_match_stereo again, or remove " +
            path + " to fuse them all the same");
      }
    }
  }

  const std::vector<SceneView>& scene_;
  const WorkspaceLocation& location_;
  const Pass pass_;
};

}  // namespace

WorkspaceLocation FusionLocation(const std::string& path,
                                 const std::string& format,
                                 const std::string& pmvs_option_name) {
  WorkspaceLocation location;
  location.path = path;
  location.format = format;
  location.pmvs_option_name = pmvs_option_name;
  return location;
}

Pass FusionPass(const std::string& input_type) {
  return input_type == "photometric" ? Pass::kPhotometric : Pass::kGeometric;
}

std::vector<int> ViewsToFuse(const std::vector<SceneView>& views,
                             const WorkspaceLocation& location, Pass pass,
                             const std::string& mask_path) {
  return FusionInput(views, location, pass).Views(mask_path);
}

std::vector<std::string> FusionImages(
    const colmap::mvs::StereoFusionOptions& options, const std::string& path,
    const std::string& format, const std::string& pmvs_option_name,
    const std::string& input_type, std::shared_ptr<const FolderLock>* lock) {
  std::vector<std::string> names;
  try {
    *lock = std::make_shared<FolderLock>(path, FolderLock::Use::kShared);
    const WorkspaceLocation location =
        FusionLocation(path, format, pmvs_option_name);
    const std::vector<SceneView> views =
        SceneViews(ReadModel(location), /* max_image_size */ -1);
    for (const int index : ViewsToFuse(views, location, FusionPass(input_type),
                                       options.mask_path)) {
      names.push_back(views[index].name);
    }
  } catch (const Failure& error) {
    PrintError(error.what());
  }
  return names;
}

void ReportNoPoints(const colmap::mvs::StereoFusionOptions& options) {
  PrintError("No points could be fused. " +
             (options.agreement.enabled
                  ? std::string("A point is what views agree on; with few "
                                "photographs lower "
                                "--StereoFusion.agreement_threshold")
                  : "A point is what at least " +
                        std::to_string(options.min_num_pixels) +
                        " pixels agree on; with few photographs lower "
                        "--StereoFusion.min_num_pixels to their number") +
             ". Masks and a bounding box leave points out, and the last run of "
             "patch_match_stereo has to have left some depth");
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
