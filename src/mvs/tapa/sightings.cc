#include "src/mvs/tapa/sightings.h"

#include <algorithm>
#include <cmath>

#include "src/base/angle.h"
#include "src/base/depth.h"
#include "src/mvs/camera_table.h"
#include "src/mvs/sweep/geometric_cost.h"
#include "src/mvs/sweep/view_prior.h"
#include "src/mvs/tapa/nearest_pixel.h"

namespace tapa {
namespace {

// The problem as source view m would have it: that view as the reference, and
// the reference as source 0, before the other sources.
Problem SeenFrom(const Problem& problem, size_t m, const Map<float>& swept) {
  Problem result;
  result.reference = problem.sources[m];
  result.sources.push_back(problem.reference);
  result.sources[0].depth = &swept;
  for (size_t k = 0; k < problem.sources.size(); ++k) {
    if (k != m) {
      result.sources.push_back(problem.sources[k]);
    }
  }
  return result;
}

// A source view whose estimates are put to the test: the reference of a problem
// as SeenFrom makes it.
class Witness {
 public:
  Witness(const Options& options, const Problem& problem)
      : problem_(problem),
        table_(problem),
        views_(table_.sources()),
        max_error_(
            static_cast<float>(options.filter_geom_consistency_max_cost)),
        cos_min_triangulation_(static_cast<float>(
            std::cos(DegToRad(options.filter_min_triangulation_angle)))) {}

  // Adds what this view sees in row `row` of its depth map to `sightings`.
  void Add(int row, int min_num_views, const Map<float>& known,
           Map<float>* sightings) const {
    const Map<float>& depths = *problem_.reference.depth;
    for (int col = 0; col < depths.width(); ++col) {
      const float depth = depths.At(row, col);
      int ref_row, ref_col;
      if (!IsDepth(depth) ||
          !FindNearestPixel(ProjectToSource(views_, 0, row, col, depth),
                            known.width(), known.height(), &ref_row,
                            &ref_col) ||
          IsDepth(known.At(ref_row, ref_col))) {
        continue;
      }
      const float ref_depth =
          TransferPoint(views_.A, views_.b, 0, col, row, depth).z;
      float& nearest = sightings->At(ref_row, ref_col);
      if ((!IsDepth(nearest) || ref_depth < nearest) &&
          IsConsistent(row, col, depth, min_num_views)) {
        nearest = ref_depth;
      }
    }
  }

 private:
  bool IsConsistent(int row, int col, float depth, int min_num_views) const {
    int num_views = 0;
    for (int m = 0; m < views_.count; ++m) {
      num_views += Agrees(m, row, col, depth) ? 1 : 0;
      if (num_views >= min_num_views) {
        return true;
      }
    }
    return num_views >= min_num_views;
  }

  // The filter's conditions but that on normals, which source views do not
  // have.
  bool Agrees(int m, int row, int col, float depth) const {
    const Projection seen = ProjectToSource(views_, m, row, col, depth);
    const Map<float>& other = *problem_.sources[m].depth;
    int other_row, other_col;
    if (!FindNearestPixel(seen, other.width(), other.height(), &other_row,
                          &other_col)) {
      return false;
    }
    const float other_depth = other.At(other_row, other_col);
    const Vec3 point = depth * table_.reference().Ray(row, col);
    return ReprojectionError(views_, m, row, col, seen, other_depth,
                             max_error_ + 1) <= max_error_ &&
           ComputeViewingAngles(views_, m, point, Vec3()).cos_triangulation <=
               cos_min_triangulation_;
  }

  const Problem& problem_;
  const CameraTable table_;
  const SourceCameras views_;
  const float max_error_;
  const float cos_min_triangulation_;
};

}  // namespace

Map<float> FindSightings(const Options& options, const Problem& problem,
                         const Control& control, const Map<float>& swept,
                         const Map<float>& known) {
  const int min_num_views = std::min(options.filter_min_num_consistent,
                                     static_cast<int>(problem.sources.size()));
  Map<float> sightings(known.width(), known.height(), 0);
  for (size_t m = 0; m < problem.sources.size(); ++m) {
    const Problem seen = SeenFrom(problem, m, swept);
    const Witness witness(options, seen);
    const int height = problem.sources[m].depth->height();
    for (int row = 0; row < height && !control.IsStopped(); ++row) {
      witness.Add(row, min_num_views, known, &sightings);
    }
  }
  for (size_t i = 0; i < problem.mask.size(); ++i) {
    if (problem.IsMasked(i)) {
      sightings.data()[i] = 0;
    }
  }
  return sightings;
}

}  // namespace tapa
