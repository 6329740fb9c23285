#include "src/mvs/tapa/triangle_completion.h"

#include <algorithm>

#include "src/mvs/camera_table.h"
#include "src/mvs/tapa/completion.h"
#include "src/mvs/tapa/triangle_planes.h"
#include "src/mvs/tapa/view_votes.h"

namespace tapa {
namespace {

// Of what triangles have as corners: deviations of eight grey levels with the
// default options, which edges have and shading has not.
constexpr double kClearTexture = 0.7;

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

// One view more than makes an estimate trusted.
int MinNumVotes(const Options& options, const Problem& problem) {
  return 1 + std::min(options.filter_min_num_consistent,
                      static_cast<int>(problem.sources.size()));
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
  const int min_num_votes = MinNumVotes(options, problem);
  for (int row = 0; row < depth->height(); ++row) {
    for (int col = 0; col < depth->width(); ++col) {
      if (votes.At(row, col) >= min_num_votes) {
        depth->At(row, col) = candidates.At(row, col);
        normal->At(row, col) = triangles.At(camera, row, col).normal;
        origin->At(row, col) = kFromPlane;
      }
    }
  }
}

}  // namespace tapa
