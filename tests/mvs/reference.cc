#include "tests/mvs/reference.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "src/mvs/sweep/random.h"

namespace tapa::reference {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;

Matrix3d Intrinsics(const View& view) {
  Matrix3d K;
  K << view.camera.fx, 0, view.camera.cx, 0, view.camera.fy, view.camera.cy, 0,
      0, 1;
  return K;
}

Matrix3d Rotation(const View& view) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
      view.camera.R.data());
}

Vector3d Translation(const View& view) {
  return Eigen::Map<const Vector3d>(view.camera.t.data());
}

struct RelativePose {
  Matrix3d R;
  Vector3d t;
};

RelativePose FromReference(const Problem& problem, int m) {
  RelativePose pose;
  pose.R =
      Rotation(problem.sources[m]) * Rotation(problem.reference).transpose();
  pose.t =
      Translation(problem.sources[m]) - pose.R * Translation(problem.reference);
  return pose;
}

Vector3d ToEigen(const Vec3& v) { return Vector3d(v.x, v.y, v.z); }

Vector3d Ray(const Problem& problem, int row, int col) {
  return Intrinsics(problem.reference).inverse() *
         Vector3d(col + 0.5, row + 0.5, 1);
}

Matrix3d Homography(const Problem& problem, int row, int col,
                    const DepthNormal& plane, int m) {
  const RelativePose pose = FromReference(problem, m);
  const Vector3d n = ToEigen(plane.normal);
  const double distance = plane.depth * n.dot(Ray(problem, row, col));
  return Intrinsics(problem.sources[m]) *
         (pose.R + pose.t * n.transpose() / distance) *
         Intrinsics(problem.reference).inverse();
}

// 0 to 1, black outside.
double Pixel(const Map<uint8_t>& image, int row, int col) {
  const bool inside =
      row >= 0 && col >= 0 && row < image.height() && col < image.width();
  return inside ? image.At(row, col) / 255.0 : 0.0;
}

// Between the centres of pixels, which are at (col + 0.5, row + 0.5).
double Bilinear(const Map<uint8_t>& image, double x, double y) {
  if (!(x > -0.5 && y > -0.5 && x < image.width() + 0.5 &&
        y < image.height() + 0.5)) {
    return 0;
  }
  const int col = static_cast<int>(std::floor(x - 0.5));
  const int row = static_cast<int>(std::floor(y - 0.5));
  const double fx = x - 0.5 - col;
  const double fy = y - 0.5 - row;
  return (1 - fy) * ((1 - fx) * Pixel(image, row, col) +
                     fx * Pixel(image, row, col + 1)) +
         fy * ((1 - fx) * Pixel(image, row + 1, col) +
               fx * Pixel(image, row + 1, col + 1));
}

// Sums over the window around a reference pixel, with its bilateral weights: of
// reference and source intensities, 0 to 1.
struct WindowSums {
  double var_r;
  double var_s;
  double covariance;
};

// Sparse windows of at least four rows are without their corners.
bool IsInWindow(const Options& options, int dy, int dx) {
  const int r = options.window_radius;
  return !(options.window_step == 2 && r >= 3 && std::abs(dx) == r &&
           std::abs(dy) == r);
}

// Spreads of the weights where there is no texture and where there is much.
double SigmaSpatial(const Options& options) {
  return options.sigma_spatial > 0 ? options.sigma_spatial
                                   : options.window_radius;
}

double SigmaTextured(const Options& options) {
  const double sigma = options.search.sigma_textured;
  return sigma > 0 ? std::min(sigma, SigmaSpatial(options))
                   : SigmaSpatial(options);
}

// Weight of a sample for its distance, without regard to texture.
double Gaussian(double sigma, int dy, int dx) {
  return std::exp(-(dx * dx + dy * dy) / (2 * sigma * sigma));
}

// The same where there is much texture: such windows end at two sigmas, but not
// within three pixels.
double TexturedGaussian(const Options& options, int dy, int dx) {
  const double sigma = SigmaTextured(options);
  const bool is_cut =
      sigma < SigmaSpatial(options) &&
      std::max(std::abs(dx), std::abs(dy)) > std::max(2 * sigma, 3.0);
  return is_cut ? 0 : Gaussian(sigma, dy, dx);
}

// Share of the latter in the weights of a window.
double TexturedShare(const Options& options, const Map<uint8_t>& image, int row,
                     int col) {
  const int r = options.window_radius;
  double sum_w = 0, sum = 0, squared_sum = 0;
  for (int dy = -r; dy <= r; dy += options.window_step) {
    for (int dx = -r; dx <= r; dx += options.window_step) {
      if (IsInWindow(options, dy, dx)) {
        const double w = TexturedGaussian(options, dy, dx);
        const double value = Pixel(image, row + dy, col + dx);
        sum_w += w;
        sum += w * value;
        squared_sum += w * value * value;
      }
    }
  }
  const double mean = sum / sum_w;
  const double variance = squared_sum / sum_w - mean * mean;
  return std::min(variance / 0.0005, 1.0);
}

WindowSums SumWindow(const Options& options, const Problem& problem, int row,
                     int col, const DepthNormal& plane, int m) {
  const Map<uint8_t>& ref = *problem.reference.image;
  const Matrix3d H = Homography(problem, row, col, plane, m);
  const int r = options.window_radius;
  const double share = TexturedShare(options, ref, row, col);
  double sum_w = 0, sum_r = 0, sum_s = 0, sum_rr = 0, sum_ss = 0, sum_rs = 0;
  for (int dy = -r; dy <= r; dy += options.window_step) {
    for (int dx = -r; dx <= r; dx += options.window_step) {
      if (!IsInWindow(options, dy, dx)) {
        continue;
      }
      const double reference = Pixel(ref, row + dy, col + dx);
      const double difference = reference - Pixel(ref, row, col);
      const double w =
          ((1 - share) * Gaussian(SigmaSpatial(options), dy, dx) +
           share * TexturedGaussian(options, dy, dx)) *
          std::exp(-difference * difference /
                   (2 * options.sigma_color * options.sigma_color));
      const Vector3d p = H * Vector3d(col + dx + 0.5, row + dy + 0.5, 1);
      const double source = p(2) > 0 ? Bilinear(*problem.sources[m].image,
                                                p(0) / p(2), p(1) / p(2))
                                     : 0;
      sum_w += w;
      sum_r += w * reference;
      sum_s += w * source;
      sum_rr += w * reference * reference;
      sum_ss += w * source * source;
      sum_rs += w * reference * source;
    }
  }
  const double mean_r = sum_r / sum_w;
  const double mean_s = sum_s / sum_w;
  return {sum_rr / sum_w - mean_r * mean_r, sum_ss / sum_w - mean_s * mean_s,
          sum_rs / sum_w - mean_r * mean_s};
}

}  // namespace

double PhotometricCost(const Options& options, const Problem& problem, int row,
                       int col, const DepthNormal& plane, int m) {
  const WindowSums sums = SumWindow(options, problem, row, col, plane, m);
  if (sums.var_r < 1e-5 || sums.var_s < 1e-5) {
    return 2;
  }
  return std::clamp(1 - sums.covariance / std::sqrt(sums.var_r * sums.var_s),
                    0.0, 2.0);
}

double GeometricCost(const Options& options, const Problem& problem, int row,
                     int col, double depth, int m) {
  const double max_cost = options.geom_consistency_max_cost;
  const RelativePose pose = FromReference(problem, m);
  const View& source = problem.sources[m];
  const Vector3d p =
      Intrinsics(source) * (pose.R * (depth * Ray(problem, row, col)) + pose.t);
  if (!(p(2) > 0)) {
    return max_cost;
  }
  const Vector3d q = p / p(2);
  const int source_col = static_cast<int>(std::floor(q(0)));
  const int source_row = static_cast<int>(std::floor(q(1)));
  if (source_col < 0 || source_row < 0 || source_col >= source.depth->width() ||
      source_row >= source.depth->height()) {
    return max_cost;
  }
  const double source_depth = source.depth->At(source_row, source_col);
  if (!(source_depth > 0)) {
    return max_cost;
  }
  const Vector3d back =
      Intrinsics(problem.reference) *
      (pose.R.transpose() *
       (source_depth * (Intrinsics(source).inverse() * q) - pose.t));
  const double error =
      std::hypot(col + 0.5 - back(0) / back(2), row + 0.5 - back(1) / back(2));
  return error < max_cost ? error : max_cost;
}

double Emission(const Options& options, double cost) {
  const double sigma = options.ncc_sigma;
  const double norm =
      2 / (std::sqrt(2 * kPi) * sigma * std::erf(2 / (sigma * std::sqrt(2.0))));
  return norm * std::exp(-cost * cost / (2 * sigma * sigma));
}

double ForwardMessage(double emission, double previous) {
  const double stay = 0.99999;
  const double on = emission * (previous * stay + (1 - previous) * (1 - stay));
  const double off = 0.5 * (previous * (1 - stay) + (1 - previous) * stay);
  return on / (on + off);
}

double BackwardMessage(double emission, double next) {
  const double stay = 0.99999;
  const double on = next * emission * stay + (1 - next) * 0.5 * (1 - stay);
  const double off = next * emission * (1 - stay) + (1 - next) * 0.5 * stay;
  return on / (on + off);
}

double SelectionProb(double forward, double backward, double previous,
                     double previous_weight) {
  const double on = forward * backward;
  const double off = (1 - forward) * (1 - backward);
  return previous_weight * previous + (1 - previous_weight) * on / (on + off);
}

double Prior(const Options& options, const Problem& problem, int row, int col,
             const DepthNormal& plane, int m) {
  const RelativePose pose = FromReference(problem, m);
  const Vector3d point = plane.depth * Ray(problem, row, col);
  const Vector3d to_ref = (-point).normalized();
  const Vector3d to_source =
      (-pose.R.transpose() * pose.t - point).normalized();

  double triangulation = 1;
  const double cos_min = std::cos(options.min_triangulation_angle * kPi / 180);
  const double cosine = std::abs(to_ref.dot(to_source));
  if (cosine > cos_min) {
    const double scaled = 1 - (1 - cosine) / (1 - cos_min);
    triangulation = std::clamp(1 - scaled * scaled, 0.0, 1.0);
  }

  const double x = 1 - std::max(0.0, to_source.dot(ToEigen(plane.normal)));
  const double incident = std::exp(
      -x * x /
      (2 * options.incident_angle_sigma * options.incident_angle_sigma));

  // Area of the warped window by the shoelace formula.
  const Matrix3d H = Homography(problem, row, col, plane, m);
  const double r = options.window_radius;
  const double corners[4][2] = {{-r, -r}, {-r, r}, {r, r}, {r, -r}};
  double area = 0;
  for (int i = 0; i < 4; ++i) {
    const double* a = corners[i];
    const double* b = corners[(i + 1) % 4];
    const Vector3d p = H * Vector3d(col + 0.5 + a[0], row + 0.5 + a[1], 1);
    const Vector3d q = H * Vector3d(col + 0.5 + b[0], row + 0.5 + b[1], 1);
    area += 0.5 * (p(0) / p(2) * q(1) / q(2) - q(0) / q(2) * p(1) / p(2));
  }
  const double size = 2 * r + 1;
  const double ratio = std::abs(area) / (size * size);
  const double resolution = ratio < 1 ? ratio : 1 / ratio;
  return triangulation * incident * resolution;
}

double RoundCost(double cost) {
  return std::floor(cost / 2 * 65535 + 0.5) / 65535 * 2;
}

State Initialize(const Options& options, const Problem& problem,
                 const Map<float>& depth, const Map<Vec3>& normal) {
  State state;
  state.depth = depth;
  state.normal = normal;
  state.chosen = Map<uint8_t>(depth.width(), depth.height());
  for (int row = 0; row < depth.height(); ++row) {
    for (int col = 0; col < depth.width(); ++col) {
      const DepthNormal plane = {depth.At(row, col), normal.At(row, col)};
      for (size_t m = 0; m < problem.sources.size(); ++m) {
        state.cost.push_back(RoundCost(PhotometricCost(
            options, problem, row, col, plane, static_cast<int>(m))));
        state.prob.push_back(0.5);
      }
    }
  }
  return state;
}

std::vector<Position> LinePixels(const Problem& problem, int direction,
                                 int line) {
  const int width = problem.reference.image->width();
  const int height = problem.reference.image->height();
  std::vector<Position> pixels;
  if (direction % 2 == 0) {
    for (int row = 0; row < height; ++row) {
      pixels.push_back({row, line});
    }
  } else {
    for (int col = 0; col < width; ++col) {
      pixels.push_back({line, col});
    }
  }
  if (direction == 1 || direction == 2) {
    std::reverse(pixels.begin(), pixels.end());
  }
  return pixels;
}

namespace {

// Rotation of the normal as in the definition: by Rx Ry Rz, smaller and smaller
// until it faces the camera.
Vec3 PerturbedNormal(const Random& random, double perturbation,
                     const Vec3& normal, const Vector3d& ray) {
  for (int trial = 0; trial < 4; ++trial) {
    double angle[3];
    for (int axis = 0; axis < 3; ++axis) {
      angle[axis] =
          (random.Uniform(kDrawNormal + 3 * trial + axis) - 0.5) * perturbation;
    }
    const Vector3d n =
        Eigen::AngleAxisd(angle[0], Vector3d::UnitX()).toRotationMatrix() *
        Eigen::AngleAxisd(angle[1], Vector3d::UnitY()).toRotationMatrix() *
        Eigen::AngleAxisd(angle[2], Vector3d::UnitZ()).toRotationMatrix() *
        ToEigen(normal);
    if (n.dot(ray) < 0) {
      const Vector3d unit = n.normalized();
      return {static_cast<float>(unit(0)), static_cast<float>(unit(1)),
              static_cast<float>(unit(2))};
    }
    perturbation /= 2;
  }
  return normal;
}

bool IsSame(const DepthNormal& a, const DepthNormal& b) {
  return std::abs(a.depth - b.depth) <= 1e-4f * b.depth &&
         (ToEigen(a.normal) - ToEigen(b.normal)).norm() <= 1e-2;
}

std::vector<int> DrawViews(const Options& options, const Random& random,
                           const std::vector<double>& weights) {
  double sum = 0;
  for (const double weight : weights) {
    sum += weight;
  }
  std::vector<int> drawn;
  for (int i = 0; i < options.num_samples; ++i) {
    const double u = random.Uniform(kDrawSample + i);
    double cumulative = 0;
    for (size_t m = 0; m < weights.size(); ++m) {
      cumulative += weights[m] / sum;
      if (u < cumulative) {
        drawn.push_back(static_cast<int>(m));
        break;
      }
    }
  }
  return drawn;
}

// Depth 0: no hypothesis.
DepthNormal PlaneOfPixel(const PlaneSet& set, const GuideMaps& guide,
                         const Problem& problem, int row, int col) {
  if (set.index.empty() || set.index.At(row, col) == PlaneSet::kNone) {
    return DepthNormal();
  }
  const Plane& plane = set.planes[set.index.At(row, col)];
  const double depth =
      -plane.distance / ToEigen(plane.normal).dot(Ray(problem, row, col));
  if (!(depth >= guide.depth_min) || !(depth <= guide.depth_max)) {
    return DepthNormal();
  }
  return {static_cast<float>(depth), plane.normal};
}

}  // namespace

double PlusWeight(double t, double range) { return (1 - range) + range * t; }

double MinusWeight(double t, double range) { return 1 - range * t; }

void Sweep(const Options& options, const Problem& problem,
           const GuideMaps& guide, int index, State* state) {
  const int num_sources = static_cast<int>(problem.sources.size());
  const int width = state->depth.width();
  const int direction = index % 4;
  const int num_lines = direction % 2 == 0 ? width : state->depth.height();
  const double shrinkage = std::pow(2.0, -(index / 4 + direction / 4.0));
  const double previous_weight =
      static_cast<double>(index) / (4 * options.num_iterations);
  for (int line = 0; line < num_lines; ++line) {
    const std::vector<Position> pixels = LinePixels(problem, direction, line);
    const int length = static_cast<int>(pixels.size());
    const auto at = [&](int i, int m) {
      return (static_cast<size_t>(pixels[i].row) * width + pixels[i].col) *
                 num_sources +
             m;
    };
    std::vector<std::vector<double>> backward(length,
                                              std::vector<double>(num_sources));
    for (int m = 0; m < num_sources; ++m) {
      double message = 0.5;
      for (int i = length - 1; i >= 0; --i) {
        message =
            BackwardMessage(Emission(options, state->cost[at(i, m)]), message);
        backward[i][m] = message;
      }
    }

    std::vector<double> forward(num_sources, 0.5);
    Position before = pixels[0];
    for (int i = 0; i < length; ++i) {
      const auto [row, col] = pixels[i];
      const DepthNormal current = {state->depth.At(row, col),
                                   state->normal.At(row, col)};
      const Random random(options.seed,
                          static_cast<uint64_t>(row) * width + col, index);
      std::vector<double> weights(num_sources);
      for (int m = 0; m < num_sources; ++m) {
        const double alpha = ForwardMessage(
            Emission(options, state->cost[at(i, m)]), forward[m]);
        weights[m] = SelectionProb(alpha, backward[i][m], state->prob[at(i, m)],
                                   previous_weight) *
                     Prior(options, problem, row, col, current, m);
      }
      const std::vector<int> drawn = DrawViews(options, random, weights);

      const Vector3d ray = Ray(problem, row, col);
      const Vec3 previous_normal = state->normal.At(before.row, before.col);
      const double slope = ToEigen(previous_normal).dot(ray);
      const double previous_depth = state->depth.At(before.row, before.col);
      const double propagated =
          std::abs(slope) < 1e-5
              ? previous_depth
              : previous_depth *
                    ToEigen(previous_normal)
                        .dot(Ray(problem, before.row, before.col)) /
                    slope;
      double drawn_cost = 0;
      for (const int m : drawn) {
        drawn_cost += state->cost[at(i, m)] / drawn.size();
      }
      const double perturbation =
          (drawn_cost > 0.5 ? 1 : options.first_perturbation) * shrinkage;
      const float random_depth = static_cast<float>(
          current.depth *
          (1 - perturbation + 2 * perturbation * random.Uniform(kDrawDepth)));
      const Vec3 random_normal =
          PerturbedNormal(random, perturbation, current.normal, ray);
      const std::vector<DepthNormal> planes = {
          current,
          {static_cast<float>(propagated), previous_normal},
          {random_depth, random_normal},
          {current.depth, random_normal},
          {random_depth, current.normal},
          guide.depth_prior.empty() ? DepthNormal()
                                    : Unpack(guide.depth_prior.At(row, col)),
          PlaneOfPixel(guide.fine, guide, problem, row, col),
          PlaneOfPixel(guide.coarse, guide, problem, row, col)};
      constexpr size_t kFirstPlanar = 6;
      double plus = 1;
      double minus = 1;
      if (!guide.textureness.empty()) {
        const double t = guide.textureness.At(row, col);
        plus = PlusWeight(t, guide.weight_range);
        minus = MinusWeight(t, guide.weight_range);
      }

      // Of the three random ones, at 2, 3 and 4, or none.
      const float share = static_cast<float>(options.search.random_share);
      const float draw = random.Uniform(kDrawHypothesis);
      const size_t only_random =
          draw < share ? 2 + static_cast<size_t>(3 * draw / share) : 0;
      size_t best = 0;
      double best_cost = std::numeric_limits<double>::infinity();
      for (size_t k = 0; k < planes.size(); ++k) {
        if (!options.search.try_all &&
            ((k >= 2 && k <= 4 && k != only_random) ||
             (k >= kFirstPlanar && index % 2 == 0) ||
             (k == 1 && IsSame(planes[1], current)))) {
          continue;
        }
        if (k > 0 && (!(planes[k].depth > 0) ||
                      !(ToEigen(planes[k].normal).dot(ray) < 0))) {
          continue;
        }
        const double photometric_weight = k < kFirstPlanar ? minus : plus;
        const double geometric_weight = k < kFirstPlanar ? plus : minus;
        double cost = 0;
        for (const int m : drawn) {
          cost += photometric_weight *
                  (k == 0 ? state->cost[at(i, m)]
                          : RoundCost(PhotometricCost(options, problem, row,
                                                      col, planes[k], m)));
          if (options.geom_consistency) {
            cost +=
                geometric_weight * options.geom_consistency_regularizer *
                GeometricCost(options, problem, row, col, planes[k].depth, m);
          }
        }
        // The engine adds up in single precision: ties are equal to that.
        if (k > 0 && k < kFirstPlanar) {
          // The estimate has to be beaten clearly where there is no texture.
          const double variance =
              SumWindow(options, problem, row, col, current, 0).var_r;
          cost += options.search.hysteresis * options.num_samples *
                  std::pow(0.00005 / (0.00005 + variance), 2);
        }
        if (cost <= best_cost + 1e-9) {
          best = k;
          best_cost = cost;
        }
      }
      for (int m = 0; m < num_sources; ++m) {
        if (best != 0 && (options.search.measure_all ||
                          std::count(drawn.begin(), drawn.end(), m) > 0)) {
          state->cost[at(i, m)] = RoundCost(
              PhotometricCost(options, problem, row, col, planes[best], m));
        }
        forward[m] = ForwardMessage(Emission(options, state->cost[at(i, m)]),
                                    forward[m]);
        state->prob[at(i, m)] = SelectionProb(
            forward[m], backward[i][m], state->prob[at(i, m)], previous_weight);
      }
      state->depth.At(row, col) = planes[best].depth;
      state->normal.At(row, col) = planes[best].normal;
      state->chosen.At(row, col) = static_cast<uint8_t>(best);
      before = pixels[i];
    }
  }
}

int CountConsistent(const Options& options, const Problem& problem, int row,
                    int col, const DepthNormal& plane, const double* prob) {
  const Vector3d point = plane.depth * Ray(problem, row, col);
  int count = 0;
  for (size_t m = 0; m < problem.sources.size(); ++m) {
    const RelativePose pose = FromReference(problem, static_cast<int>(m));
    const Vector3d to_source = -pose.R.transpose() * pose.t - point;
    const double angle =
        std::acos(std::clamp((-point).normalized().dot(to_source.normalized()),
                             -1.0, 1.0)) *
        180 / kPi;
    count += angle >= options.filter_min_triangulation_angle &&
             to_source.dot(ToEigen(plane.normal)) > 0 &&
             prob[m] >= Emission(options, 1 - options.filter_min_ncc) &&
             (!options.geom_consistency ||
              GeometricCost(options, problem, row, col, plane.depth,
                            static_cast<int>(m)) <=
                  options.filter_geom_consistency_max_cost);
  }
  return count;
}

}  // namespace tapa::reference
