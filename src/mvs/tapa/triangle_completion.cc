#include "src/mvs/tapa/triangle_completion.h"

#include <vector>

#include "src/base/depth.h"
#include "src/mvs/camera_table.h"
#include "src/mvs/tapa/anchor_votes.h"
#include "src/mvs/tapa/completion.h"
#include "src/mvs/tapa/similar_mean.h"
#include "src/mvs/tapa/triangle_planes.h"
#include "src/mvs/tapa/view_votes.h"

namespace tapa {
namespace {

// More for a triangle than for the estimate: those of its own corners, which
// lie on it, whatever it is.
constexpr float kMinNumVotes = 3;
// Of views: what more than four see through is free space, whatever lies around
// it.
constexpr int kMinViewVotes = -8;
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

// How many more votes, of views and of anchors, the candidates have than the
// estimates; 0 where there is no candidate.
Map<float> CountLead(const Options& options, const RefCamera& camera,
                     const TrianglePlanes& triangles,
                     const Map<float>& candidates,
                     const Map<int16_t>& view_votes, const Map<float>& depth,
                     const Map<Vec3>& normal) {
  const AnchorVotes anchors(
      triangles, kAnchorTolerance * options.tapa.relative_plane_distance);
  const std::vector<int> own_anchors = CountAnchors(anchors, triangles);
  Map<float> lead(depth.width(), depth.height());
  for (int row = 0; row < depth.height(); ++row) {
    for (int col = 0; col < depth.width(); ++col) {
      if (IsDepth(candidates.At(row, col))) {
        const int triangle = triangles.index.At(row, col);
        const Plane plane = PlaneOf(depth.At(row, col), normal.At(row, col),
                                    camera.Ray(row, col));
        lead.At(row, col) =
            static_cast<float>(view_votes.At(row, col) + own_anchors[triangle] -
                               anchors.Count(triangle, plane));
      }
    }
  }
  return lead;
}

// The same as the mean over similar pixels nearby.
Map<float> MeanLead(const Options& options, const Problem& problem,
                    const Map<float>& candidates, const Map<float>& lead) {
  Map<float> weights(lead.width(), lead.height());
  for (size_t i = 0; i < weights.size(); ++i) {
    weights.data()[i] = IsDepth(candidates.data()[i]) ? 1.0f : 0.0f;
  }
  const int radius =
      static_cast<int>(options.tapa.completion_radius * lead.width());
  return MeanOverSimilarPixels(*problem.reference.image, lead, weights, radius,
                               options.tapa.textureness_variance);
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
  const Map<int16_t> view_votes =
      CountVotes(options, problem, control, candidates, *depth);
  if (control.IsStopped()) {
    return;
  }
  const Map<float> lead = CountLead(options, camera, triangles, candidates,
                                    view_votes, *depth, *normal);
  const Map<float> mean_lead = MeanLead(options, problem, candidates, lead);
  for (int row = 0; row < depth->height(); ++row) {
    for (int col = 0; col < depth->width(); ++col) {
      // A pixel counts as much as all around it.
      const float votes = 0.5f * (lead.At(row, col) + mean_lead.At(row, col));
      if (IsDepth(candidates.At(row, col)) && votes >= kMinNumVotes &&
          view_votes.At(row, col) >= kMinViewVotes) {
        depth->At(row, col) = candidates.At(row, col);
        normal->At(row, col) = triangles.At(camera, row, col).normal;
        origin->At(row, col) = kFromPlane;
      }
    }
  }
}

}  // namespace tapa
