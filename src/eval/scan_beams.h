#ifndef TAPA_SRC_EVAL_SCAN_BEAMS_H_
#define TAPA_SRC_EVAL_SCAN_BEAMS_H_

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/base/parallel.h"
#include "src/base/vec3.h"

namespace tapa {

// The beams of one laser scan: rays from the scanner, which is at the origin,
// through the points that it measured. They are kept by direction, in a grid
// over azimuth and inclination, so that those close to a place are found fast.
class ScanBeams {
 public:
  // Points of the scan in its own frame, finite and fewer than 2^32. A point at
  // the scanner itself has no beam and is left out.
  ScanBeams(const std::vector<Vec3>& points, ThreadTeam* team);

  // Calls visit(end) with the measured point of every beam, and maybe of others
  // close by, that passes `place` at no more than `distance`.
  template <typename Visit>
  void ForEachNear(const Eigen::Vector3d& place, double distance,
                   const Visit& visit) const {
    const Range rows = Rows(place, distance);
    const Range columns = Columns(place, distance);
    for (int64_t row = rows.begin; row < rows.end; ++row) {
      // Azimuths go round.
      VisitCells(row, std::max<int64_t>(0, columns.begin),
                 std::min(num_columns_, columns.end), visit);
      VisitCells(row, columns.begin + num_columns_, num_columns_, visit);
      VisitCells(row, 0, columns.end - num_columns_, visit);
    }
  }

  // Whether every beam is close to a place so near to the scanner.
  static bool IsAtScanner(const Eigen::Vector3d& place, double distance) {
    return place.squaredNorm() <= distance * distance;
  }

 private:
  struct Range {
    int64_t begin;
    int64_t end;
  };

  // Without a bound; columns begin at azimuth -pi.
  int64_t RowOf(double inclination) const;
  int64_t ColumnOf(double azimuth) const;
  size_t CellOf(const Vec3& point) const;
  // Cells that beams may be in. Columns below 0 or beyond the last one have
  // gone round; there are at most num_columns_.
  Range Rows(const Eigen::Vector3d& place, double distance) const;
  Range Columns(const Eigen::Vector3d& place, double distance) const;

  template <typename Visit>
  void VisitCells(int64_t row, int64_t begin, int64_t end,
                  const Visit& visit) const {
    if (begin >= end) return;
    const uint32_t last = starts_[row * num_columns_ + end];
    for (uint32_t i = starts_[row * num_columns_ + begin]; i < last; ++i) {
      visit(points_[i]);
    }
  }

  int64_t num_rows_;
  int64_t num_columns_;
  // Cell i, row by row, has points_[starts_[i]] to points_[starts_[i + 1] - 1].
  std::vector<uint32_t> starts_;
  std::vector<Vec3> points_;
};

}  // namespace tapa

#endif  // TAPA_SRC_EVAL_SCAN_BEAMS_H_
