#include "tests/mvs/tapa_reference.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace tapa::reference {
namespace {

using Eigen::Vector3d;

Vector3d ToEigen(const Vec3& v) { return Vector3d(v.x, v.y, v.z); }

bool IsDepth(float depth) { return std::isfinite(depth) && depth > 0; }

struct Pixel {
  int row;
  int col;
};

template <typename T>
bool Contains(const Map<T>& map, const Pixel& p) {
  return p.row >= 0 && p.col >= 0 && p.row < map.height() &&
         p.col < map.width();
}

std::vector<Pixel> Around(const Pixel& p) {
  return {{p.row - 1, p.col},
          {p.row + 1, p.col},
          {p.row, p.col - 1},
          {p.row, p.col + 1}};
}

bool AreContinuous(const Continuity& continuity, double a, double b) {
  return std::abs(a - b) <= continuity.step ||
         std::abs(a - b) <= continuity.share * std::min(a, b);
}

}  // namespace

double Textureness(const Map<uint8_t>& image, int row, int col,
                   const TexturenessOptions& options) {
  std::vector<double> values;
  for (int r = row - options.radius; r <= row + options.radius; ++r) {
    for (int c = col - options.radius; c <= col + options.radius; ++c) {
      if (r < 0 || r >= image.height() || c < 0 || c >= image.width()) continue;
      values.push_back(image.At(r, c) / 255.0);
    }
  }
  double mean = 0;
  for (const double value : values) mean += value / values.size();
  double variance = 0;
  for (const double value : values) {
    variance += (value - mean) * (value - mean) / values.size();
  }
  return (variance + options.epsilon) /
         (variance + options.epsilon / options.min_textureness);
}

void RemoveSpeckles(const Continuity& continuity, int max_size,
                    Map<float>* depth) {
  const Map<float> before = *depth;
  Map<uint8_t> visited(depth->width(), depth->height(), 0);
  for (int row = 0; row < depth->height(); ++row) {
    for (int col = 0; col < depth->width(); ++col) {
      if (!IsDepth(before.At(row, col))) {
        depth->At(row, col) = 0;
        continue;
      }
      if (visited.At(row, col)) {
        continue;
      }
      visited.At(row, col) = 1;
      std::vector<Pixel> region = {{row, col}};
      for (size_t i = 0; i < region.size(); ++i) {
        const Pixel p = region[i];
        for (const Pixel& q : Around(p)) {
          if (Contains(before, q) && !visited.At(q.row, q.col) &&
              IsDepth(before.At(q.row, q.col)) &&
              AreContinuous(continuity, before.At(p.row, p.col),
                            before.At(q.row, q.col))) {
            visited.At(q.row, q.col) = 1;
            region.push_back(q);
          }
        }
      }
      if (static_cast<int>(region.size()) <= max_size) {
        for (const Pixel& p : region) {
          depth->At(p.row, p.col) = 0;
        }
      }
    }
  }
}

std::vector<std::vector<Neighbor>> FindNeighbors(const Map<Rgb>& image,
                                                 const Map<uint16_t>& labels,
                                                 int count) {
  using Bin = std::tuple<int, int, int>;
  const auto histogram = [&](int label) {
    std::map<Bin, double> result;
    double size = 0;
    for (size_t i = 0; i < labels.size(); ++i) {
      if (labels.data()[i] == label) {
        const Rgb& c = image.data()[i];
        ++result[Bin(c.r * 8 / 256, c.g * 8 / 256, c.b * 8 / 256)];
        ++size;
      }
    }
    for (auto& [bin, share] : result) {
      share /= size;
    }
    return result;
  };
  const auto touch = [&](int a, int b) {
    for (int row = 0; row < labels.height(); ++row) {
      for (int col = 0; col < labels.width(); ++col) {
        if (labels.At(row, col) != a) {
          continue;
        }
        for (const Pixel& q : Around({row, col})) {
          if (Contains(labels, q) && labels.At(q.row, q.col) == b) {
            return true;
          }
        }
      }
    }
    return false;
  };
  std::vector<std::vector<Neighbor>> neighbors(count);
  for (int a = 0; a < count; ++a) {
    const auto histogram_a = histogram(a);
    for (int b = 0; b < count; ++b) {
      if (a == b || !touch(a, b)) {
        continue;
      }
      double similarity = 0;
      for (const auto& [bin, share] : histogram(b)) {
        const auto found = histogram_a.find(bin);
        if (found != histogram_a.end()) {
          similarity += std::sqrt(share * found->second);
        }
      }
      neighbors[a].push_back({b, static_cast<float>(similarity)});
    }
  }
  return neighbors;
}

double DistanceTo(const DoublePlane& plane, const Vec3& point) {
  return std::abs(plane.normal[0] * point.x + plane.normal[1] * point.y +
                  plane.normal[2] * point.z + plane.distance);
}

DoublePlane FitLeastSquares(const std::vector<Vec3>& points) {
  Eigen::MatrixXd rows(points.size(), 3);
  for (size_t i = 0; i < points.size(); ++i) {
    rows.row(i) = ToEigen(points[i]).transpose();
  }
  const Vector3d mean = rows.colwise().mean();
  rows.rowwise() -= mean.transpose();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows, Eigen::ComputeThinV);
  Vector3d normal = svd.matrixV().col(2);
  if (normal.dot(mean) > 0) {
    normal = -normal;
  }
  return {{normal(0), normal(1), normal(2)}, -normal.dot(mean)};
}

int MaxNumInliers(const std::vector<Vec3>& points, double max_distance) {
  int best = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      for (size_t k = 0; k < j; ++k) {
        const Vector3d a = ToEigen(points[i]);
        const Vector3d cross =
            (ToEigen(points[j]) - a).cross(ToEigen(points[k]) - a);
        if (cross.norm() < 1e-9) {
          continue;
        }
        const Vector3d normal = cross.normalized();
        int count = 0;
        for (const Vec3& point : points) {
          count += std::abs(normal.dot(ToEigen(point) - a)) <= max_distance;
        }
        best = std::max(best, count);
      }
    }
  }
  return best;
}

void FillMissing(const FillOptions& options, const RefCamera& camera,
                 const Map<uint8_t>& image, Map<float>* depth,
                 Map<Vec3>* normal) {
  for (int round = 0; round < options.num_rounds; ++round) {
    const Map<float> depths = *depth;
    const Map<Vec3> normals = *normal;
    for (int row = 0; row < image.height(); ++row) {
      for (int col = 0; col < image.width(); ++col) {
        if (depths.At(row, col) > 0) {
          continue;
        }
        std::vector<Pixel> window;
        for (int dy = -options.radius; dy <= options.radius; ++dy) {
          for (int dx = -options.radius; dx <= options.radius; ++dx) {
            const Pixel q = {row + dy, col + dx};
            if (Contains(depths, q) && depths.At(q.row, q.col) > 0) {
              window.push_back(q);
            }
          }
        }
        if (window.empty()) {
          continue;
        }
        double low = depths.At(window[0].row, window[0].col);
        double high = low;
        for (const Pixel& q : window) {
          low = std::min<double>(low, depths.At(q.row, q.col));
          high = std::max<double>(high, depths.At(q.row, q.col));
        }
        // Each bin is a third of the range; the last one is closed.
        std::vector<Pixel> bins[3];
        for (const Pixel& q : window) {
          const double place = 3 * (depths.At(q.row, q.col) - low);
          const double range = high - low;
          bins[place >= 2 * range && range > 0 ? 2
               : place >= range && range > 0   ? 1
                                               : 0]
              .push_back(q);
        }
        int fullest = 0;
        for (int i = 1; i < 3; ++i) {
          if (bins[i].size() > bins[fullest].size()) {
            fullest = i;
          }
        }
        double sum = 0;
        double mean_depth = 0;
        Vector3d mean_normal = Vector3d::Zero();
        for (const Pixel& q : bins[fullest]) {
          const double squared_distance =
              std::pow(q.row - row, 2) + std::pow(q.col - col, 2);
          const double difference =
              (image.At(q.row, q.col) - image.At(row, col)) / 255.0;
          const double weight = std::exp(
              -squared_distance / (2 * std::pow(options.sigma_spatial, 2)) -
              difference * difference / (2 * std::pow(options.sigma_color, 2)));
          sum += weight;
          mean_depth += weight * depths.At(q.row, q.col);
          mean_normal += weight * ToEigen(normals.At(q.row, q.col));
        }
        if (!(mean_normal.dot(ToEigen(camera.Ray(row, col))) < 0)) {
          continue;
        }
        mean_normal.normalize();
        depth->At(row, col) = static_cast<float>(mean_depth / sum);
        normal->At(row, col) = {static_cast<float>(mean_normal(0)),
                                static_cast<float>(mean_normal(1)),
                                static_cast<float>(mean_normal(2))};
      }
    }
  }
}

}  // namespace tapa::reference
