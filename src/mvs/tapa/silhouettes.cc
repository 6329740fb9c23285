#include "src/mvs/tapa/silhouettes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "src/base/depth.h"
#include "src/mvs/sweep/depth_normal.h"
#include "src/mvs/tapa/completion.h"
#include "src/mvs/tapa/textureness.h"

namespace tapa {
namespace {

// Share of the weight that decides.
constexpr float kMinShare = 0.5f;
// Rows and columns of those who are asked. An even number, so that half of them
// are on either side.
constexpr int kGridSize = 8;
// Distance between them, in radii of the window: they reach nearly three.
constexpr float kGridStep = 0.8f;
// Differences in colour, the mean of the three channels' in grey levels, at
// which a weight falls to 1 / e.
constexpr float kColorSpread = 10;
// Sum of the weights up to which too few have the pixel's colour: if all of the
// grid have it, it is 64.
constexpr float kMinWeight = 4;

// 1 within `radius` pixels of texture, 0 elsewhere.
Map<uint8_t> FindNearTexture(const Map<float>& textureness, int radius) {
  Map<uint8_t> textured(textureness.width(), textureness.height());
  for (size_t i = 0; i < textured.size(); ++i) {
    textured.data()[i] = textureness.data()[i] > kTextured;
  }
  cv::Mat mat(textured.height(), textured.width(), CV_8U, textured.data());
  const int size = 2 * radius + 1;
  cv::dilate(mat, mat,
             cv::getStructuringElement(cv::MORPH_ELLIPSE, {size, size}));
  return textured;
}

// Weights by the sum of the differences of the three channels.
std::vector<float> ColorWeights() {
  std::vector<float> weights;
  for (int difference = 0; difference <= 3 * 255; ++difference) {
    weights.push_back(
        std::exp(-static_cast<float>(difference) / (3 * kColorSpread)));
  }
  return weights;
}

int ColorDifference(const Rgb& a, const Rgb& b) {
  return std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b);
}

// What a pixel around says: its plane on the ray of the one that asks.
struct Opinion {
  DepthNormal plane;
  float weight;
};

// Weight of those within the tolerance of this depth.
float WeightNear(const std::vector<Opinion>& opinions, float depth,
                 float relative_tolerance) {
  float weight = 0;
  for (const Opinion& opinion : opinions) {
    if (std::abs(opinion.plane.depth - depth) <= relative_tolerance * depth) {
      weight += opinion.weight;
    }
  }
  return weight;
}

// total: sum of the weights.
DepthNormal WeightedMedian(float total, std::vector<Opinion>* opinions) {
  std::sort(opinions->begin(), opinions->end(),
            [](const Opinion& a, const Opinion& b) {
              return a.plane.depth < b.plane.depth;
            });
  float below = 0;
  for (const Opinion& opinion : *opinions) {
    below += opinion.weight;
    if (below >= 0.5f * total) {
      return opinion.plane;
    }
  }
  return DepthNormal();
}

class SilhouetteMender {
 public:
  SilhouetteMender(const Options& options, const Problem& problem,
                   const RefCamera& camera, const Map<Rgb>& color,
                   const Map<uint8_t>& near_texture, const Map<float>& depth,
                   const Map<Vec3>& normal)
      : tolerance_(static_cast<float>(options.tapa.relative_plane_distance)),
        step_(std::max(1, static_cast<int>(
                              std::lround(kGridStep * options.window_radius)))),
        problem_(problem),
        camera_(camera),
        color_(color),
        color_weights_(ColorWeights()),
        near_texture_(near_texture),
        depth_(depth),
        normal_(normal) {}

  // What the estimate of a pixel near texture should be, if it is another one.
  std::optional<DepthNormal> Mend(int row, int col) {
    Ask(row, col, camera_.Ray(row, col));
    float total = 0;
    for (const Opinion& opinion : opinions_) {
      total += opinion.weight;
    }
    const float enough = kMinShare * total;
    if (!(total > kMinWeight) ||
        WeightNear(opinions_, depth_.At(row, col), tolerance_) >= enough) {
      return std::nullopt;
    }
    const DepthNormal median = WeightedMedian(total, &opinions_);
    if (WeightNear(opinions_, median.depth, tolerance_) < enough) {
      return std::nullopt;
    }
    return median;
  }

 private:
  void Ask(int row, int col, const Vec3& ray) {
    opinions_.clear();
    for (int i = 0; i < kGridSize; ++i) {
      for (int j = 0; j < kGridSize; ++j) {
        const int y = row + (2 * i - kGridSize + 1) * step_ / 2;
        const int x = col + (2 * j - kGridSize + 1) * step_ / 2;
        if (y >= 0 && x >= 0 && y < depth_.height() && x < depth_.width() &&
            near_texture_.At(y, x) == 0 && IsDepth(depth_.At(y, x))) {
          AddOpinion(y, x, color_.At(row, col), ray);
        }
      }
    }
  }

  void AddOpinion(int row, int col, const Rgb& color, const Vec3& ray) {
    const DepthNormal estimate = {depth_.At(row, col), normal_.At(row, col)};
    const float depth = PropagateDepth(estimate, camera_.Ray(row, col), ray);
    if (Dot(estimate.normal, ray) < 0 && depth >= problem_.depth_min &&
        depth <= problem_.depth_max) {
      opinions_.push_back(
          {{depth, estimate.normal},
           color_weights_[ColorDifference(color, color_.At(row, col))]});
    }
  }

  const float tolerance_;
  const int step_;
  const Problem& problem_;
  const RefCamera& camera_;
  const Map<Rgb>& color_;
  const std::vector<float> color_weights_;
  const Map<uint8_t>& near_texture_;
  const Map<float>& depth_;
  const Map<Vec3>& normal_;
  std::vector<Opinion> opinions_;
};

}  // namespace

void MendSilhouettes(const Options& options, const Problem& problem,
                     const Control& control, const RefCamera& camera,
                     const Map<Rgb>& color, const Map<float>& textureness,
                     Map<float>* depth, Map<Vec3>* normal,
                     Map<uint8_t>* origin) {
  const Map<uint8_t> near_texture =
      FindNearTexture(textureness, options.window_radius);
  SilhouetteMender mender(options, problem, camera, color, near_texture, *depth,
                          *normal);
  for (int row = 0; row < depth->height() && !control.IsStopped(); ++row) {
    for (int col = 0; col < depth->width(); ++col) {
      if (near_texture.At(row, col) == 0 || !IsDepth(depth->At(row, col))) {
        continue;
      }
      // Those who are asked are not mended, so the order does not matter.
      if (const auto mended = mender.Mend(row, col)) {
        depth->At(row, col) = mended->depth;
        normal->At(row, col) = mended->normal;
        origin->At(row, col) = kFromPlane;
      }
    }
  }
}

}  // namespace tapa
