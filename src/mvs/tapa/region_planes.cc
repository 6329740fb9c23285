#include "src/mvs/tapa/region_planes.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "src/base/depth.h"
#include "src/mvs/sweep/plane.h"
#include "src/mvs/tapa/completion.h"
#include "src/mvs/tapa/even_regions.h"
#include "src/mvs/tapa/plane_fit.h"
#include "src/mvs/tapa/surface_anchors.h"
#include "src/mvs/tapa/textureness.h"
#include "src/mvs/tapa/triangle_planes.h"

namespace tapa {
namespace {

// Where regions end, in grey levels.
constexpr float kSteps[] = {6, 3};
// With anchors on a region's plane.
constexpr int kMinNumSquares = 8;
constexpr float kMinShare = 0.5f;
// Share of a region's pixels that lie on its other plane.
constexpr float kMinOtherShare = 0.1f;

// In the frame of the camera. Those in one of the squares that have an anchor
// each are a group, however many views see something there.
using RegionAnchors = std::vector<PointGroup>;

// Regions with a pixel up to `reach` away.
std::set<int32_t> RegionsAround(const Anchor& pixel, int reach,
                                const Map<int32_t>& labels) {
  std::set<int32_t> found;
  int32_t last = EvenRegions::kNone;
  for (int row = std::max(pixel.row - reach, 0);
       row <= std::min(pixel.row + reach, labels.height() - 1); ++row) {
    for (int col = std::max(pixel.col - reach, 0);
         col <= std::min(pixel.col + reach, labels.width() - 1); ++col) {
      const int32_t label = labels.At(row, col);
      const int dy = row - pixel.row;
      const int dx = col - pixel.col;
      if (label != EvenRegions::kNone && label != last &&
          dx * dx + dy * dy <= reach * reach) {
        found.insert(label);
        last = label;
      }
    }
  }
  return found;
}

// The anchors in and around each region; those between two are of both.
std::vector<RegionAnchors> GatherAnchors(
    const Control& control, const std::vector<SurfaceAnchor>& anchors,
    const EvenRegions& regions) {
  const Map<int32_t>& labels = regions.labels;
  const int size = AnchorSpacing(labels.width(), labels.height());
  // By label, and by square.
  std::vector<std::map<std::pair<int, int>, PointGroup>> groups(regions.count +
                                                                1);
  for (const auto& [pixel, point] : anchors) {
    if (control.IsStopped()) {
      break;
    }
    // FindAnchors leaves out the image's border.
    const std::pair<int, int> square(std::max(pixel.row - 1, 0) / size,
                                     std::max(pixel.col - 1, 0) / size);
    for (const int32_t label : RegionsAround(pixel, size, labels)) {
      groups[label][square].push_back(point);
    }
  }
  std::vector<RegionAnchors> result(groups.size());
  for (size_t label = 0; label < groups.size(); ++label) {
    for (auto& [square, points] : groups[label]) {
      result[label].push_back(std::move(points));
    }
  }
  return result;
}

// A plane, and where it is known.
struct AnchoredPlane {
  // Distance 0: there is none.
  Plane plane;
  // Inverse of the sum, over squares, of the mean X X^T of the anchors X on the
  // plane.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();

  // Whether the depth of a point on the plane is known as well as that of an
  // anchor: by linear least squares its variance is X^T covariance X times that
  // of the relative error of an anchor's depth.
  bool IsKnownAt(const Vec3& point) const {
    const Eigen::Vector3d x(point.x, point.y, point.z);
    const double variance = x.dot(covariance * x);
    // Below 0 by rounding where anchors are nearly along a line.
    return variance >= 0 && variance <= 1;
  }
};

// The plane that most squares have an anchor on, the share of those, and the
// anchors that do not lie on it.
struct Split {
  AnchoredPlane plane;
  float share = 0;
  RegionAnchors others;
};

Split SplitByPlane(const RegionAnchors& anchors, double max_error,
                   uint64_t seed) {
  const FittedPlane fitted = FitPlaneToDepths(
      anchors, static_cast<float>(max_error), kMinNumSquares, seed);
  Split split;
  if (fitted.inlier_ratio == 0) {
    return split;
  }
  split.plane.plane = fitted.plane;
  split.share = fitted.inlier_ratio;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const PointGroup& square : anchors) {
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
    PointGroup others;
    for (const Vec3& point : square) {
      const float offset =
          Dot(fitted.plane.normal, point) + fitted.plane.distance;
      if (std::abs(offset) <= max_error * fitted.plane.distance) {
        const Eigen::Vector3d x(point.x, point.y, point.z);
        products += x * x.transpose();
      } else {
        others.push_back(point);
      }
    }
    if (others.size() < square.size()) {
      sum += products / (square.size() - others.size());
    }
    if (!others.empty()) {
      split.others.push_back(std::move(others));
    }
  }
  split.plane.covariance = sum.inverse();
  return split;
}

// The plane of a region, and the one through most of the anchors that it
// misses.
struct RegionPlanes {
  AnchoredPlane own;
  AnchoredPlane other;
  int num_pixels = 0;
  int num_on_other = 0;
};

RegionPlanes FindPlanes(const RegionAnchors& anchors, double max_error,
                        uint64_t seed) {
  RegionPlanes planes;
  const Split split = SplitByPlane(anchors, max_error, seed);
  if (split.share >= kMinShare) {
    planes.own = split.plane;
    planes.other = SplitByPlane(split.others, max_error, seed).plane;
  }
  return planes;
}

class RegionCompleter {
 public:
  // before: depths of which other planes are made; what a step has completed is
  // no evidence for the next one.
  RegionCompleter(const Options& options, const RefCamera& camera,
                  const Map<float>& textureness, const EvenRegions& regions,
                  const Map<float>& before, Map<float>* depth,
                  Map<Vec3>* normal, Map<uint8_t>* origin)
      : options_(options),
        camera_(camera),
        textureness_(textureness),
        labels_(regions.labels),
        before_(before),
        tolerance_(static_cast<float>(options.tapa.relative_plane_distance)),
        depth_(*depth),
        normal_(*normal),
        origin_(*origin),
        planes_(regions.count + 1) {}

  void Fit(const Control& control, const std::vector<RegionAnchors>& anchors) {
    for (size_t label = 1; label < planes_.size() && !control.IsStopped();
         ++label) {
      planes_[label] =
          FindPlanes(anchors[label], options_.tapa.relative_plane_distance,
                     options_.seed + label * 0x9E3779B97F4A7C15u);
    }
    // Which decides whether a region's other plane is one.
    for (int row = 0; row < labels_.height(); ++row) {
      for (int col = 0; col < labels_.width(); ++col) {
        RegionPlanes& planes = planes_[labels_.At(row, col)];
        ++planes.num_pixels;
        planes.num_on_other +=
            LiesOn(planes.other.plane, before_, row, col) ? 1 : 0;
      }
    }
  }

  void CompleteRow(int row) {
    for (int col = 0; col < labels_.width(); ++col) {
      const RegionPlanes& planes = planes_[labels_.At(row, col)];
      if (planes.own.plane.distance == 0 ||
          textureness_.At(row, col) >= kTextured ||
          LiesOn(planes.own.plane, depth_, row, col) ||
          Stays(planes, row, col)) {
        continue;
      }
      // Where it is known it may leave the range of depths: those are the
      // sparse points', which surfaces without texture have none of.
      const Vec3 ray = camera_.Ray(row, col);
      const DepthNormal on_plane = PlaneAt(planes.own.plane, ray);
      if (IsDepth(on_plane.depth) &&
          planes.own.IsKnownAt(on_plane.depth * ray)) {
        depth_.At(row, col) = on_plane.depth;
        normal_.At(row, col) = on_plane.normal;
        origin_.At(row, col) = kFromPlane;
      }
    }
  }

 private:
  // None lies on what is no plane.
  bool LiesOn(const Plane& plane, const Map<float>& depths, int row,
              int col) const {
    const float depth = depths.At(row, col);
    const float on_plane = PlaneAt(plane, camera_.Ray(row, col)).depth;
    return plane.distance > 0 && IsDepth(depth) &&
           std::abs(depth - on_plane) <= tolerance_ * on_plane;
  }

  // Whether a pixel belongs to the other plane of its region.
  bool Stays(const RegionPlanes& planes, int row, int col) const {
    return planes.num_on_other >= kMinOtherShare * planes.num_pixels &&
           LiesOn(planes.other.plane, before_, row, col) &&
           planes.other.IsKnownAt(before_.At(row, col) * camera_.Ray(row, col));
  }

  const Options& options_;
  const RefCamera& camera_;
  const Map<float>& textureness_;
  const Map<int32_t>& labels_;
  const Map<float>& before_;
  const float tolerance_;
  Map<float>& depth_;
  Map<Vec3>& normal_;
  Map<uint8_t>& origin_;
  // By label.
  std::vector<RegionPlanes> planes_;
};

// Textureness of 1 where masked: what is there stays, and connects nothing.
Map<float> WithoutMasked(const Problem& problem,
                         const Map<float>& textureness) {
  Map<float> result = textureness;
  for (size_t i = 0; i < result.size(); ++i) {
    if (problem.IsMasked(i)) {
      result.data()[i] = 1;
    }
  }
  return result;
}

}  // namespace

void CompleteRegions(const Options& options, const Problem& problem,
                     const Control& control, const RefCamera& camera,
                     const Map<Rgb>& color, const Map<float>& textureness,
                     Map<float>* depth, Map<Vec3>* normal,
                     Map<uint8_t>* origin) {
  const Map<float> before = *depth;
  const std::vector<SurfaceAnchor> anchors = FindSurfaceAnchors(
      options, problem, control, camera, before, textureness);
  if (control.IsStopped()) {
    return;
  }
  const Map<float> steps = MeasureSteps(color);
  const Map<float> unmasked = WithoutMasked(problem, textureness);
  for (const float max_step : kSteps) {
    if (control.IsStopped()) {
      return;
    }
    const EvenRegions regions = FindEvenRegions(steps, unmasked, max_step);
    RegionCompleter completer(options, camera, unmasked, regions, before, depth,
                              normal, origin);
    completer.Fit(control, GatherAnchors(control, anchors, regions));
    for (int row = 0; row < depth->height() && !control.IsStopped(); ++row) {
      completer.CompleteRow(row);
    }
  }
}

}  // namespace tapa
