#ifndef TAPA_SRC_COLMAP_FUSION_SOURCE_H_
#define TAPA_SRC_COLMAP_FUSION_SOURCE_H_

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "mvs/fusion.h"
#include "src/colmap/pass.h"
#include "src/colmap/view_cache.h"
#include "src/colmap/views.h"
#include "src/colmap/workspace.h"
#include "src/fusion/fuse.h"

namespace tapa {

// The views of a workspace to fuse.
class FusionSource {
 public:
  // Throws Failure as ViewsToFuse does.
  FusionSource(const colmap::mvs::StereoFusionOptions& options,
               const WorkspaceLocation& location, Pass pass);

  // What its maps may take of the memory, and the points made of them.
  static size_t CacheBytes(const colmap::mvs::StereoFusionOptions& options);
  static size_t PointBytes(const colmap::mvs::StereoFusionOptions& options) {
    return CacheBytes(options) / 4;
  }

  // It reads maps when they are needed, from this object. What is wrong with
  // them throws Failure there.
  FusionProblem Problem();

  // What the problem is relative to (LocalOrigin).
  const Eigen::Vector3d& Origin() const { return origin_; }
  // Index in the model and name of a view of the problem.
  int ModelIndex(int view) const { return model_indices_[view]; }
  const std::string& Name(int view) const { return views_[view].name; }
  // How many of the maps that were asked for were in memory already, as a line.
  std::string DescribeCacheUse() const {
    return "Found in the cache: " + surfaces_->Use().Describe("maps");
  }

 private:
  // Gives a view the size of its maps, or of max_image_size.
  void FitToMaps(SceneView* view) const;
  std::vector<std::vector<int>> Neighbors(
      const colmap::mvs::Model& model) const;
  SurfaceMap ReadSurface(int view) const;

  const colmap::mvs::StereoFusionOptions& options_;
  const WorkspaceLocation location_;
  const Pass pass_;
  Eigen::Vector3d origin_;
  std::vector<SceneView> views_;
  std::vector<int> model_indices_;
  std::vector<std::vector<int>> neighbors_;
  std::unique_ptr<ViewCache<SurfacePixel>> surfaces_;
};

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_FUSION_SOURCE_H_
