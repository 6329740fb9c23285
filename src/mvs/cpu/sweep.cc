#include "src/mvs/cpu/sweep.h"

#include <algorithm>
#include <cstring>

#include "src/mvs/sweep/consistency_mask.h"
#include "src/mvs/sweep/line.h"
#include "src/mvs/sweep/sweep_pixel.h"

// Vectors whose size is not known to the compiler cannot be kept in structures,
// as correlation-inl.h does; Arm machines use NEON instead.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/mvs/cpu/sweep.cc"
// Clang-format must not move the next two lines.
// clang-format off
#include <hwy/foreach_target.h>
#include "src/mvs/cpu/correlation-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace tapa {
namespace HWY_NAMESPACE {

// The source views as the shared sweep sees them, at one pixel.
class Sources {
 public:
  Sources(const ProblemData& data, const Patch& patch, uint8_t* mask)
      : data_(data), patch_(patch), mask_(mask) {}

  float PatchVariance() const { return patch_.variance; }

  float Cost(int m, const Warp& warp) const {
    return CorrelationCost(data_.window, patch_, data_.sources[m], warp);
  }

  // Depth of the nearest pixel, 0 outside.
  float Depth(int m, const Projection& projection) const {
    const DepthView& depth = data_.source_depths[m];
    const float col = projection.col + 0.5f;
    const float row = projection.row + 0.5f;
    const bool inside = (col >= 0.0f) & (row >= 0.0f) & (col < depth.width) &
                        (row < depth.height);
    return inside ? depth.data[static_cast<size_t>(row) * depth.width +
                               static_cast<size_t>(col)]
                  : 0.0f;
  }

  void SetConsistent(int m, bool consistent) {
    mask_[m / 8] |= ConsistencyBit(m, consistent);
  }

 private:
  const ProblemData& data_;
  const Patch& patch_;
  uint8_t* mask_;
};

// Asks whether to continue once for a number of pixels that takes some
// milliseconds, however large the window and the number of views.
class PeriodicCheck {
 public:
  PeriodicCheck(const ProblemData& data, const ContinueCheck& should_continue)
      : should_continue_(should_continue) {
    constexpr double kSamplesPerCheck = 1e7;
    // At most: every hypothesis in every view.
    const double correlations =
        static_cast<double>(kNumHypotheses) * data.num_sources;
    interval_ = static_cast<int>(std::clamp(
        kSamplesPerCheck / (correlations * data.window.num_samples), 1.0, 1e6));
  }

  // To be called for every pixel. Returns whether to continue.
  bool AfterPixel() {
    return ++num_pixels_ % interval_ != 0 || should_continue_();
  }

 private:
  const ContinueCheck& should_continue_;
  int interval_;
  int num_pixels_ = 0;
};

HWY_ATTR void DecodeCosts(const uint16_t* HWY_RESTRICT codes, int count,
                          int padded_count, float* HWY_RESTRICT costs) {
  for (int m = 0; m < count; ++m) {
    costs[m] = DecodeCost(codes[m]);
  }
  for (int m = count; m < padded_count; ++m) {
    costs[m] = kMaxCost;
  }
}

// Messages from the end of the line to every pixel on it.
HWY_ATTR void ComputeBackwardMessages(const ProblemData& data,
                                      const SourceCameras& views,
                                      const SweepParams& params,
                                      const SweepLine& line,
                                      const SweepState& state,
                                      SweepScratch* scratch) {
  const int padded_count = views.padded_count;
  float* HWY_RESTRICT cost = scratch->pixel.cost;
  float* HWY_RESTRICT message = scratch->pixel.forward;
  for (int m = 0; m < padded_count; ++m) {
    message[m] = ViewSelection::kBorderMessage;
  }
  for (int i = line.length - 1; i >= 0; --i) {
    const size_t pixel = data.Pixel(line.Row(i), line.Col(i));
    DecodeCosts(state.cost.data() + pixel * views.count, views.count,
                padded_count, cost);
    float* HWY_RESTRICT backward =
        scratch->backward.get() + static_cast<size_t>(i) * padded_count;
    for (int m = 0; m < padded_count; ++m) {
      message[m] = ViewSelection::Backward(params.selection.Emission(cost[m]),
                                           message[m]);
      backward[m] = message[m];
    }
  }
}

HWY_ATTR void LoadPixel(const SweepState& state, size_t pixel,
                        const SourceCameras& views, const PixelScratch& s) {
  DecodeCosts(state.cost.data() + pixel * views.count, views.count,
              views.padded_count, s.cost);
  const uint16_t* HWY_RESTRICT prob = state.prob.data() + pixel * views.count;
  float* HWY_RESTRICT to = s.prob;
  for (int m = 0; m < views.count; ++m) {
    to[m] = DecodeProb(prob[m]);
  }
  for (int m = views.count; m < views.padded_count; ++m) {
    to[m] = 0.0f;
  }
}

HWY_ATTR void StorePixel(const PixelScratch& s, size_t pixel,
                         const SourceCameras& views, SweepState* state) {
  uint16_t* HWY_RESTRICT cost = state->cost.data() + pixel * views.count;
  uint16_t* HWY_RESTRICT prob = state->prob.data() + pixel * views.count;
  for (int m = 0; m < views.count; ++m) {
    cost[m] = EncodeCost(s.cost[m]);
    prob[m] = EncodeProb(s.prob[m]);
  }
}

// Writes the estimate of a pixel, or none where it is not consistent.
HWY_ATTR void StoreChoice(const Choice& choice, size_t pixel, uint8_t* mask,
                          int mask_bytes, SweepState* state) {
  if (!state->chosen.empty()) {
    state->chosen.data()[pixel] = static_cast<uint8_t>(choice.hypothesis);
  }
  if (choice.is_consistent) {
    state->depth.data()[pixel] = choice.estimate.depth;
    state->normal.data()[pixel] = choice.estimate.normal;
  } else {
    state->depth.data()[pixel] = 0;
    state->normal.data()[pixel] = Vec3();
    std::memset(mask, 0, mask_bytes);
  }
}

// Returns false if told to stop on the way.
HWY_ATTR bool SweepOneLine(const ProblemData& data, const SweepParams& params,
                           const SweepGuide<float>& guide,
                           const SweepLine& line, PeriodicCheck* check,
                           SweepState* state, SweepScratch* scratch) {
  const RefCamera camera = data.cameras.reference();
  const SourceCameras views = data.cameras.sources();
  const int mask_bytes = ConsistencyMaskBytes(views.count);
  PixelScratch s = scratch->pixel;

  ComputeBackwardMessages(data, views, params, line, *state, scratch);
  for (int m = 0; m < views.padded_count; ++m) {
    s.forward[m] = ViewSelection::kBorderMessage;
  }

  PreviousPixel previous = {state->At(data.Pixel(line.row, line.col)),
                            camera.Ray(line.row, line.col)};
  for (int i = 0; i < line.length; ++i) {
    const int row = line.Row(i);
    const int col = line.Col(i);
    const size_t pixel = data.Pixel(row, col);
    LoadPatch(data.window, data.reference, row, col, &scratch->patch);
    LoadPixel(*state, pixel, views, s);
    s.backward =
        scratch->backward.get() + static_cast<size_t>(i) * views.padded_count;

    uint8_t* mask = params.check_consistency
                        ? state->consistent.data() + pixel * mask_bytes
                        : nullptr;
    Sources sources(data, scratch->patch, mask);
    const Vec3 ray = camera.Ray(row, col);
    const PixelContext context = {params,
                                  camera,
                                  views,
                                  s,
                                  static_cast<float>(row),
                                  static_cast<float>(col),
                                  ray,
                                  Random(params.seed, pixel, params.index),
                                  state->At(pixel),
                                  guide.At(pixel, ray, params.try_planes)};
    const Choice choice = SweepPixel<SerialLanes>(context, previous, sources);
    StorePixel(s, pixel, views, state);
    StoreChoice(choice, pixel, mask, mask_bytes, state);
    previous = {choice.estimate, ray};
    if (!check->AfterPixel()) {
      return false;
    }
  }
  return true;
}

void SweepLinesImpl(const ProblemData& data, const SweepParams& params,
                    const SweepGuide<float>& guide, int begin, int end,
                    const ContinueCheck& should_continue, SweepState* state,
                    SweepScratch* scratch) {
  PeriodicCheck check(data, should_continue);
  for (int index = begin; index < end; ++index) {
    const SweepLine line =
        LineOf(params.SweepDirection(), index, data.width, data.height);
    // Masked pixels cut it into lines of their own.
    const auto is_masked = [&](int i) {
      return state->IsMasked(data.Pixel(line.Row(i), line.Col(i)));
    };
    for (int first = 0, last = 0; first < line.length; first = last + 1) {
      for (last = first; last < line.length && !is_masked(last);) {
        ++last;
      }
      const SweepLine part = {line.Row(first), line.Col(first), line.row_step,
                              line.col_step, last - first};
      if (last > first &&
          !SweepOneLine(data, params, guide, part, &check, state, scratch)) {
        return;
      }
    }
  }
}

HWY_ATTR void ComputeCostsImpl(const ProblemData& data, int begin, int end,
                               const ContinueCheck& should_continue,
                               SweepState* state, SweepScratch* scratch) {
  PeriodicCheck check(data, should_continue);
  const RefCamera camera = data.cameras.reference();
  const SourceCameras views = data.cameras.sources();
  for (int row = begin; row < end; ++row) {
    for (int col = 0; col < data.width; ++col) {
      const size_t pixel = data.Pixel(row, col);
      const size_t first = pixel * views.count;
      uint16_t* cost = state->cost.data() + first;
      uint16_t* prob = state->prob.data() + first;
      if (state->IsMasked(pixel)) {
        std::fill_n(cost, views.count, uint16_t{0});
        std::fill_n(prob, views.count, uint16_t{0});
        continue;
      }
      const Vec3 h =
          HomographyVector(camera, state->At(pixel), camera.Ray(row, col));
      LoadPatch(data.window, data.reference, row, col, &scratch->patch);
      std::fill_n(prob, views.count, EncodeProb(0.5f));
      for (int m = 0; m < views.count; ++m) {
        cost[m] = EncodeCost(
            CorrelationCost(data.window, scratch->patch, data.sources[m],
                            ComputeWarp(views, m, row, col, h)));
      }
      if (!check.AfterPixel()) {
        return;
      }
    }
  }
}

HWY_ATTR void PreparePatchImpl(const ProblemData& data, int row, int col,
                               Patch* patch) {
  LoadPatch(data.window, data.reference, row, col, patch);
}

float CostImpl(const ProblemData& data, const Patch& patch, const Warp& warp,
               int m) {
  return CorrelationCost(data.window, patch, data.sources[m], warp);
}

const char* InstructionSetImpl() { return hwy::TargetName(HWY_TARGET); }

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace tapa
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tapa {

HWY_EXPORT(SweepLinesImpl);
HWY_EXPORT(ComputeCostsImpl);
HWY_EXPORT(PreparePatchImpl);
HWY_EXPORT(CostImpl);
HWY_EXPORT(InstructionSetImpl);

namespace {

// Arrays over the views in PixelScratch: cost, prob, forward, cdf, num_drawn,
// source_depth, the hypotheses' costs and the geometric ones.
constexpr int kNumScratchArrays = 6 + kNumHypotheses + kNumDepths;

}  // namespace

SweepScratch::SweepScratch(const ProblemData& data) : patch(data.window) {
  const SourceCameras views = data.cameras.sources();
  const size_t count = views.padded_count;
  backward = MakeAligned<float>(std::max(data.width, data.height) * count);
  arrays_ = MakeAligned<float>(kNumScratchArrays * count);
  order_.resize(count);
  projection_.resize(count);

  float* next = arrays_.get();
  const auto take = [&](int num_arrays) {
    float* arrays = next;
    next += num_arrays * count;
    return arrays;
  };
  pixel = PixelScratch();
  for (float** array : {&pixel.cost, &pixel.prob, &pixel.forward, &pixel.cdf,
                        &pixel.num_drawn, &pixel.source_depth}) {
    *array = take(1);
  }
  pixel.hypothesis_cost = take(kNumHypotheses);
  pixel.geom_cost = take(kNumDepths);
  pixel.stride = views.padded_count;
  pixel.order = order_.data();
  pixel.projection = projection_.data();
  pixel.uniform = uniform_.data();
  pixel.hypothesis = hypotheses_.data();
  pixel.homography = homographies_.data();
  pixel.sum = sums_.data();
}

void SweepLines(const ProblemData& data, const SweepParams& params,
                const SweepGuide<float>& guide, int begin, int end,
                const ContinueCheck& should_continue, SweepState* state,
                SweepScratch* scratch) {
  HWY_DYNAMIC_DISPATCH(SweepLinesImpl)
  (data, params, guide, begin, end, should_continue, state, scratch);
}

void ComputeCosts(const ProblemData& data, int begin, int end,
                  const ContinueCheck& should_continue, SweepState* state,
                  SweepScratch* scratch) {
  HWY_DYNAMIC_DISPATCH(ComputeCostsImpl)
  (data, begin, end, should_continue, state, scratch);
}

void PreparePatch(const ProblemData& data, int row, int col, Patch* patch) {
  HWY_DYNAMIC_DISPATCH(PreparePatchImpl)(data, row, col, patch);
}

float PhotometricCost(const ProblemData& data, const Patch& patch,
                      const Warp& warp, int m) {
  return HWY_DYNAMIC_DISPATCH(CostImpl)(data, patch, warp, m);
}

const char* InstructionSet() {
  return HWY_DYNAMIC_DISPATCH(InstructionSetImpl)();
}

}  // namespace tapa
#endif  // HWY_ONCE
