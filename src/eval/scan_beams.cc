#include "src/eval/scan_beams.h"

#include <algorithm>
#include <cmath>

#include "src/eval/parallel_for.h"

namespace tapa {
namespace {

constexpr double kPi = 3.14159265358979323846;

// Added to angles on either side, against rounding.
constexpr double kAngleMargin = 1e-9;

// For a few points per cell. Finer cells than 0.04 degrees would be smaller
// than the beams.
int64_t ChooseNumRows(size_t num_points) {
  const auto rows =
      static_cast<int64_t>(std::sqrt(static_cast<double>(num_points) / 6));
  return std::clamp<int64_t>(rows, 8, 4096);
}

bool HasBeam(const Vec3& point) {
  return point.x != 0 || point.y != 0 || point.z != 0;
}

}  // namespace

ScanBeams::ScanBeams(const std::vector<Vec3>& points, ThreadTeam* team)
    : num_rows_(ChooseNumRows(points.size())), num_columns_(2 * num_rows_) {
  // A counting sort.
  std::vector<uint32_t> cells(points.size());
  ParallelFor(points.size(), 4096, team, [&](int, size_t i) {
    cells[i] = static_cast<uint32_t>(CellOf(points[i]));
  });
  starts_.assign(num_rows_ * num_columns_ + 1, 0);
  for (size_t i = 0; i < points.size(); ++i) {
    if (HasBeam(points[i])) ++starts_[cells[i]];
  }
  uint32_t end = 0;
  for (uint32_t& start : starts_) {
    end += start;
    start = end;
  }
  points_.resize(end);
  for (size_t i = points.size(); i > 0; --i) {
    const Vec3& point = points[i - 1];
    if (HasBeam(point)) points_[--starts_[cells[i - 1]]] = point;
  }
}

int64_t ScanBeams::RowOf(double inclination) const {
  return static_cast<int64_t>(
      std::floor(inclination * static_cast<double>(num_rows_) / kPi));
}

int64_t ScanBeams::ColumnOf(double azimuth) const {
  return static_cast<int64_t>(std::floor(
      (azimuth + kPi) * static_cast<double>(num_columns_) / (2 * kPi)));
}

size_t ScanBeams::CellOf(const Vec3& point) const {
  const double x = point.x;
  const double y = point.y;
  const double inclination = std::atan2(std::hypot(x, y), point.z);
  const int64_t row = std::clamp<int64_t>(RowOf(inclination), 0, num_rows_ - 1);
  const int64_t column =
      std::clamp<int64_t>(ColumnOf(std::atan2(y, x)), 0, num_columns_ - 1);
  return static_cast<size_t>(row * num_columns_ + column);
}

ScanBeams::Range ScanBeams::Rows(const Eigen::Vector3d& place,
                                 double distance) const {
  if (IsAtScanner(place, distance)) return {0, num_rows_};
  const double inclination =
      std::atan2(std::hypot(place.x(), place.y()), place.z());
  const double angle = std::asin(distance / place.norm()) + kAngleMargin;
  return {std::max<int64_t>(0, RowOf(inclination - angle)),
          std::min(num_rows_, RowOf(inclination + angle) + 1)};
}

ScanBeams::Range ScanBeams::Columns(const Eigen::Vector3d& place,
                                    double distance) const {
  const double horizontal = std::hypot(place.x(), place.y());
  if (horizontal <= distance) return {0, num_columns_};
  // The planes through the vertical axis that touch the sphere around `place`.
  const double azimuth = std::atan2(place.y(), place.x());
  const double angle = std::asin(distance / horizontal) + kAngleMargin;
  const Range range = {ColumnOf(azimuth - angle),
                       ColumnOf(azimuth + angle) + 1};
  if (range.end - range.begin >= num_columns_) return {0, num_columns_};
  return range;
}

}  // namespace tapa
