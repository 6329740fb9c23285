#ifndef TAPA_SRC_MVS_CUDA_SWEEP_BODY_H_
#define TAPA_SRC_MVS_CUDA_SWEEP_BODY_H_

#include "src/mvs/cuda/patch.h"
#include "src/mvs/cuda/sweep_task.h"
#include "src/mvs/sweep/consistency_mask.h"
#include "src/mvs/sweep/sweep_pixel.h"

// What kernels do, as functions that also run on the host, for tests: `Lanes`
// are those of one pixel, `Sizes` is one of layout.h, `Textures` is described
// in patch.h. views: the cameras, in memory that is fast to read for lanes that
// look at different views at a time.

namespace tapa {

// The backward message of a pixel, given that of the one after it.
TAPA_INLINE float BackwardMessage(const SweepTask& task, size_t pixel, int m,
                                  float next) {
  if (task.IsMasked(pixel)) {
    return ViewSelection::kBorderMessage;
  }
  const float cost = DecodeCost(task.cost[pixel * task.num_views + m]);
  return ViewSelection::Backward(task.params.selection.Emission(cost), next);
}

// Computes the checkpoints of a line.
template <class Lanes>
TAPA_INLINE void ComputeCheckpoints(const SweepTask& task, int index) {
  const SweepLine line = task.Line(index);
  const int n = task.num_views;
  for (int m = Lanes::First(); m < n; m += Lanes::Step()) {
    float message = ViewSelection::kBorderMessage;
    for (int i = line.length - 1; i >= task.piece_length; --i) {
      message = BackwardMessage(task, task.Pixel(line.Row(i), line.Col(i)), m,
                                message);
      if (i % task.piece_length == 0) {
        const size_t piece = i / task.piece_length - 1;
        task.checkpoints[(piece * task.NumLines() + index) * n + m] = message;
      }
    }
  }
}

// Computes the backward messages of pixels [begin, end) of a line, a piece.
// Every lane reads only its own views' messages, so nobody waits for them.
template <class Lanes>
TAPA_INLINE void ComputeBackwardMessages(const SweepTask& task,
                                         const SweepLine& line, int index,
                                         int begin, int end) {
  const int n = task.num_views;
  const size_t piece = begin / task.piece_length;
  float* backward =
      task.backward + static_cast<size_t>(index) * task.piece_length * n;
  for (int m = Lanes::First(); m < n; m += Lanes::Step()) {
    float message =
        end == line.length
            ? ViewSelection::kBorderMessage
            : task.checkpoints[(piece * task.NumLines() + index) * n + m];
    for (int i = end - 1; i >= begin; --i) {
      message = BackwardMessage(task, task.Pixel(line.Row(i), line.Col(i)), m,
                                message);
      backward[(i - begin) * n + m] = message;
    }
  }
}

// Writes which views are consistent with the estimate, and what was chosen,
// where the pixel's costs were. flags: one for each view.
template <class Lanes>
TAPA_INLINE void StoreConsistency(const SweepTask& task, size_t pixel,
                                  const Choice& choice, const float* flags) {
  const int n = task.num_views;
  const int mask_bytes = ConsistencyMaskBytes(n);
  uint8_t* to = reinterpret_cast<uint8_t*>(task.cost + pixel * n);
  for (int i = Lanes::First(); i < mask_bytes; i += Lanes::Step()) {
    uint8_t bits = 0;
    for (int m = 8 * i; m < 8 * i + 8 && m < n; ++m) {
      bits |= ConsistencyBit(m, choice.is_consistent && flags[m] > 0.0f);
    }
    to[i] = bits;
  }
  if (Lanes::First() == 0) {
    to[mask_bytes] = static_cast<uint8_t>(choice.hypothesis);
  }
}

template <class Lanes>
TAPA_INLINE void StorePixel(const SweepTask& task, size_t pixel,
                            const Choice& choice, const PixelScratch& s,
                            const float* flags) {
  const int n = task.num_views;
  for (int m = Lanes::First(); m < n; m += Lanes::Step()) {
    task.prob[pixel * n + m] = EncodeProb(s.prob[m]);
    if (!task.params.check_consistency) {
      task.cost[pixel * n + m] = EncodeCost(s.cost[m]);
    }
  }
  if (Lanes::First() == 0) {
    task.estimates[pixel] =
        choice.is_consistent ? Pack(choice.estimate) : PackNothing();
  }
  if (task.params.check_consistency) {
    Lanes::Sync();
    StoreConsistency<Lanes>(task, pixel, choice, flags);
  }
}

// Sweeps one pixel. s: the scratch, which carries the forward messages and says
// where the backward ones are. Returns what the next pixel looks back at.
template <class Lanes, class Sizes, class Textures>
TAPA_INLINE PreviousPixel SweepTaskPixel(const SweepTask& task,
                                         const SourceCameras& views,
                                         const Textures& textures, int row,
                                         int col, const PreviousPixel& previous,
                                         PatchSample* samples,
                                         const PixelScratch& s) {
  const size_t pixel = task.Pixel(row, col);
  const int n = task.num_views;
  const Vec3 ray = task.camera.Ray(row, col);
  if (task.IsMasked(pixel)) {
    // The next pixel has nothing to look back at.
    for (int m = Lanes::First(); m < n; m += Lanes::Step()) {
      s.forward[m] = ViewSelection::kBorderMessage;
    }
    return {DepthNormal(), ray};
  }
  const PatchStatistics patch =
      LoadPatch<Lanes, Sizes>(task.window, textures, row, col, samples);
  for (int m = Lanes::First(); m < n; m += Lanes::Step()) {
    s.cost[m] = DecodeCost(task.cost[pixel * n + m]);
    s.prob[m] = DecodeProb(task.prob[pixel * n + m]);
  }
  // The distribution's memory is free by the time views are judged.
  float* const flags = s.cdf;
  PixelSources<Lanes, Sizes, Textures> sources(task.window, textures, samples,
                                               patch, flags);
  const PixelContext context = {
      task.params,
      task.camera,
      views,
      s,
      static_cast<float>(row),
      static_cast<float>(col),
      ray,
      Random(task.params.seed, pixel, task.params.index),
      Unpack(task.estimates[pixel]),
      task.guide.At(pixel, ray, task.params.try_planes)};
  const Choice choice = SweepPixel<Lanes>(context, previous, sources);
  StorePixel<Lanes>(task, pixel, choice, s, flags);
  // The next pixel overwrites what lanes still read.
  Lanes::Sync();
  return {choice.estimate, ray};
}

// Sweeps a piece of a line. words: the scratch, see layout.h.
template <class Lanes, class Sizes, class Textures>
TAPA_INLINE void SweepPiece(const SweepTask& task, const SourceCameras& views,
                            const Textures& textures, int index, int piece,
                            float* words) {
  const SweepLine line = task.Line(index);
  const int n = task.num_views;
  const int begin = piece * task.piece_length;
  const int rest = line.length - begin;
  const int end = begin + (rest < task.piece_length ? rest : task.piece_length);
  ComputeBackwardMessages<Lanes>(task, line, index, begin, end);

  PatchSample* samples;
  PixelScratch s =
      ArrangeScratch<Lanes, Sizes>(task.window, n, words, &samples);
  float* const forward = task.forward + static_cast<size_t>(index) * n;
  for (int m = Lanes::First(); m < n; m += Lanes::Step()) {
    s.forward[m] = begin == 0 ? ViewSelection::kBorderMessage : forward[m];
  }
  const int before = begin == 0 ? 0 : begin - 1;
  PreviousPixel previous = {
      begin == 0 ? Unpack(task.estimates[task.Pixel(line.Row(0), line.Col(0))])
                 : task.previous[index],
      task.camera.Ray(line.Row(before), line.Col(before))};
  Lanes::Sync();

  for (int i = begin; i < end; ++i) {
    s.backward =
        task.backward +
        (static_cast<size_t>(index) * task.piece_length + i - begin) * n;
    previous = SweepTaskPixel<Lanes, Sizes>(task, views, textures, line.Row(i),
                                            line.Col(i), previous, samples, s);
  }

  for (int m = Lanes::First(); m < n; m += Lanes::Step()) {
    forward[m] = s.forward[m];
  }
  if (Lanes::First() == 0) {
    task.previous[index] = previous.estimate;
  }
}

// Sweeps pieces [begin, end) of a line.
template <class Lanes, class Sizes, class Textures>
TAPA_INLINE void SweepPieces(const SweepTask& task, const SourceCameras& views,
                             const Textures& textures, int index, int begin,
                             int end, float* words) {
  for (int piece = begin; piece < end; ++piece) {
    SweepPiece<Lanes, Sizes>(task, views, textures, index, piece, words);
    // The next piece reads what this one left in the task.
    Lanes::Sync();
  }
}

// Computes the costs of a pixel's estimate, and sets its selection
// probabilities to one half.
template <class Lanes, class Sizes, class Textures>
TAPA_INLINE void InitializePixel(const SweepTask& task,
                                 const SourceCameras& views,
                                 const Textures& textures, int row, int col,
                                 float* words) {
  const size_t pixel = task.Pixel(row, col);
  const int n = task.num_views;
  if (task.IsMasked(pixel)) {
    for (int m = Lanes::First(); m < n; m += Lanes::Step()) {
      task.cost[pixel * n + m] = 0;
      task.prob[pixel * n + m] = 0;
    }
    return;
  }
  PatchSample* samples;
  ArrangeScratch<Lanes, Sizes>(task.window, n, words, &samples);
  const PatchStatistics patch =
      LoadPatch<Lanes, Sizes>(task.window, textures, row, col, samples);
  const PixelSources<Lanes, Sizes, Textures> sources(task.window, textures,
                                                     samples, patch, nullptr);
  const Vec3 h = HomographyVector(task.camera, Unpack(task.estimates[pixel]),
                                  task.camera.Ray(row, col));
  for (int first = 0; first < n; first += Lanes::kNumGroups) {
    const GroupShare share = ShareOfGroup<Lanes>(first, n);
    const int m = share.item;
    const float cost = sources.Cost(m, ComputeWarp(views, m, row, col, h));
    if (share.stores) {
      task.cost[pixel * n + m] = EncodeCost(cost);
      task.prob[pixel * n + m] = EncodeProb(0.5f);
    }
  }
  Lanes::Sync();
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CUDA_SWEEP_BODY_H_
