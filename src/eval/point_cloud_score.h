#ifndef TAPA_SRC_EVAL_POINT_CLOUD_SCORE_H_
#define TAPA_SRC_EVAL_POINT_CLOUD_SCORE_H_

#include <cstddef>
#include <vector>

#include "src/base/parallel.h"
#include "src/base/vec3.h"
#include "src/eval/meshlab_project.h"
#include "src/eval/voxel_average.h"

namespace tapa {

// Agreement of a reconstruction with laser scans as ETH3D defines it (Schoeps
// et al., "A Multi-View Stereo Benchmark with High-Resolution Images and
// Multi-Camera Videos", CVPR 2017). docs/evaluation.md explains it. Points are
// stored in single precision, to which tolerances are rounded, too; distances
// and beams are computed in double precision, and a distance that equals a
// tolerance is within it. No result depends on the number of threads.

struct LaserScan {
  // In the scanner's frame.
  std::vector<Vec3> points;
  ScanPose pose;
};

// The shape of a scanner's beam: a cone that is cut off at the scanner.
struct BeamShape {
  // In metres, at the scanner.
  double start_radius = 0.5 * 0.00225;
  // Angle in degrees between the axis of the cone and its side.
  double divergence_halfangle = 0.011;

  // At a distance from the scanner.
  double RadiusAt(double distance) const;
};

// At most this many tolerances are possible.
constexpr size_t kMaxNumTolerances = 250;

// The points of all scans in the world, one scan after the other.
std::vector<Vec3> MergeScans(const std::vector<LaserScan>& scans,
                             ThreadTeam* team);

// For every point of the scans, all of which are judged: whether a point of the
// reconstruction is within the tolerance. `tolerances` are in rising order.
std::vector<Verdict> JudgeCompleteness(const std::vector<Vec3>& scan_points,
                                       const std::vector<Vec3>& reconstruction,
                                       const std::vector<double>& tolerances,
                                       ThreadTeam* team);

// For every point of the reconstruction: whether it is within the tolerance of
// a point whose beam it is in. If not, it is judged where it is in the part of
// some beam that the scanner found empty, before the beam's point; elsewhere
// nothing is known about it.
std::vector<Verdict> JudgeAccuracy(const std::vector<Vec3>& reconstruction,
                                   const std::vector<LaserScan>& scans,
                                   const std::vector<double>& tolerances,
                                   const BeamShape& beam, ThreadTeam* team);

// Harmonic mean, 0 if both are 0.
double F1Score(double completeness, double accuracy);

}  // namespace tapa

#endif  // TAPA_SRC_EVAL_POINT_CLOUD_SCORE_H_
