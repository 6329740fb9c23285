#include "src/mvs/tapa/superpixel_planes.h"

#include <algorithm>

#include "src/base/depth.h"
#include "src/mvs/sweep/random.h"

namespace tapa {
namespace {

// A plane needs this many points, and this share of the superpixel.
constexpr int kMinNumPoints = 12;
constexpr double kMinShare = 0.01;

struct SuperpixelPoints {
  int num_pixels = 0;
  std::vector<Vec3> points;
};

std::vector<SuperpixelPoints> GatherPoints(const RefCamera& camera,
                                           const Map<float>& depth,
                                           const Superpixels& superpixels) {
  std::vector<SuperpixelPoints> result(superpixels.count());
  for (int row = 0; row < depth.height(); ++row) {
    for (int col = 0; col < depth.width(); ++col) {
      SuperpixelPoints& superpixel = result[superpixels.labels.At(row, col)];
      ++superpixel.num_pixels;
      const float z = depth.At(row, col);
      if (IsDepth(z)) {
        superpixel.points.push_back(z * camera.Ray(row, col));
      }
    }
  }
  return result;
}

float MedianDepth(const std::vector<Vec3>& points) {
  std::vector<float> depths;
  for (const Vec3& point : points) {
    depths.push_back(point.z);
  }
  const auto middle = depths.begin() + depths.size() / 2;
  std::nth_element(depths.begin(), middle, depths.end());
  return *middle;
}

// The neighbours of a superpixel that have a plane, with the sums of their
// similarities so far.
std::vector<Neighbor> CumulativeNeighbors(
    const std::vector<Neighbor>& neighbors,
    const std::vector<FittedPlane>& planes) {
  std::vector<Neighbor> result;
  float sum = 0;
  for (const Neighbor& neighbor : neighbors) {
    if (planes[neighbor.index].inlier_ratio > 0 && neighbor.similarity > 0) {
      sum += neighbor.similarity;
      result.push_back({neighbor.index, sum});
    }
  }
  return result;
}

uint16_t DrawNeighbor(const std::vector<Neighbor>& cumulative, float uniform) {
  if (cumulative.empty()) {
    return PlaneSet::kNone;
  }
  const float target = uniform * cumulative.back().similarity;
  for (const Neighbor& neighbor : cumulative) {
    if (target < neighbor.similarity) {
      return static_cast<uint16_t>(neighbor.index);
    }
  }
  return static_cast<uint16_t>(cumulative.back().index);
}

}  // namespace

std::vector<FittedPlane> FitPlanes(const TapaOptions& options,
                                   const RefCamera& camera,
                                   const Map<float>& depth,
                                   const Superpixels& superpixels,
                                   uint64_t seed) {
  const auto superpixel_points = GatherPoints(camera, depth, superpixels);
  std::vector<FittedPlane> planes(superpixels.count());
  for (int k = 0; k < superpixels.count(); ++k) {
    const std::vector<Vec3>& points = superpixel_points[k].points;
    const int min_num_points =
        std::max(kMinNumPoints,
                 static_cast<int>(kMinShare * superpixel_points[k].num_pixels));
    if (points.size() < static_cast<size_t>(min_num_points)) {
      continue;
    }
    const double distance =
        options.plane_distance > 0
            ? options.plane_distance
            : options.relative_plane_distance * MedianDepth(points);
    planes[k] = FitPlane(points, static_cast<float>(distance), min_num_points,
                         seed + static_cast<uint64_t>(k) * 0x9E3779B97F4A7C15u);
  }
  return planes;
}

PlaneSet DrawPlanes(const Superpixels& superpixels,
                    const std::vector<FittedPlane>& planes, uint64_t seed,
                    uint32_t round) {
  PlaneSet set;
  std::vector<std::vector<Neighbor>> cumulative;
  for (int k = 0; k < superpixels.count(); ++k) {
    set.planes.push_back(planes[k].plane);
    cumulative.push_back(CumulativeNeighbors(superpixels.neighbors[k], planes));
  }
  const Map<uint16_t>& labels = superpixels.labels;
  set.index = Map<uint16_t>(labels.width(), labels.height(), PlaneSet::kNone);
  for (size_t i = 0; i < labels.size(); ++i) {
    const uint16_t own = labels.data()[i];
    const Random random(seed, i, round);
    const bool take_own = random.Uniform(0) < planes[own].inlier_ratio;
    set.index.data()[i] =
        take_own ? own : DrawNeighbor(cumulative[own], random.Uniform(1));
  }
  return set;
}

}  // namespace tapa
