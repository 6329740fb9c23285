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

namespace tapa {
namespace {

// How far to ask, in radii of the window, and every how many pixels.
constexpr int kReach = 3;
constexpr int kStep = 4;
// Differences in colour, the mean of the three channels' in grey levels, at
// which a weight falls to 1 / e.
constexpr float kColorSpread = 10;
// Sum of the weights below which too few have the pixel's colour: with all of
// the same one it is 64.
constexpr float kMinWeight = 4;

// 1 within `radius` pixels of a textureness above this, 0 elsewhere.
Map<uint8_t> FindNearTexture(const Map<float>& textureness,
                             double min_textureness, int radius) {
  Map<uint8_t> textured(textureness.width(), textureness.height());
  for (size_t i = 0; i < textured.size(); ++i) {
    textured.data()[i] = textureness.data()[i] > min_textureness;
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

// Share of the weight of those within the tolerance of this depth.
float ShareNear(const std::vector<Opinion>& opinions, float depth,
                float relative_tolerance) {
  float near = 0;
  float total = 0;
  for (const Opinion& opinion : opinions) {
    total += opinion.weight;
    if (std::abs(opinion.plane.depth - depth) <= relative_tolerance * depth) {
      near += opinion.weight;
    }
  }
  return total > kMinWeight ? near / total : 0;
}

DepthNormal WeightedMedian(std::vector<Opinion>* opinions) {
  std::sort(opinions->begin(), opinions->end(),
            [](const Opinion& a, const Opinion& b) {
              return a.plane.depth < b.plane.depth;
            });
  float total = 0;
  for (const Opinion& opinion : *opinions) {
    total += opinion.weight;
  }
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
      : min_share_(static_cast<float>(options.tapa.completion_agreement)),
        tolerance_(static_cast<float>(options.tapa.relative_plane_distance)),
        reach_(kReach * options.window_radius),
        problem_(problem),
        camera_(camera),
        color_(color),
        color_weights_(ColorWeights()),
        near_texture_(near_texture),
        depth_(depth),
        normal_(normal) {}

  // What the estimate of a pixel near texture should be, if it is another one.
  std::optional<DepthNormal> Mend(int row, int col) {
    const Vec3 ray = camera_.Ray(row, col);
    Ask(row, col, ray);
    if (opinions_.empty() ||
        ShareNear(opinions_, depth_.At(row, col), tolerance_) >= min_share_) {
      return std::nullopt;
    }
    const DepthNormal median = WeightedMedian(&opinions_);
    if (ShareNear(opinions_, median.depth, tolerance_) < min_share_) {
      return std::nullopt;
    }
    return median;
  }

 private:
  void Ask(int row, int col, const Vec3& ray) {
    opinions_.clear();
    for (int y = row - reach_; y <= row + reach_; y += kStep) {
      for (int x = col - reach_; x <= col + reach_; x += kStep) {
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

  const float min_share_;
  const float tolerance_;
  const int reach_;
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
                     const RefCamera& camera, const Map<Rgb>& color,
                     const Map<float>& textureness, Map<float>* depth,
                     Map<Vec3>* normal, Map<uint8_t>* origin) {
  const Map<uint8_t> near_texture = FindNearTexture(
      textureness, options.tapa.completion_textureness, options.window_radius);
  SilhouetteMender mender(options, problem, camera, color, near_texture, *depth,
                          *normal);
  for (int row = 0; row < depth->height(); ++row) {
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
