#include "src/eval/cloud_checks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>

namespace tapa {
namespace {

constexpr size_t kMaxSample = 100000;
constexpr double kMaxSizeRatio = 20;

double Median(std::vector<double>* values) {
  const auto middle = values->begin() + values->size() / 2;
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

// With two significant digits.
std::string Text(double value) {
  std::ostringstream stream;
  stream.precision(2);
  stream << value;
  return stream.str();
}

}  // namespace

double TypicalRadius(const std::vector<Vec3>& points) {
  if (points.empty()) return 0;
  const size_t step = (points.size() + kMaxSample - 1) / kMaxSample;
  std::vector<double> x, y, z;
  for (size_t i = 0; i < points.size(); i += step) {
    x.push_back(points[i].x);
    y.push_back(points[i].y);
    z.push_back(points[i].z);
  }
  const double center[] = {Median(&x), Median(&y), Median(&z)};
  std::vector<double> distances;
  for (size_t i = 0; i < points.size(); i += step) {
    distances.push_back(std::hypot(points[i].x - center[0],
                                   points[i].y - center[1],
                                   points[i].z - center[2]));
  }
  return Median(&distances);
}

std::string CheckUnit(const std::vector<Vec3>& reconstruction,
                      const std::vector<Vec3>& scan, const std::string& name) {
  const double radius = TypicalRadius(reconstruction);
  const double scan_radius = TypicalRadius(scan);
  // A single point, or many at one place, have no size.
  if (radius == 0 || scan_radius == 0) return "";
  const double ratio = scan_radius / radius;
  if (std::max(ratio, 1 / ratio) < kMaxSizeRatio) return "";
  return name + " is " + Text(std::max(ratio, 1 / ratio)) + " times " +
         (ratio > 1 ? "larger" : "smaller") +
         " than the reconstruction (half of the points are within " +
         Text(scan_radius) + " and " + Text(radius) +
         " of their centres): see to it that both are in metres";
}

std::string CheckPrecision(const std::vector<Vec3>& points,
                           double least_tolerance, const std::string& name) {
  float largest = 0;
  for (const Vec3& point : points) {
    largest = std::max(
        {largest, std::abs(point.x), std::abs(point.y), std::abs(point.z)});
  }
  const double step =
      static_cast<double>(largest) * std::numeric_limits<float>::epsilon();
  if (step <= least_tolerance / 10) return "";
  return name + " has coordinates of up to " + Text(largest) +
         ", which single precision stores to " + Text(step) +
         " only: move everything nearer to the origin";
}

std::string CheckOverlap(const std::vector<Verdict>& completeness,
                         double largest_tolerance, size_t num_tolerances) {
  for (const Verdict& verdict : completeness) {
    if (verdict.GoodAt(num_tolerances - 1)) return "";
  }
  return "no point of the scans is within " + Text(largest_tolerance) +
         " m of the reconstruction: see to it that the reconstruction is in "
         "the frame of the MeshLab project, and in metres";
}

std::string CheckJudged(const std::vector<Verdict>& accuracy,
                        size_t num_tolerances) {
  for (const Verdict& verdict : accuracy) {
    if (verdict.judged || verdict.GoodAt(num_tolerances - 1)) return "";
  }
  return "no point of the reconstruction can be judged, as none is in a beam "
         "of a scanner, before a measured point or close to it; the accuracy "
         "is given as 0";
}

}  // namespace tapa
