#include "src/mvs/tapa/triangle_completion.h"

#include <vector>

#include "src/base/depth.h"
#include "src/mvs/camera_table.h"
#include "src/mvs/tapa/anchor_votes.h"
#include "src/mvs/tapa/completion.h"
#include "src/mvs/tapa/triangle_planes.h"
#include "src/mvs/tapa/view_votes.h"

namespace tapa {
namespace {

// Of what triangles have as corners: deviations of eight grey levels with the
// default options, which edges have and shading has not.
constexpr double kClearTexture = 0.7;
// More for a triangle than for the estimate. Three are those of its own
// corners.
constexpr int kMinNumVotes = 8;
// Times tapa_relative_plane_distance: anchors are further away than what a
// plane was fitted to.
constexpr double kAnchorTolerance = 2;

// The depths of triangles where they may be taken; 0 elsewhere.
Map<float> Candidates(const Options& options, const Problem& problem,
                      const RefCamera& camera, const Map<float>& textureness,
                      const TrianglePlanes& triangles) {
  Map<float> candidates(textureness.width(), textureness.height());
  for (int row = 0; row < candidates.height(); ++row) {
    for (int col = 0; col < candidates.width(); ++col) {
      const size_t pixel = static_cast<size_t>(row) * candidates.width() + col;
      const float depth = triangles.At(camera, row, col).depth;
      if (depth >= problem.depth_min && depth <= problem.depth_max &&
          textureness.data()[pixel] < options.tapa.completion_textureness &&
          !problem.IsMasked(pixel)) {
        candidates.data()[pixel] = depth;
      }
    }
  }
  return candidates;
}

// How many anchors around each triangle lie on its plane.
std::vector<int> CountAnchors(const AnchorVotes& anchors,
                              const TrianglePlanes& triangles) {
  std::vector<int> counts;
  for (const Plane& plane : triangles.planes) {
    counts.push_back(anchors.Count(static_cast<int>(counts.size()), plane));
  }
  return counts;
}

// Of an estimate at a pixel with this ray.
Plane PlaneOf(float depth, const Vec3& normal, const Vec3& ray) {
  return {normal, -depth * Dot(normal, ray)};
}

}  // namespace

void CompleteWithTriangles(const Options& options, const Problem& problem,
                           const Control& control,
                           const Map<float>& textureness,
                           const Map<float>& trusted, Map<float>* depth,
                           Map<Vec3>* normal, Map<uint8_t>* origin) {
  const RefCamera camera = MakeRefCamera(problem.reference.camera);
  const TrianglePlanes triangles = TriangulateAnchors(
      camera, trusted,
      FindAnchors(options.tapa, trusted, textureness, kClearTexture));
  const Map<float> candidates =
      Candidates(options, problem, camera, textureness, triangles);
  const Map<int16_t> votes =
      CountVotes(options, problem, control, candidates, *depth);
  const AnchorVotes anchors(
      triangles, kAnchorTolerance * options.tapa.relative_plane_distance);
  const std::vector<int> own_anchors = CountAnchors(anchors, triangles);
  for (int row = 0; row < depth->height(); ++row) {
    for (int col = 0; col < depth->width(); ++col) {
      if (!IsDepth(candidates.At(row, col))) {
        continue;
      }
      const int triangle = triangles.index.At(row, col);
      const Plane plane = PlaneOf(depth->At(row, col), normal->At(row, col),
                                  camera.Ray(row, col));
      if (votes.At(row, col) + own_anchors[triangle] -
              anchors.Count(triangle, plane) >=
          kMinNumVotes) {
        depth->At(row, col) = candidates.At(row, col);
        normal->At(row, col) = triangles.At(camera, row, col).normal;
        origin->At(row, col) = kFromPlane;
      }
    }
  }
}

}  // namespace tapa
