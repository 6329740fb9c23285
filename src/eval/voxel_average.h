#ifndef TAPA_SRC_EVAL_VOXEL_AVERAGE_H_
#define TAPA_SRC_EVAL_VOXEL_AVERAGE_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/base/parallel.h"
#include "src/base/vec3.h"

namespace tapa {

// What became of a point at all tolerances, which are numbered in rising order.
// What is good at one is good at all that follow.
struct Verdict {
  // The first tolerance at which the point is good; the number of tolerances if
  // there is none.
  uint8_t first_good = 0;
  // Whether it is bad at the tolerances before. Otherwise it cannot be judged
  // there and does not count.
  bool judged = false;

  bool GoodAt(size_t tolerance) const { return tolerance >= first_good; }
  bool BadAt(size_t tolerance) const { return judged && !GoodAt(tolerance); }
};

// Share of good points among those that are judged, for each tolerance: the
// mean over all cubes of edge `voxel_size` that hold judged points, such that
// the density of points has no weight. There are two grids of cubes, one
// shifted by half an edge along all three axes, and the mean is taken over the
// cubes of both. 0 where nothing is judged.
//
// Which cube a point is in is computed in single precision, so that points at
// multiples of the edge fall where one expects them; cubes further than 2e9
// edges from the origin are one. The result does not depend on the number of
// threads.
std::vector<double> AverageOverVoxels(const std::vector<Vec3>& points,
                                      const std::vector<Verdict>& verdicts,
                                      size_t num_tolerances, double voxel_size,
                                      ThreadTeam* team);

}  // namespace tapa

#endif  // TAPA_SRC_EVAL_VOXEL_AVERAGE_H_
