#include "src/mvs/cpu/sweep.h"

#include <algorithm>
#include <cstring>

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
  Sources(const ProblemData& data, const Patch& patch, uint8_t* consistent)
      : data_(data), patch_(patch), consistent_(consistent) {}

  float Cost(int m, const Warp& warp) const {
    return CorrelationCost(data_.window, patch_, data_.sources[m], warp);
  }

  // Depth of the nearest pixel, 0 outside.
  float Depth(int m, const Projection& projection) const {
    const Map<float>& depth = *data_.source_depths[m];
    const float col = projection.col + 0.5f;
    const float row = projection.row + 0.5f;
    const bool inside = (col >= 0.0f) & (row >= 0.0f) & (col < depth.width()) &
                        (row < depth.height());
    return inside ? depth.At(static_cast<int>(row), static_cast<int>(col))
                  : 0.0f;
  }

  void SetConsistent(int m, bool consistent) {
    consistent_[m / 8] |= static_cast<uint8_t>(consistent) << (m % 8);
  }

 private:
  const ProblemData& data_;
  const Patch& patch_;
  uint8_t* consistent_;
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

// Pixels of a line in the order of the sweep.
struct Line {
  int row;
  int col;
  int row_step;
  int col_step;
  int length;
};

Line MakeLine(const ProblemData& data, Direction direction, int index) {
  switch (direction) {
    case Direction::kDown:
      return {0, index, 1, 0, data.height};
    case Direction::kLeft:
      return {index, data.width - 1, 0, -1, data.width};
    case Direction::kUp:
      return {data.height - 1, index, -1, 0, data.height};
    case Direction::kRight:
      break;
  }
  return {index, 0, 0, 1, data.width};
}

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
                                      const Line& line, const SweepState& state,
                                      SweepScratch* scratch) {
  const int padded_count = views.padded_count;
  float* HWY_RESTRICT cost = scratch->pixel.cost;
  float* HWY_RESTRICT message = scratch->pixel.forward;
  for (int m = 0; m < padded_count; ++m) {
    message[m] = ViewSelection::kBorderMessage;
  }
  for (int i = line.length - 1; i >= 0; --i) {
    const size_t pixel =
        static_cast<size_t>(line.row + i * line.row_step) * data.width +
        line.col + i * line.col_step;
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
                        const SourceCameras& views, PixelScratch* s) {
  DecodeCosts(state.cost.data() + pixel * views.count, views.count,
              views.padded_count, s->cost);
  const uint16_t* HWY_RESTRICT prob = state.prob.data() + pixel * views.count;
  float* HWY_RESTRICT to = s->prob;
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

// The plane that a pixel may try, if any.
TAPA_INLINE Plane FindPlane(const PlaneSet& set, const SweepGuide& guide,
                            size_t pixel, const Vec3& ray) {
  if (set.index.empty() || set.index.data()[pixel] == PlaneSet::kNone) {
    return Plane();
  }
  return ProposedPlane(set.planes[set.index.data()[pixel]], ray,
                       guide.depth_min, guide.depth_max);
}

TAPA_INLINE PixelGuide GuideOf(const SweepGuide& guide, size_t pixel,
                               const Vec3& ray) {
  PixelGuide result;
  if (!guide.textureness.empty()) {
    result.weights = TextureWeights::FromTextureness(
        guide.textureness.data()[pixel], guide.weight_range);
  }
  result.fine = FindPlane(guide.fine, guide, pixel, ray);
  result.coarse = FindPlane(guide.coarse, guide, pixel, ray);
  return result;
}

// Returns false if told to stop on the way.
HWY_ATTR bool SweepLine(const ProblemData& data, const SweepParams& params,
                        const SweepGuide& guide, const Line& line,
                        PeriodicCheck* check, SweepState* state,
                        SweepScratch* scratch) {
  const RefCamera camera = data.cameras.reference();
  const SourceCameras views = data.cameras.sources();
  const size_t mask_bytes = (views.count + 7) / 8;
  PixelScratch s = scratch->pixel;

  ComputeBackwardMessages(data, views, params, line, *state, scratch);
  for (int m = 0; m < views.padded_count; ++m) {
    s.forward[m] = ViewSelection::kBorderMessage;
  }

  Plane previous = {state->depth.At(line.row, line.col),
                    state->normal.At(line.row, line.col)};
  Vec3 previous_ray = camera.Ray(line.row, line.col);
  for (int i = 0; i < line.length; ++i) {
    const int row = line.row + i * line.row_step;
    const int col = line.col + i * line.col_step;
    const size_t pixel = static_cast<size_t>(row) * data.width + col;
    LoadPatch(data.window, data.reference, row, col, &scratch->patch);
    LoadPixel(*state, pixel, views, &s);
    s.backward =
        scratch->backward.get() + static_cast<size_t>(i) * views.padded_count;

    uint8_t* consistent =
        params.filter ? state->consistent.data() + pixel * mask_bytes : nullptr;
    Sources sources(data, scratch->patch, consistent);
    const Plane current = {state->depth.At(row, col),
                           state->normal.At(row, col)};
    const Vec3 ray = camera.Ray(row, col);
    const Choice choice = SweepPixel<SerialLanes>(
        params, camera, views, sources, row, col, pixel, current, previous,
        previous_ray, GuideOf(guide, pixel, ray), &s);
    StorePixel(s, pixel, views, state);
    if (!state->chosen.empty()) {
      state->chosen.data()[pixel] = static_cast<uint8_t>(choice.hypothesis);
    }
    if (choice.keep) {
      state->depth.At(row, col) = choice.plane.depth;
      state->normal.At(row, col) = choice.plane.normal;
    } else {
      state->depth.At(row, col) = 0;
      state->normal.At(row, col) = Vec3();
      std::memset(consistent, 0, mask_bytes);
    }
    previous = choice.plane;
    previous_ray = ray;
    if (!check->AfterPixel()) {
      return false;
    }
  }
  return true;
}

void SweepLinesImpl(const ProblemData& data, const SweepParams& params,
                    const SweepGuide& guide, Direction direction, int begin,
                    int end, const ContinueCheck& should_continue,
                    SweepState* state, SweepScratch* scratch) {
  PeriodicCheck check(data, should_continue);
  for (int index = begin; index < end; ++index) {
    if (!SweepLine(data, params, guide, MakeLine(data, direction, index),
                   &check, state, scratch)) {
      return;
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
      const Plane plane = {state->depth.At(row, col),
                           state->normal.At(row, col)};
      const Vec3 h = HomographyVector(camera, plane, camera.Ray(row, col));
      LoadPatch(data.window, data.reference, row, col, &scratch->patch);
      const size_t first =
          (static_cast<size_t>(row) * data.width + col) * views.count;
      uint16_t* cost = state->cost.data() + first;
      std::fill_n(state->prob.data() + first, views.count, EncodeProb(0.5f));
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
  pixel.plane = planes_.data();
  pixel.homography = homographies_.data();
  pixel.sum = sums_.data();
}

void SweepLines(const ProblemData& data, const SweepParams& params,
                const SweepGuide& guide, Direction direction, int begin,
                int end, const ContinueCheck& should_continue,
                SweepState* state, SweepScratch* scratch) {
  HWY_DYNAMIC_DISPATCH(SweepLinesImpl)
  (data, params, guide, direction, begin, end, should_continue, state, scratch);
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
