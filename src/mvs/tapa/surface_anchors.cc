#include "src/mvs/tapa/surface_anchors.h"

#include "src/base/depth.h"
#include "src/mvs/camera_table.h"
#include "src/mvs/sweep/geometric_cost.h"
#include "src/mvs/tapa/nearest_pixel.h"

namespace tapa {
namespace {

// Adds those of source view m that the reference view sees.
void AddSourceAnchors(const Options& options, const Problem& problem,
                      const RefCamera& camera, const SourceCameras& views,
                      int m, const Map<float>& depth,
                      std::vector<SurfaceAnchor>* anchors) {
  const View& view = problem.sources[m];
  const float nearest_share =
      static_cast<float>(1 - options.tapa.relative_plane_distance);
  for (const Anchor& anchor : FindAnchors(options.tapa, view, kClearTexture)) {
    const Vec3 p = TransferPoint(views.B, views.g, m, anchor.col, anchor.row,
                                 view.depth->At(anchor.row, anchor.col));
    const Projection place = {p.x / p.z, p.y / p.z};
    Anchor pixel;
    if (!(p.z > 0) || !FindNearestPixel(place, depth.width(), depth.height(),
                                        &pixel.row, &pixel.col)) {
      continue;
    }
    const size_t index =
        static_cast<size_t>(pixel.row) * depth.width() + pixel.col;
    const float own = depth.data()[index];
    const bool is_hidden = IsDepth(own) && own < nearest_share * p.z;
    if (!problem.IsMasked(index) && !is_hidden) {
      anchors->push_back({pixel, p.z * camera.Ray(place.row, place.col)});
    }
  }
}

}  // namespace

std::vector<SurfaceAnchor> FindSurfaceAnchors(const Options& options,
                                              const Problem& problem,
                                              const Control& control,
                                              const RefCamera& camera,
                                              const Map<float>& depth,
                                              const Map<float>& textureness) {
  std::vector<SurfaceAnchor> anchors;
  for (const Anchor& anchor :
       FindAnchors(options.tapa, depth, textureness, kClearTexture)) {
    anchors.push_back({anchor, depth.At(anchor.row, anchor.col) *
                                   camera.Ray(anchor.row, anchor.col)});
  }
  const CameraTable table(problem);
  for (size_t m = 0; m < problem.sources.size(); ++m) {
    if (options.geom_consistency && problem.sources[m].depth != nullptr &&
        !control.IsStopped()) {
      AddSourceAnchors(options, problem, camera, table.sources(),
                       static_cast<int>(m), depth, &anchors);
    }
  }
  return anchors;
}

}  // namespace tapa
