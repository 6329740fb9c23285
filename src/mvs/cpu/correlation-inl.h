// Bilaterally weighted normalized cross correlation of a reference patch with a
// source image, compiled once for every instruction set (see Highway's
// documentation of foreach_target.h).

#if defined(TAPA_SRC_MVS_CPU_CORRELATION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TAPA_SRC_MVS_CPU_CORRELATION_INL_H_
#undef TAPA_SRC_MVS_CPU_CORRELATION_INL_H_
#else
#define TAPA_SRC_MVS_CPU_CORRELATION_INL_H_
#endif

#include <hwy/highway.h>

#include <cmath>
#include <cstring>

#include "src/mvs/cpu/source_image.h"
#include "src/mvs/cpu/window.h"
#include "src/mvs/sweep/correlation.h"
#include "src/mvs/sweep/source_cameras.h"

HWY_BEFORE_NAMESPACE();
namespace tapa {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// At most 16 floats, which is what Window pads for.
using FloatTag = hn::CappedTag<float, 16>;
using FloatVec = hn::Vec<FloatTag>;
using IntTag = hn::RebindToSigned<FloatTag>;

// Reads the intensities of some samples of the patch around a pixel.
HWY_INLINE void LoadIntensities(const RefImage& image, const uint8_t* pixel,
                                int begin, int end, Patch* patch) {
  const FloatTag d;
  const IntTag di;
  const auto byte = hn::Set(di, 255);
  for (int i = begin; i < end; i += static_cast<int>(hn::Lanes(d))) {
    const auto intensity = hn::And(
        byte, hn::GatherOffset(di, reinterpret_cast<const int32_t*>(pixel),
                               hn::Load(di, image.offsets() + i)));
    hn::Store(hn::ConvertTo(d, intensity), d,
              patch->weighted_intensity.get() + i);
  }
}

// The share of sigma_textured in the weights (WindowShape) of a patch whose
// near samples have their intensities.
HWY_INLINE float TexturedShare(const Window& window, float center_intensity,
                               const Patch& patch) {
  const FloatTag d;
  const FloatVec center = hn::Set(d, center_intensity);
  FloatVec weight_sum = hn::Zero(d);
  FloatVec sum = hn::Zero(d);
  FloatVec squared_sum = hn::Zero(d);
  for (int i = 0; i < window.padded_near_samples;
       i += static_cast<int>(hn::Lanes(d))) {
    // Less the centre's, so that small variances of bright patches are not lost
    // to rounding.
    const FloatVec difference =
        hn::Sub(hn::Load(d, patch.weighted_intensity.get() + i), center);
    const FloatVec weight = hn::Load(d, window.textured_weight.get() + i);
    const FloatVec weighted = hn::Mul(weight, difference);
    weight_sum = hn::Add(weight_sum, weight);
    sum = hn::Add(sum, weighted);
    squared_sum = hn::MulAdd(weighted, difference, squared_sum);
  }
  const float inv_weight = 1.0f / hn::GetLane(hn::SumOfLanes(d, weight_sum));
  const float mean = inv_weight * hn::GetLane(hn::SumOfLanes(d, sum));
  const float variance =
      inv_weight * hn::GetLane(hn::SumOfLanes(d, squared_sum)) - mean * mean;
  return WindowShape::Texture(HWY_MAX(variance, 0.0f));
}

// Prepares the patch around a pixel of the reference image.
HWY_INLINE void LoadPatch(const Window& window, const RefImage& image, int row,
                          int col, Patch* patch) {
  const FloatTag d;
  const IntTag di;
  const int lanes = static_cast<int>(hn::Lanes(d));

  const uint8_t* pixel = image.At(row, col);
  LoadIntensities(image, pixel, 0, window.padded_near_samples, patch);
  const float share = TexturedShare(window, *pixel, *patch);
  patch->padded_samples = window.padded_near_samples;
  if (share < 1.0f) {
    patch->padded_samples = window.padded_samples;
    LoadIntensities(image, pixel, window.padded_near_samples,
                    window.padded_samples, patch);
  }
  const FloatVec texture = hn::Set(d, share);
  const FloatVec center = hn::Set(d, *pixel);
  FloatVec weight_sum = hn::Zero(d);
  FloatVec sum = hn::Zero(d);
  for (int i = 0; i < patch->padded_samples; i += lanes) {
    const FloatVec value = hn::Load(d, patch->weighted_intensity.get() + i);
    const auto difference = hn::ConvertTo(di, hn::Abs(hn::Sub(value, center)));
    const FloatVec plain = hn::Load(d, window.spatial_weight.get() + i);
    const FloatVec textured = hn::Load(d, window.textured_weight.get() + i);
    const FloatVec weight =
        hn::Mul(hn::MulAdd(texture, hn::Sub(textured, plain), plain),
                hn::GatherIndex(d, window.color_weight.get(), difference));
    hn::Store(weight, d, patch->weight.get() + i);
    weight_sum = hn::Add(weight_sum, weight);
    sum = hn::MulAdd(weight, value, sum);
  }
  const float inv_weight = 1.0f / hn::GetLane(hn::SumOfLanes(d, weight_sum));
  patch->mean = inv_weight * hn::GetLane(hn::SumOfLanes(d, sum));

  const FloatVec scale = hn::Set(d, inv_weight);
  const FloatVec mean = hn::Set(d, patch->mean);
  FloatVec variance = hn::Zero(d);
  for (int i = 0; i < patch->padded_samples; i += lanes) {
    const FloatVec intensity = hn::Load(d, patch->weighted_intensity.get() + i);
    const FloatVec weight =
        hn::Mul(scale, hn::Load(d, patch->weight.get() + i));
    const FloatVec centered = hn::Sub(intensity, mean);
    const FloatVec weighted = hn::Mul(weight, centered);
    hn::Store(weight, d, patch->weight.get() + i);
    hn::Store(weighted, d, patch->weighted_intensity.get() + i);
    variance = hn::MulAdd(weighted, centered, variance);
  }
  patch->variance = hn::GetLane(hn::SumOfLanes(d, variance));
}

// 1 / x to nearly float precision.
HWY_INLINE FloatVec Reciprocal(FloatVec x) {
  const FloatTag d;
  const FloatVec two = hn::Set(d, 2.0f);
  FloatVec inverse = hn::ApproximateReciprocal(x);
#if HWY_ARCH_ARM
  // Arm's first guess has 8 bits, x86's 11 or more.
  inverse = hn::Mul(inverse, hn::NegMulAdd(x, inverse, two));
#endif
  return hn::Mul(inverse, hn::NegMulAdd(x, inverse, two));
}

// Places of the window's samples in the source image, in SourceImage's
// coordinates, as homogeneous coordinates.
struct SampleGrid {
  FloatVec x, y, z;
  FloatVec step_x_x, step_x_y, step_x_z;
  FloatVec step_y_x, step_y_y, step_y_z;
};

// Bilinear samples at (u, v) less `mean`.
HWY_INLINE FloatVec SampleBilinear(const SourceImage& source, FloatVec u,
                                   FloatVec v, FloatVec mean) {
  const FloatTag d;
  const IntTag di;
  const auto col = hn::ConvertTo(di, u);
  const auto row = hn::ConvertTo(di, v);
  const FloatVec fraction_u = hn::Sub(u, hn::ConvertTo(d, col));
  const FloatVec fraction_v = hn::Sub(v, hn::ConvertTo(d, row));
  const auto stride =
      hn::Set(di, static_cast<int32_t>(sizeof(uint16_t)) * source.stride());
  const auto offset = hn::Add(hn::Mul(row, stride), hn::Add(col, col));
  const auto quad = hn::GatherOffset(
      di, reinterpret_cast<const int32_t*>(source.data()), offset);

  const auto byte = hn::Set(di, 255);
  const FloatVec top_left = hn::ConvertTo(d, hn::And(quad, byte));
  const FloatVec bottom_left =
      hn::ConvertTo(d, hn::And(hn::ShiftRight<8>(quad), byte));
  const FloatVec top_right =
      hn::ConvertTo(d, hn::And(hn::ShiftRight<16>(quad), byte));
  const FloatVec bottom_right = hn::ConvertTo(
      d, hn::BitCast(di, hn::ShiftRight<24>(hn::BitCast(
                             hn::RebindToUnsigned<IntTag>(), quad))));
  const FloatVec top =
      hn::MulAdd(fraction_u, hn::Sub(top_right, top_left), top_left);
  const FloatVec bottom =
      hn::MulAdd(fraction_u, hn::Sub(bottom_right, bottom_left), bottom_left);
  return hn::MulAdd(fraction_v, hn::Sub(bottom, top), hn::Sub(top, mean));
}

// With kInside all samples are known to lie inside the image's border.
template <bool kInside>
HWY_INLINE Moments SumSamples(const Window& window, const Patch& patch,
                              const SourceImage& source,
                              const SampleGrid& grid) {
  const FloatTag d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const FloatVec mean = hn::Set(d, patch.mean);
  FloatVec sum = hn::Zero(d);
  FloatVec squared_sum = hn::Zero(d);
  FloatVec product_sum = hn::Zero(d);
  for (int i = 0; i < patch.padded_samples; i += lanes) {
    const FloatVec dx = hn::Load(d, window.dx.get() + i);
    const FloatVec dy = hn::Load(d, window.dy.get() + i);
    const FloatVec x =
        hn::MulAdd(dx, grid.step_x_x, hn::MulAdd(dy, grid.step_y_x, grid.x));
    const FloatVec y =
        hn::MulAdd(dx, grid.step_x_y, hn::MulAdd(dy, grid.step_y_y, grid.y));
    const FloatVec z =
        hn::MulAdd(dx, grid.step_x_z, hn::MulAdd(dy, grid.step_y_z, grid.z));
    const FloatVec inv_z = Reciprocal(z);
    FloatVec u = hn::Mul(x, inv_z);
    FloatVec v = hn::Mul(y, inv_z);
    if (!kInside) {
      // Everything else, points behind the camera and NaN included, sees the
      // black border at the origin.
      const FloatVec zero = hn::Zero(d);
      const FloatVec max_u = hn::Set(d, source.width() + 1.0f);
      const FloatVec max_v = hn::Set(d, source.height() + 1.0f);
      const auto inside = hn::And(
          hn::Gt(z, zero), hn::And(hn::And(hn::Ge(u, zero), hn::Le(u, max_u)),
                                   hn::And(hn::Ge(v, zero), hn::Le(v, max_v))));
      u = hn::IfThenElseZero(inside, u);
      v = hn::IfThenElseZero(inside, v);
    }
    const FloatVec sample = SampleBilinear(source, u, v, mean);
    const FloatVec weighted =
        hn::Mul(hn::Load(d, patch.weight.get() + i), sample);
    sum = hn::Add(sum, weighted);
    squared_sum = hn::MulAdd(weighted, sample, squared_sum);
    product_sum = hn::MulAdd(hn::Load(d, patch.weighted_intensity.get() + i),
                             sample, product_sum);
  }
  return {hn::GetLane(hn::SumOfLanes(d, sum)),
          hn::GetLane(hn::SumOfLanes(d, squared_sum)),
          hn::GetLane(hn::SumOfLanes(d, product_sum))};
}

// Whether the whole window lies in front of the camera and inside the image. A
// homography without a horizon between them keeps straight lines straight, so
// the corners tell; that every corner is on the right side of a border is one
// condition on a linear function.
HWY_INLINE bool WindowIsInside(const Window& window, const SourceImage& source,
                               const Warp& warp) {
  const float r = static_cast<float>(window.radius);
  const auto smallest = [r](float origin, float step_x, float step_y) {
    return origin - r * (std::fabs(step_x) + std::fabs(step_y));
  };
  const Vec3& o = warp.origin;
  const Vec3& x = warp.step_x;
  const Vec3& y = warp.step_y;
  const float w = static_cast<float>(source.width());
  const float h = static_cast<float>(source.height());
  return (smallest(o.z, x.z, y.z) > 0.0f) & (smallest(o.x, x.x, y.x) >= 0.0f) &
         (smallest(o.y, x.y, y.y) >= 0.0f) &
         (smallest(w * o.z - o.x, w * x.z - x.x, w * y.z - y.x) >= 0.0f) &
         (smallest(h * o.z - o.y, h * x.z - x.y, h * y.z - y.y) >= 0.0f);
}

// 1 - NCC of the patch with its image in the source view, 0 to 2; 2 where
// either has too little texture to tell. Not inlined, for it is called from the
// code that all instruction sets share.
HWY_NOINLINE HWY_ATTR float CorrelationCost(const Window& window,
                                            const Patch& patch,
                                            const SourceImage& source,
                                            const Warp& image_warp) {
  if (patch.variance < kMinVariance) {
    return kMaxCost;
  }
  // SourceImage counts pixels from its border.
  Warp warp = image_warp;
  for (Vec3* p : {&warp.origin, &warp.step_x, &warp.step_y}) {
    p->x += p->z;
    p->y += p->z;
  }
  const FloatTag d;
  const SampleGrid grid = {hn::Set(d, warp.origin.x), hn::Set(d, warp.origin.y),
                           hn::Set(d, warp.origin.z), hn::Set(d, warp.step_x.x),
                           hn::Set(d, warp.step_x.y), hn::Set(d, warp.step_x.z),
                           hn::Set(d, warp.step_y.x), hn::Set(d, warp.step_y.y),
                           hn::Set(d, warp.step_y.z)};
  const Moments moments = WindowIsInside(window, source, warp)
                              ? SumSamples<true>(window, patch, source, grid)
                              : SumSamples<false>(window, patch, source, grid);
  return CostOfMoments(patch.variance, moments);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace tapa
HWY_AFTER_NAMESPACE();

#endif  // TAPA_SRC_MVS_CPU_CORRELATION_INL_H_
