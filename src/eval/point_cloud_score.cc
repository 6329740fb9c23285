#include "src/eval/point_cloud_score.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nanoflann.hpp>
#include <optional>

#include "src/eval/parallel_for.h"
#include "src/eval/scan_beams.h"

namespace tapa {
namespace {

constexpr size_t kBlockSize = 4096;

// Tolerances in the precision of the points, such that points 0.1 apart are
// within 0.1.
std::vector<double> Squares(const std::vector<double>& tolerances) {
  std::vector<double> squares;
  for (const double tolerance : tolerances) {
    const double rounded = static_cast<float>(tolerance);
    squares.push_back(rounded * rounded);
  }
  return squares;
}

// Index of the first tolerance that a distance is within.
uint8_t FirstWithin(double squared_distance,
                    const std::vector<double>& squared_tolerances) {
  return static_cast<uint8_t>(std::lower_bound(squared_tolerances.begin(),
                                               squared_tolerances.end(),
                                               squared_distance) -
                              squared_tolerances.begin());
}

// What nanoflann asks of a set of points.
struct TreePoints {
  const std::vector<Vec3>& points;

  size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(size_t index, size_t axis) const {
    const Vec3& point = points[index];
    return axis == 0 ? point.x : axis == 1 ? point.y : point.z;
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<
    nanoflann::L2_Simple_Adaptor<double, TreePoints>, TreePoints, 3, uint32_t>;

// Receives points from a search of the tree: keeps the least distance, starts
// with a bound on it, and ends the search at a distance that is good enough.
class Nearest {
 public:
  using DistanceType = double;

  Nearest(double bound, double enough) : least_(bound), enough_(enough) {}

  bool addPoint(double squared_distance, uint32_t) {
    least_ = std::min(least_, squared_distance);
    return least_ > enough_;
  }
  double worstDist() const { return least_; }
  bool full() const { return true; }

 private:
  double least_;
  double enough_;
};

// A point of the reconstruction among the beams of one scan.
Verdict JudgePoint(const Eigen::Vector3d& place, const ScanBeams& beams,
                   double beam_radius,
                   const std::vector<double>& squared_tolerances) {
  double least = std::numeric_limits<double>::infinity();
  bool in_front = false;
  beams.ForEachNear(place, beam_radius, [&](const Vec3& vec) {
    const Eigen::Vector3d end(vec.x, vec.y, vec.z);
    const double along = end.dot(place);
    const double squared_range = end.squaredNorm();
    if (along < 0 || end.cross(place).squaredNorm() >
                         beam_radius * beam_radius * squared_range) {
      return;
    }
    least = std::min(least, (end - place).squaredNorm());
    in_front |= along < squared_range;
  });
  return {FirstWithin(least, squared_tolerances), in_front};
}

// Judges places one after the other and remembers the last one at the scanner
// itself, for which all beams have to be looked at: points that some program
// left at the origin may be many.
class ScanJudge {
 public:
  ScanJudge(const ScanBeams& beams, const BeamShape& shape,
            const std::vector<double>& squared_tolerances)
      : beams_(beams), shape_(shape), squared_tolerances_(squared_tolerances) {}

  Verdict Judge(const Eigen::Vector3d& place) {
    const double radius = shape_.RadiusAt(place.norm());
    if (!ScanBeams::IsAtScanner(place, radius)) {
      return JudgePoint(place, beams_, radius, squared_tolerances_);
    }
    if (!last_place_.has_value() || *last_place_ != place) {
      last_place_ = place;
      last_verdict_ = JudgePoint(place, beams_, radius, squared_tolerances_);
    }
    return last_verdict_;
  }

 private:
  const ScanBeams& beams_;
  const BeamShape& shape_;
  const std::vector<double>& squared_tolerances_;
  std::optional<Eigen::Vector3d> last_place_;
  Verdict last_verdict_;
};

}  // namespace

double BeamShape::RadiusAt(double distance) const {
  constexpr double kDegree = 3.14159265358979323846 / 180;
  return start_radius + distance * std::tan(kDegree * divergence_halfangle);
}

std::vector<Vec3> MergeScans(const std::vector<LaserScan>& scans,
                             ThreadTeam* team) {
  size_t size = 0;
  for (const LaserScan& scan : scans) size += scan.points.size();
  std::vector<Vec3> merged(size);
  size_t begin = 0;
  for (const LaserScan& scan : scans) {
    ParallelFor(scan.points.size(), kBlockSize, team, [&](int, size_t i) {
      merged[begin + i] = scan.pose.ToWorld(scan.points[i]);
    });
    begin += scan.points.size();
  }
  return merged;
}

std::vector<Verdict> JudgeCompleteness(const std::vector<Vec3>& scan_points,
                                       const std::vector<Vec3>& reconstruction,
                                       const std::vector<double>& tolerances,
                                       ThreadTeam* team) {
  const auto none = static_cast<uint8_t>(tolerances.size());
  std::vector<Verdict> verdicts(scan_points.size(), Verdict{none, true});
  if (reconstruction.empty()) return verdicts;

  const std::vector<double> squares = Squares(tolerances);
  // The tree finds what is less than the bound.
  const double bound =
      std::nextafter(squares.back(), std::numeric_limits<double>::infinity());
  const TreePoints tree_points = {reconstruction};
  const Tree tree(3, tree_points,
                  nanoflann::KDTreeSingleIndexAdaptorParams(16));
  ParallelFor(scan_points.size(), kBlockSize, team, [&](int, size_t i) {
    const Vec3& point = scan_points[i];
    const double query[] = {point.x, point.y, point.z};
    Nearest nearest(bound, squares.front());
    tree.findNeighbors(nearest, query, nanoflann::SearchParams());
    verdicts[i].first_good = FirstWithin(nearest.worstDist(), squares);
  });
  return verdicts;
}

std::vector<Verdict> JudgeAccuracy(const std::vector<Vec3>& reconstruction,
                                   const std::vector<LaserScan>& scans,
                                   const std::vector<double>& tolerances,
                                   const BeamShape& beam, ThreadTeam* team) {
  const std::vector<double> squares = Squares(tolerances);
  const auto none = static_cast<uint8_t>(tolerances.size());
  std::vector<Verdict> verdicts(reconstruction.size(), Verdict{none, false});
  for (const LaserScan& scan : scans) {
    const ScanBeams beams(scan.points, team);
    std::vector<ScanJudge> judges(team->size(),
                                  ScanJudge(beams, beam, squares));
    ParallelFor(
        reconstruction.size(), kBlockSize, team, [&](int thread, size_t i) {
          Verdict& verdict = verdicts[i];
          // Good at all tolerances: no other scan can change that.
          if (verdict.first_good == 0) return;
          const Verdict seen =
              judges[thread].Judge(scan.pose.ToScan(reconstruction[i]));
          verdict.first_good = std::min(verdict.first_good, seen.first_good);
          verdict.judged |= seen.judged;
        });
  }
  return verdicts;
}

double F1Score(double completeness, double accuracy) {
  const double sum = completeness + accuracy;
  return sum > 0 ? 2 * completeness * accuracy / sum : 0;
}

}  // namespace tapa
