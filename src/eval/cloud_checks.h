#ifndef TAPA_SRC_EVAL_CLOUD_CHECKS_H_
#define TAPA_SRC_EVAL_CLOUD_CHECKS_H_

#include <string>
#include <vector>

#include "src/base/vec3.h"
#include "src/eval/voxel_average.h"

namespace tapa {

// Signs that a score does not say what it should. Each function returns a
// sentence for the user, "" where there is nothing to say.

// Median distance of the points from the place that has the medians of their
// coordinates, which a few stray points do not change; taken of at most 100000
// points, evenly drawn. 0 for no points.
double TypicalRadius(const std::vector<Vec3>& points);

// Whether a scan looks as if it had another unit than the reconstruction: their
// typical radii differ by a factor of at least 20. Metres and millimetres, or
// inches, differ by more than that.
std::string CheckUnit(const std::vector<Vec3>& reconstruction,
                      const std::vector<Vec3>& scan, const std::string& name);

// Whether coordinates are so large that single precision stores them to no
// better than a tenth of the least tolerance.
std::string CheckPrecision(const std::vector<Vec3>& points,
                           double least_tolerance, const std::string& name);

// Whether at the largest tolerance no point of the scans is complete, or no
// point of the reconstruction is judged: then the two are not in one place.
std::string CheckOverlap(const std::vector<Verdict>& completeness,
                         double largest_tolerance, size_t num_tolerances);
std::string CheckJudged(const std::vector<Verdict>& accuracy,
                        size_t num_tolerances);

}  // namespace tapa

#endif  // TAPA_SRC_EVAL_CLOUD_CHECKS_H_
