#include "src/mvs/tapa/view_votes.h"

#include <cmath>

#include "src/base/depth.h"
#include "src/mvs/camera_table.h"
#include "src/mvs/sweep/geometric_cost.h"
#include "src/mvs/tapa/nearest_pixel.h"
#include "src/mvs/tapa/triangle_planes.h"

namespace tapa {
namespace {

// A view that sees through a point counts twice, as in fusion.
constexpr int kAgainst = -2;

// What a source view sees: its estimates, and triangles between the textured
// ones.
class Voter {
 public:
  Voter(const Options& options, const View& view, const SourceCameras& views,
        int m)
      : depth_(*view.depth),
        camera_(MakeRefCamera(view.camera)),
        views_(views),
        m_(m),
        tolerance_(static_cast<float>(options.tapa.relative_plane_distance)) {
    triangles_ = TriangulateAnchors(
        camera_, depth_,
        FindAnchors(options.tapa, view, options.tapa.completion_textureness));
  }

  // Of this view for the point at a depth of a reference pixel.
  int Vote(int row, int col, float depth) const {
    if (!IsDepth(depth)) {
      return 0;
    }
    const Vec3 p = TransferPoint(views_.A, views_.b, m_, col, row, depth);
    int own_row, own_col;
    if (!(p.z > 0) || !FindNearestPixel({p.x / p.z, p.y / p.z}, depth_.width(),
                                        depth_.height(), &own_row, &own_col)) {
      return 0;
    }
    const float estimate = depth_.At(own_row, own_col) / p.z - 1;
    const float triangle =
        triangles_.At(camera_, own_row, own_col).depth / p.z - 1;
    if (std::abs(estimate) <= tolerance_ || std::abs(triangle) <= tolerance_) {
      return 1;
    }
    return estimate > tolerance_ && triangle > tolerance_ ? kAgainst : 0;
  }

 private:
  const Map<float>& depth_;
  const RefCamera camera_;
  const SourceCameras& views_;
  const int m_;
  const float tolerance_;
  TrianglePlanes triangles_;
};

}  // namespace

Map<int16_t> CountVotes(const Options& options, const Problem& problem,
                        const Control& control, const Map<float>& depth,
                        const Map<float>& other) {
  const CameraTable table(problem);
  const SourceCameras views = table.sources();
  Map<int16_t> votes(depth.width(), depth.height());
  for (int m = 0; m < views.count && !control.IsStopped(); ++m) {
    const Voter voter(options, problem.sources[m], views, m);
    for (int row = 0; row < depth.height() && !control.IsStopped(); ++row) {
      for (int col = 0; col < depth.width(); ++col) {
        if (IsDepth(depth.At(row, col))) {
          votes.At(row, col) += voter.Vote(row, col, depth.At(row, col)) -
                                voter.Vote(row, col, other.At(row, col));
        }
      }
    }
  }
  return votes;
}

}  // namespace tapa
