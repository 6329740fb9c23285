#include "src/mvs/tapa/stages.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/base/depth.h"
#include "src/mvs/camera_table.h"
#include "src/mvs/sweep/consistency_mask.h"
#include "src/mvs/sweep/hypotheses.h"
#include "src/mvs/tapa/completion.h"
#include "src/mvs/tapa/fill.h"
#include "src/mvs/tapa/region_planes.h"
#include "src/mvs/tapa/sightings.h"
#include "src/mvs/tapa/silhouettes.h"
#include "src/mvs/tapa/speckles.h"
#include "src/mvs/tapa/textureness.h"
#include "src/mvs/tapa/triangle_completion.h"
#include "src/mvs/window_shape.h"

namespace tapa {
namespace {

// Keys of the random draws of the fine and the coarse planes between sweeps.
// Fitting and drawing share them, and completion does without; changing that
// would change maps.
constexpr uint64_t kFineStream = 0x66696E65;
constexpr uint64_t kCoarseStream = 0x636F6172;

// The photograph in colour; `grey`: where it is kept if it has none.
const Map<Rgb>& ColorOf(const Problem& problem, Map<Rgb>* grey) {
  if (problem.reference_color != nullptr) {
    return *problem.reference_color;
  }
  const Map<uint8_t>& image = *problem.reference.image;
  *grey = Map<Rgb>(image.width(), image.height());
  for (size_t i = 0; i < image.size(); ++i) {
    const uint8_t value = image.data()[i];
    grey->data()[i] = {value, value, value};
  }
  return *grey;
}

int NumSuperpixels(int width, double divisor) {
  return std::max(1, static_cast<int>(std::lround(width / divisor)));
}

}  // namespace

TapaStages::TapaStages(const Options& options, const Problem& problem,
                       const Control& control)
    : options_(options),
      problem_(problem),
      control_(control),
      camera_(CameraTable(problem).reference()) {
  const Map<uint8_t>& image = *problem.reference.image;
  record_.textureness = ComputeTextureness(image, TexturenessOf(options.tapa));

  Map<Rgb> grey;
  const Map<Rgb>& color = ColorOf(problem, &grey);
  if (options.tapa.fine_superpixels) {
    record_.fine.superpixels = ComputeSuperpixels(
        color, NumSuperpixels(image.width(), options.tapa.fine_divisor));
  }
  if (options.tapa.coarse_superpixels && !control_.IsStopped()) {
    record_.coarse.superpixels = ComputeSuperpixels(
        color, NumSuperpixels(image.width(), options.tapa.coarse_divisor));
  }
}

void TapaStages::Begin(bool has_start, Backend* backend) {
  if (options_.tapa.texture_weighting) {
    backend->SetTextureness(record_.textureness);
  }
  // Not from noise.
  if (has_start) {
    ProposePlanes(0, backend);
  }
}

void TapaStages::ProposePlanes(int iteration, Backend* backend) {
  if (record_.fine.superpixels.count() == 0 &&
      record_.coarse.superpixels.count() == 0) {
    return;
  }
  Map<float> depth = backend->Depth();
  RemoveSpeckles(SpeckleContinuity(), MaxSpeckleSize(), &depth);
  PlaneSet fine = FitAndDraw(depth, iteration, kFineStream, &record_.fine);
  PlaneSet coarse =
      FitAndDraw(depth, iteration, kCoarseStream, &record_.coarse);
  backend->SetPlanes(std::move(fine), std::move(coarse));
}

PlaneSet TapaStages::FitAndDraw(const Map<float>& depth, int iteration,
                                uint64_t stream,
                                Segmentation* segmentation) const {
  const Superpixels& superpixels = segmentation->superpixels;
  if (superpixels.count() == 0 || control_.IsStopped()) {
    return PlaneSet();
  }
  const uint64_t seed = options_.seed ^ (stream << 32);
  segmentation->planes =
      FitPlanes(options_.tapa, camera_, depth, superpixels, seed);
  return DrawPlanes(superpixels, segmentation->planes, seed, iteration);
}

void TapaStages::Refine(Estimate* estimate) {
  Map<float>& depth = estimate->depth;
  if (control_.record != nullptr) {
    record_.chosen = std::move(estimate->chosen);
    for (size_t i = 0; i < problem_.mask.size(); ++i) {
      if (problem_.IsMasked(i)) {
        record_.chosen.data()[i] = kNumHypotheses;
      }
    }
    record_.swept_depth = depth;
  }
  if (!options_.tapa.refinement || control_.IsStopped()) {
    return;
  }
  record_.origin = Map<uint8_t>(depth.width(), depth.height(), kNoEstimate);

  Map<float> trusted;
  if (options_.tapa.completion) {
    const int num_trusted = options_.filter_min_num_consistent;
    trusted = depth;
    KeepConsistent(num_trusted, *estimate, &trusted);
    KeepConsistent(num_trusted > 1 ? num_trusted - 1 : num_trusted, *estimate,
                   &depth);
  } else {
    RemoveSpeckles(SpeckleContinuity(), MaxSpeckleSize(), &depth);
  }
  NoteOrigin(kSwept, depth);
  if (control_.record != nullptr) {
    record_.filtered_depth = depth;
  }

  if (options_.tapa.completion && !control_.IsStopped()) {
    Complete(AddSightings(trusted, depth), trusted, estimate);
  }
  if (!control_.IsStopped()) {
    Fill(estimate);
    NoteOrigin(kFilled, depth);
  }
  if (options_.tapa.completion && options_.tapa.completion_triangles &&
      options_.geom_consistency && !control_.IsStopped()) {
    CompleteWithTriangles(options_, problem_, control_, record_.textureness,
                          trusted, &depth, &estimate->normal, &record_.origin);
  }
  if (options_.tapa.completion) {
    FollowColors(estimate);
  }
  ClearOthers(estimate);
}

// What at least this many source views are consistent with, without speckles.
void TapaStages::KeepConsistent(int min_num_consistent,
                                const Estimate& estimate,
                                Map<float>* depth) const {
  const int num_sources = static_cast<int>(problem_.sources.size());
  RemoveInconsistent(estimate.consistent, num_sources,
                     std::min(min_num_consistent, num_sources), depth);
  RemoveSpeckles(SpeckleContinuity(), MaxSpeckleSize(), depth);
}

// Trusted estimates and, where there are none, what source views see there.
Map<float> TapaStages::AddSightings(const Map<float>& trusted,
                                    const Map<float>& depth) const {
  Map<float> evidence = trusted;
  if (!options_.geom_consistency || !options_.tapa.completion_sightings) {
    return evidence;
  }
  Map<float> sightings =
      FindSightings(options_, problem_, control_, depth, trusted);
  RemoveSpeckles(SpeckleContinuity(), MaxSpeckleSize(), &sightings);
  for (size_t i = 0; i < evidence.size(); ++i) {
    evidence.data()[i] = std::max(evidence.data()[i], sightings.data()[i]);
  }
  return evidence;
}

void TapaStages::Complete(const Map<float>& evidence, const Map<float>& trusted,
                          Estimate* estimate) {
  const int radius = static_cast<int>(options_.tapa.completion_radius *
                                      estimate->depth.width());
  LocalPlanes planes;
  for (Segmentation* segmentation : {&record_.fine, &record_.coarse}) {
    if (segmentation->superpixels.count() > 0) {
      segmentation->planes =
          FitPlanes(options_.tapa, camera_, evidence, segmentation->superpixels,
                    options_.seed);
      LocalPlanes found =
          FindLocalPlanes(problem_, camera_, evidence, *segmentation, radius);
      if (planes.depth.empty()) {
        planes = std::move(found);
      } else {
        MergeLocalPlanes(found, &planes);
      }
    }
  }
  if (!planes.depth.empty()) {
    CompleteWithPlanes(options_.tapa, planes, record_.textureness, trusted,
                       &estimate->depth, &estimate->normal, &record_.origin);
    record_.agreement = std::move(planes.agreement);
  }
}

void TapaStages::Fill(Estimate* estimate) const {
  FillOptions fill;
  fill.mask = &problem_.mask;
  fill.radius = options_.tapa.fill_radius;
  fill.num_rounds = options_.tapa.fill_rounds;
  if (options_.tapa.completion) {
    fill.min_share = options_.tapa.completion_fill_share;
  }
  const WindowShape window(options_);
  fill.sigma_spatial = static_cast<float>(window.sigma_spatial);
  fill.sigma_color = static_cast<float>(window.sigma_color);
  FillMissing(fill, camera_, *problem_.reference.image, &estimate->depth,
              &estimate->normal);
}

void TapaStages::FollowColors(Estimate* estimate) {
  Map<Rgb> grey;
  const Map<Rgb>& color = ColorOf(problem_, &grey);
  if (options_.tapa.completion_silhouettes && !control_.IsStopped()) {
    MendSilhouettes(options_, problem_, control_, camera_, color,
                    record_.textureness, &estimate->depth, &estimate->normal,
                    &record_.origin);
  }
  if (options_.tapa.completion_regions && !control_.IsStopped()) {
    CompleteRegions(options_, problem_, control_, camera_, color,
                    record_.textureness, &estimate->depth, &estimate->normal,
                    &record_.origin);
  }
}

// Of the pixels that have got an estimate since the last call.
void TapaStages::NoteOrigin(Origin origin, const Map<float>& depth) {
  for (size_t i = 0; i < depth.size(); ++i) {
    if (IsDepth(depth.data()[i]) && record_.origin.data()[i] == kNoEstimate) {
      record_.origin.data()[i] = origin;
    }
  }
}

// Source views are consistent with swept estimates only.
void TapaStages::ClearOthers(Estimate* estimate) const {
  const int mask_bytes =
      ConsistencyMaskBytes(static_cast<int>(problem_.sources.size()));
  for (size_t i = 0; i < estimate->depth.size(); ++i) {
    if (record_.origin.data()[i] == kNoEstimate) {
      estimate->normal.data()[i] = Vec3();
    }
    if (record_.origin.data()[i] != kSwept) {
      std::fill_n(estimate->consistent.begin() + i * mask_bytes, mask_bytes, 0);
    }
  }
}

int TapaStages::MaxSpeckleSize() const {
  return static_cast<int>(options_.tapa.speckle_size *
                          record_.textureness.size());
}

Continuity TapaStages::SpeckleContinuity() const {
  Continuity continuity;
  continuity.step =
      static_cast<float>(options_.tapa.speckle_continuity *
                         (problem_.depth_max - problem_.depth_min));
  return continuity;
}

}  // namespace tapa
