#ifndef TAPA_SRC_FUSION_FUSE_H_
#define TAPA_SRC_FUSION_FUSE_H_

#include <functional>
#include <memory>
#include <vector>

#include "src/base/map.h"
#include "src/base/progress.h"
#include "src/fusion/fused_cloud.h"
#include "src/fusion/options.h"
#include "src/fusion/surface_map.h"
#include "src/mvs/view.h"

namespace tapa {

struct FusionView {
  // At the size of the view's maps.
  Camera camera;
  int width = 0;
  int height = 0;
  // The views that are asked about its pixels, at most 64, those that see most
  // of the same first; never itself.
  std::vector<int> neighbors;
};

// What a fusion works on. The functions are called from one thread at a time.
struct FusionProblem {
  std::vector<FusionView> views;
  // The maps of a view, of its size. What they throw ends the fusion.
  std::function<std::shared_ptr<const SurfaceMap>(int)> read_surface;
  std::function<Map<Rgb>(int)> read_colors;
  // Whether a point of the world is wanted; empty: all are.
  std::function<bool(const Vec3&)> is_wanted;
};

struct FusionControl {
  // -1: one per core. The result does not depend on it.
  int num_threads = -1;
  // Share of the work that is done; ends the fusion by returning false.
  ProgressCallback progress;
  // After a view, with its points; may be empty.
  std::function<void(const FusedView&)> view_done;
};

// Fuses the depth maps of all views to points, as docs/design.md describes.
// Returns whether it came to its end; if not, the cloud is incomplete. Throws
// std::invalid_argument if an option is not valid, and what the problem's
// functions throw.
bool Fuse(const FusionOptions& options, const FusionProblem& problem,
          const FusionControl& control, FusedCloud* cloud);

}  // namespace tapa

#endif  // TAPA_SRC_FUSION_FUSE_H_
