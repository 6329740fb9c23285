#ifndef TAPA_SRC_MVS_TAPA_JURY_H_
#define TAPA_SRC_MVS_TAPA_JURY_H_

#include <limits>
#include <vector>

#include "src/base/map.h"
#include "src/base/progress.h"
#include "src/mvs/camera_table.h"
#include "src/mvs/options.h"
#include "src/mvs/problem.h"
#include "src/mvs/sweep/depth_normal.h"

namespace tapa {

// The source views of a problem that have a depth map, as judges of what the
// reference view sees (consensus.h). Pixels are the reference view's, depths
// are in scene units.
class Jury {
 public:
  // The problem, of which cameras and depth maps of the views are looked at,
  // must outlive the object.
  Jury(const Options& options, const Problem& problem);
  Jury(const Jury&) = delete;
  Jury& operator=(const Jury&) = delete;

  int size() const { return static_cast<int>(members_.size()); }

  // Votes for a surface at a depth of a pixel, less those against it. With e =
  // relative_plane_distance a member has one for what it sees there itself, to
  // e, and one against what it sees through: where its own surface is further
  // away by more than 2 e, as two estimates of one surface may each be wrong by
  // e. Against counts twice where the question is which of two surfaces it is
  // (view_votes.h); here it takes an estimate away. What cannot have a lead of
  // `least` any more is not asked to the end: it has less.
  int Lead(int row, int col, float depth,
           int least = std::numeric_limits<int>::min()) const;

  // The depth of a member's nearest surface at every pixel that it has a point
  // in; `surface`, of the reference view's size, is 0 elsewhere.
  void Project(int member, const ContinueCheck& should_continue,
               Map<float>* surface) const;

  // The plane of the surface that a member has at a depth of a pixel, on the
  // pixel's ray: the point that it has there is up to a pixel beside it.
  DepthNormal PlaneOf(int member, int row, int col, float depth) const;

 private:
  struct Member {
    // Its number among the source views.
    int m;
    const Map<float>* depth;
    RefCamera camera;
  };

  bool FindPixel(const Member& member, int row, int col, float depth, float* z,
                 int* own_row, int* own_col) const;
  int Vote(const Member& member, int row, int col, float depth) const;
  Vec3 PointOn(const Member& member, const DepthNormal& plane, int row, int col,
               int down, int right) const;

  const CameraTable table_;
  const SourceCameras views_;
  const RefCamera reference_;
  const float tolerance_;
  std::vector<Member> members_;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_JURY_H_
