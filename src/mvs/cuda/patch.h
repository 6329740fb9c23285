#ifndef TAPA_SRC_MVS_CUDA_PATCH_H_
#define TAPA_SRC_MVS_CUDA_PATCH_H_

#include "src/mvs/cuda/layout.h"
#include "src/mvs/sweep/correlation.h"
#include "src/mvs/sweep/math.h"
#include "src/mvs/sweep/source_cameras.h"

// The code below takes `Textures`, what a kernel reads images through (see
// device_textures.h; tests have their own on the host):
//
//   float Reference(col, row)    intensity of a pixel, 0 to 255, 0 outside
//   float Source(m, x, y)        of source view m, bilinear, 0 outside; pixel
//                                centres are at integers plus one half
//   float SourceDepth(m, x, y)   depth of the pixel that the place is in, 0
//                                outside

namespace tapa {

// The reference patch: its samples are in the scratch.
struct PatchStatistics {
  float mean;
  float variance;
};

// Reads the intensities of the patch around a pixel, with the weights of
// sigma_textured. Returns the share of those in its weights (WindowShape).
template <class Lanes, class Sizes, class Textures>
TAPA_INLINE float LoadIntensities(const WindowShape& window,
                                  const Textures& textures, int row, int col,
                                  float center, PatchSample* samples) {
  float weight_sum = 0.0f;
  float sum = 0.0f;
  float squared_sum = 0.0f;
  TAPA_UNROLL(1)
  for (int i = Lanes::First(); i < Sizes::NumSamples(window);
       i += Lanes::Step()) {
    const int place = window.PlaceOfSample(i);
    const int row_samples = Sizes::RowSamples(window);
    const int dx = place % row_samples * window.step - window.radius;
    const int dy = place / row_samples * window.step - window.radius;
    const float intensity = textures.Reference(col + dx, row + dy);
    // Less the centre's, so that small variances of bright patches are not lost
    // to rounding.
    const float difference = intensity - center;
    const float weight =
        window.IsNear(dx, dy)
            ? ExpNegative(window.textured_scale *
                          static_cast<float>(dx * dx + dy * dy))
            : 0.0f;
    samples[i] = {weight, intensity, static_cast<float>(dx),
                  static_cast<float>(dy)};
    weight_sum += weight;
    sum += weight * difference;
    squared_sum += weight * difference * difference;
  }
  const float inv_weight = 1.0f / Lanes::Sum(weight_sum);
  const float mean = inv_weight * Lanes::Sum(sum);
  const float variance = inv_weight * Lanes::Sum(squared_sum) - mean * mean;
  return WindowShape::Texture(fmaxf(variance, 0.0f));
}

// Loads the patch around a pixel with its weights.
template <class Lanes, class Sizes, class Textures>
TAPA_INLINE PatchStatistics LoadPatch(const WindowShape& window,
                                      const Textures& textures, int row,
                                      int col, PatchSample* samples) {
  const int count = Sizes::NumSamples(window);
  const int padded_count = PaddedNumSamples<Lanes, Sizes>(window);
  const float center = textures.Reference(col, row);
  const float texture = LoadIntensities<Lanes, Sizes>(window, textures, row,
                                                      col, center, samples);
  float weight_sum = 0.0f;
  float sum = 0.0f;
  for (int i = Lanes::First(); i < padded_count; i += Lanes::Step()) {
    if (i >= count) {
      samples[i] = {0.0f, 0.0f, 0.0f, 0.0f};
      continue;
    }
    const PatchSample sample = samples[i];
    const float intensity = sample.weighted_intensity;
    const float difference = intensity - center;
    const float plain = ExpNegative(
        window.spatial_scale * (sample.dx * sample.dx + sample.dy * sample.dy));
    const float weight =
        (plain + texture * (sample.weight - plain)) *
        ExpNegative(window.color_scale * difference * difference);
    samples[i].weight = weight;
    weight_sum += weight;
    sum += weight * intensity;
  }
  const float inv_weight = 1.0f / Lanes::Sum(weight_sum);
  const float mean = inv_weight * Lanes::Sum(sum);
  float variance = 0.0f;
  for (int i = Lanes::First(); i < padded_count; i += Lanes::Step()) {
    const float centered = samples[i].weighted_intensity - mean;
    const float weight = inv_weight * samples[i].weight;
    samples[i].weight = weight;
    samples[i].weighted_intensity = weight * centered;
    variance += weight * centered * centered;
  }
  variance = Lanes::Sum(variance);
  Lanes::Sync();
  return {mean, variance};
}

// A group's lane's share of the sums over the window. kInFront: all samples are
// known to lie in front of the source camera.
template <class Lanes, class Sizes, bool kInFront, class Textures>
TAPA_INLINE Moments SumSamples(const WindowShape& window,
                               const Textures& textures, int m,
                               const Warp& warp, float mean,
                               const PatchSample* samples) {
  constexpr float kOutside = -2.0f;
  const int count = PaddedNumSamples<Lanes, Sizes>(window);
  Moments moments = {0.0f, 0.0f, 0.0f};
  // Windows behind a camera are rare: their code stays small.
  TAPA_UNROLL((kInFront ? Sizes::kUnrolledSamples : 1))
  for (int i = 0; i < count; i += Lanes::kGroupSize) {
    const PatchSample patch = samples[i + Lanes::GroupLane()];
    const Vec3 p = warp.At(patch.dx, patch.dy);
    const float inv_z = Reciprocal(p.z);
    float u = p.x * inv_z;
    float v = p.y * inv_z;
    if (!kInFront) {
      // Also NaN.
      u = p.z > 0.0f && u > kOutside ? u : kOutside;
      v = v > kOutside ? v : kOutside;
    }
    const float sample = textures.Source(m, u, v) - mean;
    const float weighted = patch.weight * sample;
    moments.sum += weighted;
    moments.squared_sum += weighted * sample;
    moments.product_sum += patch.weighted_intensity * sample;
  }
  return moments;
}

// Whether the whole window lies in front of the source camera.
TAPA_INLINE bool WindowIsInFront(const Warp& warp, float radius) {
  // The depth is linear over the window, so its smallest value is in a corner.
  return warp.origin.z > radius * (fabsf(warp.step_x.z) + fabsf(warp.step_y.z));
}

// The source views as SweepPixel sees them, at one pixel. Cost() is called by
// all lanes together, everything else by single lanes.
template <class Lanes, class Sizes, class Textures>
class PixelSources {
 public:
  // consistent: one element per view, for SetConsistent.
  TAPA_INLINE PixelSources(const WindowShape& window, const Textures& textures,
                           const PatchSample* samples,
                           const PatchStatistics& patch, float* consistent)
      : window_(window),
        textures_(textures),
        samples_(samples),
        patch_(patch),
        consistent_(consistent) {}

  TAPA_INLINE float PatchVariance() const { return patch_.variance; }

  TAPA_INLINE float Cost(int m, const Warp& image_warp) const {
    if (!(patch_.variance >= kMinVariance)) {
      return kMaxCost;
    }
    // Textures have the centre of the first pixel at one half.
    Warp warp = image_warp;
    warp.origin.x += 0.5f * warp.origin.z;
    warp.origin.y += 0.5f * warp.origin.z;
    warp.step_x.x += 0.5f * warp.step_x.z;
    warp.step_x.y += 0.5f * warp.step_x.z;
    warp.step_y.x += 0.5f * warp.step_y.z;
    warp.step_y.y += 0.5f * warp.step_y.z;
    Moments moments =
        WindowIsInFront(warp, static_cast<float>(window_.radius))
            ? SumSamples<Lanes, Sizes, true>(window_, textures_, m, warp,
                                             patch_.mean, samples_)
            : SumSamples<Lanes, Sizes, false>(window_, textures_, m, warp,
                                              patch_.mean, samples_);
    moments.sum = Lanes::GroupSum(moments.sum);
    moments.squared_sum = Lanes::GroupSum(moments.squared_sum);
    moments.product_sum = Lanes::GroupSum(moments.product_sum);
    return CostOfMoments(patch_.variance, moments);
  }

  TAPA_INLINE float Depth(int m, const Projection& projection) const {
    return textures_.SourceDepth(m, projection.col + 0.5f,
                                 projection.row + 0.5f);
  }

  TAPA_INLINE void SetConsistent(int m, bool consistent) {
    consistent_[m] = consistent ? 1.0f : 0.0f;
  }

 private:
  const WindowShape& window_;
  const Textures& textures_;
  const PatchSample* samples_;
  PatchStatistics patch_;
  float* consistent_;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CUDA_PATCH_H_
