#ifndef TAPA_SRC_MVS_CUDA_LAYOUT_H_
#define TAPA_SRC_MVS_CUDA_LAYOUT_H_

#include "src/mvs/sweep/host_device.h"
#include "src/mvs/sweep/hypotheses.h"
#include "src/mvs/sweep/pixel_scratch.h"
#include "src/mvs/window_shape.h"

namespace tapa {

// Sizes that a kernel knows when it is compiled, so that addresses in the
// scratch become constants and loops over the window are unrolled.

// Most problems: a window of 6 by 6 samples without its corners, every second
// of 11 pixels, and up to 32 views.
struct CommonSizes {
  static constexpr int kMaxViews = 32;
  static constexpr int kRowSamples = 6;
  static constexpr int kNumSamples = 32;
  // Of a lane, in a loop over the samples.
  static constexpr int kUnrolledSamples = 8;
  static TAPA_INLINE int RowSamples(const WindowShape&) { return kRowSamples; }
  static TAPA_INLINE int NumSamples(const WindowShape&) { return kNumSamples; }
  static TAPA_INLINE int Stride(int /*num_views*/) { return kMaxViews; }
  static bool Fits(const WindowShape& window, int num_views) {
    return window.row_samples == kRowSamples &&
           window.NumSamples() == kNumSamples && num_views <= kMaxViews;
  }
};

// All others.
struct AnySizes {
  static constexpr int kUnrolledSamples = 4;
  static TAPA_INLINE int RowSamples(const WindowShape& window) {
    return window.row_samples;
  }
  static TAPA_INLINE int NumSamples(const WindowShape& window) {
    return window.NumSamples();
  }
  static TAPA_INLINE int Stride(int num_views) { return (num_views + 3) & ~3; }
};

// A sample of the reference patch: its weight (all of them sum up to 1), the
// weight times (intensity - mean), and where it lies, in pixels from the
// patch's centre.
struct alignas(16) PatchSample {
  float weight;
  float weighted_intensity;
  float dx;
  float dy;
};
constexpr int kPatchSampleWords = sizeof(PatchSample) / 4;

// The samples of a patch with those without weight that fill the last group of
// lanes.
template <class Lanes, class Sizes>
TAPA_INLINE int PaddedNumSamples(const WindowShape& window) {
  return (Sizes::NumSamples(window) + Lanes::kGroupSize - 1) /
         Lanes::kGroupSize * Lanes::kGroupSize;
}

// The working memory of one pixel, in 4-byte words: the arrays of PixelScratch
// over the views and its others, the patch, and last those arrays over the
// views that only the geometric pass uses. It is kept small because the texture
// units' cache gets what blocks do not share.
constexpr int kViewArrays = 6 + kNumHypotheses - 1;
constexpr int kGeometricArrays = 3 + kNumDepths;
constexpr int kDepthNormalWords = sizeof(DepthNormal) / 4;
constexpr int kVec3Words = sizeof(Vec3) / 4;
constexpr int kFixedWords =
    kDrawBlock + kNumHypotheses * (kDepthNormalWords + kVec3Words + 1);
// Keeps what follows, the samples, aligned.
constexpr int kPaddedFixedWords = (kFixedWords + kPatchSampleWords - 1) /
                                  kPatchSampleWords * kPatchSampleWords;

// Of all but the geometric pass' arrays.
template <class Lanes, class Sizes>
TAPA_INLINE int CommonScratchWords(const WindowShape& window, int num_views) {
  return kViewArrays * Sizes::Stride(num_views) + kPaddedFixedWords +
         kPatchSampleWords * PaddedNumSamples<Lanes, Sizes>(window);
}

template <class Lanes, class Sizes>
TAPA_INLINE int ScratchWords(const WindowShape& window, int num_views,
                             bool geometric) {
  return CommonScratchWords<Lanes, Sizes>(window, num_views) +
         (geometric ? kGeometricArrays * Sizes::Stride(num_views) : 0);
}

// Lays out the scratch in `words`, which are aligned to 16 bytes. backward
// stays unset.
template <class Lanes, class Sizes>
TAPA_INLINE PixelScratch ArrangeScratch(const WindowShape& window,
                                        int num_views, float* words,
                                        PatchSample** patch) {
  const int stride = Sizes::Stride(num_views);
  PixelScratch s;
  s.cost = words;
  s.prob = words + stride;
  s.forward = words + 2 * stride;
  s.cdf = words + 3 * stride;
  s.num_drawn = words + 4 * stride;
  s.order = reinterpret_cast<int*>(words + 5 * stride);
  // The current estimate, hypothesis 0, has its costs in `cost`.
  static_assert(kCurrent == 0, "");
  s.hypothesis_cost = words + (6 - 1) * stride;
  s.stride = stride;
  float* fixed = words + kViewArrays * stride;
  s.uniform = fixed;
  s.sum = fixed + kDrawBlock;
  s.hypothesis = reinterpret_cast<DepthNormal*>(s.sum + kNumHypotheses);
  s.homography =
      reinterpret_cast<Vec3*>(s.sum + (1 + kDepthNormalWords) * kNumHypotheses);
  *patch = reinterpret_cast<PatchSample*>(fixed + kPaddedFixedWords);
  float* geometric =
      words + CommonScratchWords<Lanes, Sizes>(window, num_views);
  s.projection = reinterpret_cast<Projection*>(geometric);
  s.source_depth = geometric + 2 * stride;
  s.geom_cost = geometric + 3 * stride;
  s.backward = nullptr;
  return s;
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CUDA_LAYOUT_H_
